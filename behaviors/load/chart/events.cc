// The event table, and which events enable which transition.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"

namespace footfall::behaviors {
namespace {

void add_built_in(LoadContext& context) {
  Behavior& behavior = context.behavior;
  behavior.error_execution = context.add_event("error.execution");
  for (int f = 0; f < core::kFaultCount; ++f) {
    const auto name = core::fault_name(static_cast<core::Fault>(f));
    behavior.fault_events.push_back(context.add_event(fmt::format("fault.{}", name)));
  }
  for (const auto& contact : behavior.robot.contacts) {
    behavior.touchdown_events.push_back(
        context.add_event(fmt::format("contact.{}.touchdown", contact.name)));
    behavior.liftoff_events.push_back(
        context.add_event(fmt::format("contact.{}.liftoff", contact.name)));
  }
  for (const ParameterInfo& parameter : behavior.parameters) {
    behavior.changed_events.push_back(context.add_event("parameter.changed." + parameter.name));
  }
  for (StateInfo& state : behavior.states) {
    if (state.kind != StateKind::compound && state.kind != StateKind::parallel) continue;
    state.done_event = context.add_event("done.state." + state.path);
  }
}

std::vector<const core::YamlNode*> patterns_of(const core::YamlNode& on) {
  std::vector<const core::YamlNode*> patterns;
  if (on.is_sequence() && !on.items.empty()) {
    for (const core::YamlNode& item : on.items) patterns.push_back(&item);
  } else {
    patterns.push_back(&on);
  }
  return patterns;
}

void check_event_name(LoadContext& context, const std::string& name, core::Mark mark) {
  if (core::is_dotted_name(name)) return;
  context.error(mark, "event-name",
                fmt::format("'{}' is no event: names of letters, digits, '_' and '-', with dots "
                            "between",
                            name));
}

constexpr std::string_view kDone = "done.state.";

// A prefix consists of whole parts: `fault.*`, not `fault*`.
bool check_prefix(LoadContext& context, const core::YamlNode& node) {
  std::string stem = node.scalar.substr(0, node.scalar.find('*'));
  if (stem.ends_with('.')) stem.pop_back();
  if (core::is_dotted_name(stem) && node.scalar == stem + ".*") return true;
  const std::string hint = core::is_dotted_name(stem)
                               ? fmt::format(" (did you mean '{}.*'?)", stem)
                               : std::string(": `fault.*` means `fault` and all below it");
  context.error(node.mark, "event-name",
                fmt::format("'{}' is no prefix of events{}", node.scalar, hint));
  return false;
}

// One event name or pattern of a transition's `on`; done.state.NAME is resolved like a target.
std::string resolve_pattern(LoadContext& context, int state, const core::YamlNode& node) {
  if (!node.is_scalar() || node.scalar.empty()) {
    core::report_expected(node, "the name of an event", context.diagnostics);
    return {};
  }
  const std::string& text = node.scalar;
  if (text != "*" && text.find('*') != std::string::npos && !check_prefix(context, node)) return {};
  if (!text.starts_with(kDone) || text.ends_with("*")) {
    if (!text.ends_with("*")) context.add_event(text);
    return text;
  }
  std::string why;
  const int target = context.find_target(state, std::string_view(text).substr(kDone.size()), why);
  if (target < 0) {
    core::Mark mark = node.mark;
    mark.column += static_cast<int>(kDone.size()) + (node.quoted ? 1 : 0);
    if (!context.states_missing) context.error(mark, "unknown-state", why);
    return {};
  }
  const StateInfo& info = context.behavior.states[static_cast<std::size_t>(target)];
  if (info.done_event < 0) {
    context.error(node.mark, "never-done",
                  fmt::format("'{}' has no states of its own: it is never done", info.path));
    return {};
  }
  return context.behavior.events[static_cast<std::size_t>(info.done_event)];
}

}  // namespace

void load_events(LoadContext& context) {
  if (const core::YamlNode* events = context.section("events")) {
    if (core::expect_map(*events, "events by name", context.diagnostics)) {
      for (const core::YamlEntry& entry : events->entries) {
        core::check_doc(entry.value, context.diagnostics);
        check_event_name(context, entry.key, entry.key_mark);
        context.declared_events.insert(entry.key);
        context.add_event(entry.key);
      }
    }
  }
  add_built_in(context);
  context.built_in_events = static_cast<int>(context.behavior.events.size());
}

void load_patterns(LoadContext& context, int state, const core::YamlNode& on, int transition) {
  auto& out = context.behavior.patterns;
  const std::size_t first = out.size();
  for (const core::YamlNode* node : patterns_of(on)) {
    const std::string text = resolve_pattern(context, state, *node);
    if (text.empty()) continue;
    for (std::size_t k = first; k < out.size(); ++k) {
      if (out[k].text != text) continue;
      context.error(node->mark, "duplicate", fmt::format("event '{}' twice", text));
    }
    out.push_back({transition, text, node->mark});
  }
}

void finish_events(LoadContext& context) {
  Behavior& behavior = context.behavior;
  for (std::size_t p = behavior.changed_events.size(); p < behavior.parameters.size(); ++p) {
    behavior.changed_events.push_back(  // their number is known only after gains are loaded
        context.add_event("parameter.changed." + behavior.parameters[p].name));
  }
  if (!context.script_patterns.empty()) {
    behavior.script_events.assign(behavior.events.size(), 0);
    for (std::size_t e = 0; e < behavior.events.size(); ++e) {
      for (const std::string& pattern : context.script_patterns) {
        if (Chart::event_matches(pattern, behavior.events[e])) behavior.script_events[e] = 1;
      }
    }
  }
  behavior.match_events();
  for (const int event : behavior.changed_events) {
    const int rank = behavior.event_ranks[static_cast<std::size_t>(event)];
    behavior.watches_parameters =
        behavior.watches_parameters ||
        std::any_of(behavior.heard_ranks.begin(), behavior.heard_ranks.end(),
                    [rank](Range heard) { return rank >= heard.first && rank < heard.end(); });
  }
}

}  // namespace footfall::behaviors
