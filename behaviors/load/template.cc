// Expands templates and mirror images into a tree of states without arguments.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"
#include "behaviors/load/template_merge.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

constexpr int kMaxNesting = 32;
constexpr int kMaxStates = 5000;  // bounds templates that instantiate others several times

core::YamlNode text_node(std::string text, core::Mark mark) {
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::scalar;
  node.scalar = std::move(text);
  node.mark = mark;
  return node;
}

core::YamlNode map_node(core::Mark mark) {
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::map;
  node.mark = mark;
  return node;
}

void put(core::YamlNode& map, const std::string& key, core::YamlNode value) {
  const core::Mark mark = value.mark;
  map.entries.push_back({key, mark, false, std::move(value)});
}

const core::YamlNode* find_template(LoadContext& context, const core::YamlNode& name) {
  const core::YamlNode* templates = context.section("templates");
  const core::YamlNode* found =
      templates == nullptr || !name.is_scalar() ? nullptr : templates->find(name.scalar);
  if (!core::expect_scalar(name, "the name of a template", context.diagnostics)) return nullptr;
  if (found != nullptr) {
    context.used_templates.push_back(name.scalar);
    return found->is_map() ? found : nullptr;  // reported by check_template
  }
  std::vector<std::string> names;
  if (templates != nullptr) {
    for (const auto& entry : templates->entries) names.push_back(entry.key);
  }
  context.error(name.mark, "unknown-template",
                fmt::format("unknown template '{}'{}", name.scalar,
                            core::did_you_mean_or_list(name.scalar, names)));
  return nullptr;
}

std::vector<std::string> argument_names(const core::YamlNode& body) {
  std::vector<std::string> names;
  if (const auto* args = body.find("args")) {
    for (const core::YamlNode& item : args->items) names.push_back(item.scalar);
  }
  return names;
}

// The arguments of an instance in the template's order; nullopt after errors.
std::optional<Arguments> read_arguments(LoadContext& context, const core::YamlNode& body,
                                        const core::YamlNode* with, const core::YamlNode& name) {
  const std::vector<std::string> names = argument_names(body);
  static const core::YamlNode none;
  const core::YamlNode& given = with == nullptr ? none : *with;
  if (with != nullptr && !core::expect_map(*with, "arguments by name", context.diagnostics)) {
    return std::nullopt;
  }
  Arguments arguments;
  bool good = true;
  for (const std::string& argument : names) {
    if (const auto* value = given.find(argument)) {
      arguments.emplace_back(argument, *value);
      continue;
    }
    good = false;
    if (core::has_nearly(given, argument)) continue;
    context.error(name.mark, "missing-argument",
                  fmt::format("template '{}' needs the argument '{}'", name.scalar, argument));
  }
  for (const auto& entry : given.entries) {
    if (std::find(names.begin(), names.end(), entry.key) != names.end()) continue;
    context.error(entry.key_mark, "unknown-argument",
                  fmt::format("template '{}' has no argument '{}'{}", name.scalar, entry.key,
                              core::did_you_mean_or_list(entry.key, names)));
    good = false;
  }
  if (!good) return std::nullopt;
  return arguments;
}

StateSource expand(LoadContext& context, const std::string& name, core::Mark mark,
                   core::YamlNode keys, Arguments arguments, int depth);

// Text such as `stride(stance: right_foot, swing: left_foot)`.
std::string instance_text(const core::YamlNode& name, const Arguments& arguments) {
  std::vector<std::string> parts;
  for (const auto& [key, value] : arguments) {
    parts.push_back(fmt::format("{}: {}", key, value.is_scalar() ? value.scalar : "..."));
  }
  return fmt::format("{}({})", name.scalar, fmt::join(parts, ", "));
}

// An instance of a template, with the keys of `over` merged over its own.
StateSource instantiate(LoadContext& context, const std::string& name, core::Mark mark,
                        const core::YamlNode& body, Arguments arguments, const char* side,
                        const core::YamlNode& over, const Arguments& outer, int depth) {
  arguments.emplace_back("side", text_node(side, mark));
  core::YamlNode keys = substitute(body, arguments, context.behavior.robot);
  const auto is_args = [](const core::YamlEntry& entry) { return entry.key == "args"; };
  std::erase_if(keys.entries, is_args);
  merge_over_template(context, keys, over);
  for (const auto& argument : outer) {
    const auto same = [&](const auto& mine) { return mine.first == argument.first; };
    if (std::none_of(arguments.begin(), arguments.end(), same)) arguments.push_back(argument);
  }
  return expand(context, name, mark, std::move(keys), std::move(arguments), depth + 1);
}

// The image of an argument under the robot's symmetry; other values are unchanged.
core::YamlNode image_of(LoadContext& context, const core::YamlNode& value) {
  core::YamlNode image = value;
  for (const auto& [a, b] : context.behavior.robot.symmetry) {
    if (value.scalar == a) image.scalar = b;
    if (value.scalar == b) image.scalar = a;
  }
  const bool named = context.behavior.robot.find_contact(value.scalar) >= 0 ||
                     context.behavior.robot.find_group(value.scalar) >= 0 ||
                     context.behavior.robot.find_joint(value.scalar) >= 0;
  if (named && image.scalar == value.scalar) {
    context.warning(value.mark, "no-mirror-image",
                    fmt::format("'{}' has no mirror image in the robot's symmetry", value.scalar));
  }
  return image;
}

// Two states named after their first argument; when one is done, the other follows.
void expand_mirror(LoadContext& context, StateSource& state, const core::YamlNode& name,
                   const core::YamlNode* with, int depth) {
  const core::YamlNode* body = find_template(context, name);
  if (body == nullptr) return;
  const auto arguments = read_arguments(context, *body, with, name);
  if (!arguments) return;
  if (arguments->empty() || !arguments->front().second.is_scalar()) {
    context.error(name.mark, "mirror", "a mirrored template needs a first argument that is a name");
    return;
  }
  context.mirrored.emplace_back(name.scalar, *arguments);
  Arguments image;
  for (const auto& [key, value] : *arguments) image.emplace_back(key, image_of(context, value));
  const std::string first = arguments->front().second.scalar;
  std::string second = image.front().second.scalar;
  // If the robot could not be loaded (reported), accept any name as an image, to check the rest.
  if (context.behavior.has_robot && context.behavior.robot.joints.empty())
    second = first + "_image";
  if (first == second) {
    context.error(arguments->front().second.mark, "mirror",
                  fmt::format("'{}' has no mirror image: name it in the robot's symmetry{}", first,
                              core::did_you_mean(first, context.contact_names())));
    return;
  }
  const core::YamlNode none = map_node(name.mark);
  const std::size_t written = state.children.size();
  state.children.push_back(
      instantiate(context, first, name.mark, *body, *arguments, "1", none, state.arguments, depth));
  state.children.push_back(
      instantiate(context, second, name.mark, *body, image, "-1", none, state.arguments, depth));
  state.children[written].origin = instance_text(name, *arguments);
  state.children[written + 1].origin = "mirror image: " + instance_text(name, image);
  core::YamlNode list = map_node(name.mark);
  list.kind = core::YamlNode::Kind::sequence;
  const auto found = std::find_if(state.keys.entries.begin(), state.keys.entries.end(),
                                  [](const auto& e) { return e.key == "transitions"; });
  if (found != state.keys.entries.end()) {
    list = found->value;
    state.keys.entries.erase(found);
  }
  for (const auto& [from, to] : {std::pair(first, second), std::pair(second, first)}) {
    core::YamlNode row = map_node(name.mark);
    put(row, "on", text_node("done.state." + from, name.mark));
    put(row, "to", text_node(to, name.mark));
    put(row, "internal", text_node("true", name.mark));
    list.items.push_back(std::move(row));
  }
  put(state.keys, "transitions", std::move(list));
}

core::YamlNode take(core::YamlNode& map, std::string_view key) {
  core::YamlNode value;
  const auto found = std::find_if(map.entries.begin(), map.entries.end(),
                                  [&](const auto& entry) { return entry.key == key; });
  if (found != map.entries.end()) {
    value = std::move(found->value);
    map.entries.erase(found);
  }
  return value;
}

void expand_children(LoadContext& context, StateSource& state, const core::YamlNode& states,
                     int depth) {
  if (states.is_null()) return;
  if (!core::expect_map(states, "states by name", context.diagnostics)) return;
  if (states.entries.empty()) {
    context.error(states.mark, "empty-value", "`states: {}` holds no state: leave it out");
  }
  for (const core::YamlEntry& entry : states.entries) {
    if (!core::check_name(entry, context.diagnostics, "the name of a state")) continue;
    state.children.push_back(
        expand(context, entry.key, entry.key_mark, entry.value, state.arguments, depth + 1));
  }
}

StateSource expand(LoadContext& context, const std::string& name, core::Mark mark,
                   core::YamlNode keys, Arguments arguments, int depth) {
  StateSource state{name, mark, std::move(keys), std::move(arguments), {}, -1, {}};
  if (state.keys.is_null()) state.keys = map_node(mark);
  if (!core::expect_map(state.keys, "a state", context.diagnostics)) {
    state.keys = map_node(mark);
    return state;
  }
  if (depth > kMaxNesting) {
    context.error(mark, "template-loop", "states are nested too deeply (a template uses itself?)");
    return state;
  }
  if (++context.expanded_states > kMaxStates) {
    if (context.expanded_states == kMaxStates + 1) {
      context.error(mark, "too-many", fmt::format("more than {} states", kMaxStates));
    }
    return state;
  }
  for (const char* key : {"use", "mirror", "with", "states"}) {
    const core::YamlNode* node = state.keys.find(key);
    if (node != nullptr && node->is_null()) {
      core::report_expected(*node, fmt::format("a value after `{}`", key), context.diagnostics);
    }
  }
  const core::YamlNode use = take(state.keys, "use");
  const core::YamlNode mirror = take(state.keys, "mirror");
  const core::YamlNode with = take(state.keys, "with");
  const core::YamlNode* given = with.is_null() ? nullptr : &with;
  if (!use.is_null() && !mirror.is_null()) {
    context.error(mirror.mark, "mirror", "a state has 'use' or 'mirror', not both");
    return state;
  } else if (!use.is_null()) {
    const core::YamlNode* body = find_template(context, use);
    const auto own = body == nullptr ? std::nullopt : read_arguments(context, *body, given, use);
    if (!own) return state;
    StateSource made =
        instantiate(context, name, mark, *body, *own, "1", state.keys, state.arguments, depth);
    made.origin = instance_text(use, *own);
    return made;
  } else if (given != nullptr && mirror.is_null()) {
    context.error(with.mark, "misplaced-key", "'with' needs 'use' or 'mirror' beside it");
  }
  const core::YamlNode states = take(state.keys, "states");
  if (!mirror.is_null()) {
    if (!states.is_null()) {
      context.error(states.mark, "mirror", "a mirrored state's children come from its template");
    }
    expand_mirror(context, state, mirror, given, depth);
  } else {
    expand_children(context, state, states, depth);
  }
  return state;
}

// Reports names that a template must not use, even if it is never instantiated.
void check_template(LoadContext& context, const core::YamlEntry& entry) {
  if (!core::check_name(entry, context.diagnostics, "the name of a template")) return;
  if (!core::expect_map(entry.value, "a template", context.diagnostics)) return;
  const core::YamlNode* args = entry.value.find("args");
  if (args == nullptr || !core::expect_sequence(*args, "a list of names", context.diagnostics)) {
    return;
  }
  const std::vector<std::string> parameters = context.parameter_names();
  std::vector<std::string> seen;
  for (const core::YamlNode& item : args->items) {
    const auto name = core::read_name(item, context.diagnostics, "the name of an argument");
    if (!name) continue;
    if (std::find(seen.begin(), seen.end(), *name) != seen.end()) {
      context.error(item.mark, "duplicate", fmt::format("argument '{}' twice", *name));
    }
    seen.push_back(*name);
    if (*name == "side" ||
        std::find(parameters.begin(), parameters.end(), *name) != parameters.end()) {
      context.error(item.mark, "argument-name",
                    fmt::format("argument '{}' has the name of a parameter", *name));
    }
  }
}

// A `$name` left in a name or key must be a parameter.
void check_resolved_text(LoadContext& context, const core::YamlNode& node, std::string_view key) {
  const auto check = [&](const std::string& text, core::Mark mark) {
    const std::size_t at = text.find('$');
    if (at == std::string::npos || text.front() == '=' || key == "when" || key == "log") return;
    std::string name = text.substr(at + 1);
    name = name.substr(0, name.find_first_not_of(
                              "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"));
    const std::vector<std::string> parameters = context.parameter_names();
    if (std::find(parameters.begin(), parameters.end(), name) != parameters.end()) return;
    context.error(mark, "unresolved",
                  fmt::format("'${}' is neither a parameter nor an argument here{}", name,
                              core::did_you_mean(name, parameters)));
    context.diagnostics.silence(mark);
  };
  if (node.is_scalar()) check(node.scalar, node.mark);
  for (const core::YamlNode& item : node.items) check_resolved_text(context, item, key);
  for (const core::YamlEntry& entry : node.entries) {
    check(entry.key, entry.key_mark);
    check_resolved_text(context, entry.value, entry.key);
  }
}

void check_tree(LoadContext& context, const StateSource& state) {
  check_resolved_text(context, state.keys, "");
  for (const StateSource& child : state.children) check_tree(context, child);
}

}  // namespace

void check_resolved(LoadContext& context, const core::YamlNode& node) {
  check_resolved_text(context, node, "");
}

void expand_machine(LoadContext& context) {
  if (const core::YamlNode* templates = context.section("templates")) {
    if (core::expect_map(*templates, "templates by name", context.diagnostics)) {
      for (const core::YamlEntry& entry : templates->entries) check_template(context, entry);
    }
  }
  const core::YamlNode* machine = core::require_key(context.root, "machine", context.diagnostics);
  if (machine == nullptr) return;
  context.machine = expand(context, "machine", machine->mark, *machine, {}, 0);
}

void check_machine_names(LoadContext& context) {
  check_tree(context, context.machine);
  const core::YamlNode* templates = context.section("templates");
  if (templates == nullptr) return;
  const auto& used = context.used_templates;
  for (const core::YamlEntry& entry : templates->entries) {
    if (std::find(used.begin(), used.end(), entry.key) != used.end()) continue;
    context.absence(entry.key_mark, "unused",
                    fmt::format("template '{}' is never used, and not checked", entry.key));
  }
}

}  // namespace footfall::behaviors
