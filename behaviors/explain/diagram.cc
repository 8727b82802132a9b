// Converts a compiled behavior and its expanded tree of states to a Diagram; see diagram.h.
#include "behaviors/explain/diagram.h"

#include <fmt/format.h>

#include <algorithm>

#include "behaviors/compile.h"
#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"
#include "behaviors/load/substitution.h"

namespace footfall::behaviors {
namespace {

std::string text_of(const core::YamlNode& node) {
  std::vector<std::string> parts;
  switch (node.kind) {
    case core::YamlNode::Kind::scalar: {
      std::string text = read_marked(node.scalar).text;
      if (text.starts_with('=')) text.erase(0, std::min(text.find_first_not_of("= "), text.size()));
      return text;
    }
    case core::YamlNode::Kind::sequence:
      for (const core::YamlNode& item : node.items) parts.push_back(text_of(item));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    case core::YamlNode::Kind::map:
      for (const core::YamlEntry& entry : node.entries) {
        parts.push_back(entry.key + ": " + text_of(entry.value));
      }
      return fmt::format("{{{}}}", fmt::join(parts, ", "));
    default:
      return {};
  }
}

// One name, or several separated by commas.
std::string names_of(const core::YamlNode& node) {
  std::vector<std::string> names;
  for (const core::YamlNode& item : node.items) names.push_back(text_of(item));
  for (const core::YamlEntry& entry : node.entries) {
    names.push_back(core::is_off(entry.value) ? "no " + entry.key : entry.key);
  }
  return node.is_scalar() ? text_of(node) : fmt::format("{}", fmt::join(names, ", "));
}

// A time as written; for a parameter, followed by its value.
std::string time_text(const LoadContext& context, const core::YamlNode& node) {
  const std::string text = text_of(node);
  if (!text.starts_with('$')) return text;
  const int index = context.behavior.find_parameter(text.substr(1));
  if (index < 0) return text;
  const auto slot = context.behavior.parameters[static_cast<std::size_t>(index)].slot;
  const double value = context.behavior.values[static_cast<std::size_t>(slot)];
  return value < 1.0 - 1e-9 ? fmt::format("{} = {:g} ms", text, value * 1e3)
                            : fmt::format("{} = {:g} s", text, value);
}

std::string action_text(const core::YamlNode& action) {
  if (!action.is_map() || action.entries.empty()) return text_of(action);
  const std::string& verb = action.entries.front().key;
  const core::YamlNode& what = action.entries.front().value;
  if (verb == "log") return fmt::format("log \"{}\"", text_of(what));
  if (verb != "set" || !what.is_map()) return verb + " " + text_of(what);
  std::vector<std::string> parts;
  for (const core::YamlEntry& entry : what.entries) {
    parts.push_back(fmt::format("{} := {}", entry.key, text_of(entry.value)));
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

// `HEAD / action, action`.
std::string actions_text(const std::string& head, const core::YamlNode& list) {
  std::vector<std::string> parts;
  if (!list.is_sequence()) parts.push_back(action_text(list));
  for (const core::YamlNode& item : list.items) parts.push_back(action_text(item));
  return fmt::format("{}/ {}", head, fmt::join(parts, ", "));
}

std::string contact_transition_text(const LoadContext& context, const core::YamlNode& node) {
  std::string text;
  for (const char* key : {"releases", "loads", "toward"}) {
    const core::YamlNode* value = node.find(key);
    if (value != nullptr)
      text += fmt::format("{}{} {}", text.empty() ? "" : " ", key, names_of(*value));
  }
  if (const auto* over = node.find("over")) text += " over " + time_text(context, *over);
  return text;
}

void add_invokes(std::vector<std::string>& lines, const core::YamlNode& list) {
  for (const core::YamlNode& item : list.items) {
    const core::YamlNode* planner = item.find("planner");
    if (planner == nullptr) continue;
    std::string line = "plans " + text_of(*planner);
    if (const auto* at = item.find("at")) line += " at " + text_of(*at);
    if (const auto* every = item.find("every")) line += ", every " + text_of(*every);
    lines.push_back(std::move(line));
  }
}

std::vector<std::string> control_of(const LoadContext& context, const core::YamlNode& keys) {
  std::vector<std::string> lines;
  const auto add = [&](const char* key, const char* word) {
    const core::YamlNode* node = keys.find(key);
    if (node == nullptr) return;
    const std::string names = names_of(*node);
    lines.push_back(names.empty() ? fmt::format("no {}", word) : fmt::format("{} {}", word, names));
  };
  add("stack", "stack");
  add("contacts", "contacts");
  add("tasks", "tasks");
  add("internal", "internal force");
  add("gains", "gains");
  add("torque_loop", "torque loop");
  if (const auto* node = keys.find("contact_transition"); node != nullptr && node->is_map()) {
    lines.push_back(contact_transition_text(context, *node));
  }
  if (const auto* node = keys.find("invoke")) add_invokes(lines, *node);
  return lines;
}

std::vector<std::string> trigger_of(const LoadContext& context, const core::YamlNode& row) {
  std::vector<std::string> lines;
  if (const auto* on = row.find("on")) lines.push_back(names_of(*on));
  if (const auto* when = row.find("when")) lines.push_back("[" + text_of(*when) + "]");
  if (const auto* after = row.find("after")) lines.push_back("after " + time_text(context, *after));
  if (const auto* actions = row.find("do")) lines.push_back(actions_text("", *actions));
  return lines;
}

std::vector<int> targets_of(const Behavior& behavior, const Range& range) {
  const auto begin = behavior.targets.begin() + range.first;
  return {begin, begin + range.count};
}

// `on: done.state.CHILD` of a parent that the transition does not exit: the child's completion.
int completed_child(const Behavior& behavior, const TransitionInfo& transition,
                    const core::YamlNode& row) {
  const core::YamlNode* on = row.find("on");
  constexpr std::string_view kDone = "done.state.";
  const bool stays = transition.domain == transition.source;
  if (!stays || on == nullptr || !on->is_scalar() || !on->scalar.starts_with(kDone)) return -1;
  const std::string name = on->scalar.substr(kDone.size());
  const auto& states = behavior.states;
  for (int c = transition.source + 1; c < states[static_cast<std::size_t>(transition.source)].end;
       c = states[static_cast<std::size_t>(c)].end) {
    const StateInfo& info = states[static_cast<std::size_t>(c)];
    if (info.name == name || info.path == name) return c;
  }
  return -1;
}

void add_transition(const LoadContext& context, const TransitionInfo& transition,
                    const core::YamlNode& row, Diagram& diagram) {
  std::vector<std::string> label = trigger_of(context, row);
  if (transition.targets.count == 0) {
    diagram.states[static_cast<std::size_t>(transition.source)].actions.push_back(
        fmt::format("{}", fmt::join(label, " ")));
    return;
  }
  DiagramEdge edge{transition.source, targets_of(context.behavior, transition.targets), {}};
  // A parallel state has no dot at which an edge from inside could end.
  const int first = edge.targets.front();
  const bool around =
      transition.source == first || context.behavior.is_descendant(transition.source, first);
  if (around &&
      context.behavior.states[static_cast<std::size_t>(first)].kind == StateKind::parallel) {
    diagram.states[static_cast<std::size_t>(transition.source)].actions.push_back(
        fmt::format("{}: enters {} anew", fmt::join(label, " "),
                    diagram.states[static_cast<std::size_t>(first)].name));
    return;
  }
  const int child = completed_child(context.behavior, transition, row);
  if (child >= 0) {
    edge.source = child;
    label.front() = "done";
  }
  edge.label = std::move(label);
  diagram.edges.push_back(std::move(edge));
}

void add_transitions(const LoadContext& context, int state, const core::YamlNode& keys,
                     Diagram& diagram) {
  const Range& range = context.behavior.states[static_cast<std::size_t>(state)].transitions;
  const core::YamlNode* list = keys.find("transitions");
  const std::size_t listed = list == nullptr ? 0 : list->items.size();
  for (int t = range.first; t < range.end(); ++t) {
    const auto k = static_cast<std::size_t>(t - range.first);
    const TransitionInfo& transition = context.behavior.transitions[static_cast<std::size_t>(t)];
    if (k < listed) {
      add_transition(context, transition, list->items[k], diagram);
    } else if (const auto* after = keys.find("after")) {  // the state's own is the last one
      diagram.edges.push_back({state,
                               targets_of(context.behavior, transition.targets),
                               {"after " + time_text(context, *after)}});
    }
  }
}

DiagramState state_of(const LoadContext& context, int index) {
  const StateInfo& info = context.behavior.states[static_cast<std::size_t>(index)];
  const StateSource& source = *context.sources[static_cast<std::size_t>(index)];
  DiagramState state;
  state.name = info.name;
  state.path = info.path;
  state.kind = info.kind;
  state.parent = info.parent;
  state.origin = source.origin;
  state.control = control_of(context, source.keys);
  if (info.history < 0 || source.keys.find("default") != nullptr) {
    state.initial = targets_of(context.behavior, info.initial);
  }
  const bool region =
      info.parent >= 0 &&
      context.behavior.states[static_cast<std::size_t>(info.parent)].kind == StateKind::parallel;
  state.region = region && info.history < 0;
  if (const auto* entry = source.keys.find("on_entry")) {
    state.actions.push_back(actions_text("entry ", *entry));
  }
  if (const auto* exit = source.keys.find("on_exit")) {
    state.actions.push_back(actions_text("exit ", *exit));
  }
  return state;
}

Diagram make_diagram(const LoadContext& context) {
  Diagram diagram;
  diagram.name = context.behavior.name;
  const int count = static_cast<int>(context.behavior.states.size());
  for (int s = 0; s < count; ++s) {
    diagram.states.push_back(state_of(context, s));
    const int parent = diagram.states.back().parent;
    if (parent >= 0) diagram.states[static_cast<std::size_t>(parent)].children.push_back(s);
  }
  for (int s = 0; s < count; ++s) {
    add_transitions(context, s, context.sources[static_cast<std::size_t>(s)]->keys, diagram);
  }
  if (context.behavior.safe_transition >= 0) {
    const auto safe = static_cast<std::size_t>(context.behavior.safe_transition);
    for (const int target :
         targets_of(context.behavior, context.behavior.transitions[safe].targets)) {
      diagram.states[static_cast<std::size_t>(target)].safe = true;
    }
  }
  return diagram;
}

std::optional<Diagram> load(core::YamlNode root, const std::string& path,
                            const LoadOptions& options, core::Diagnostics& diagnostics) {
  Behavior behavior;
  LoadContext context(behavior, options, diagnostics);
  if (!compile_behavior(context, std::move(root), path)) return std::nullopt;
  return make_diagram(context);
}

}  // namespace

std::optional<Diagram> load_diagram(const std::string& path, const LoadOptions& options,
                                    core::Diagnostics& diagnostics) {
  return load(load_tree(path, options, diagnostics), path, options, diagnostics);
}

std::optional<Diagram> load_diagram_text(std::string_view text, const std::string& name,
                                         const LoadOptions& options,
                                         core::Diagnostics& diagnostics) {
  return load(load_tree_text(text, name, options, diagnostics), name, options, diagnostics);
}

}  // namespace footfall::behaviors
