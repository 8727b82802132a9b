// Actions: raise, set, log, mark.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

int intern(std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found != names.end()) return static_cast<int>(found - names.begin());
  names.push_back(name);
  return static_cast<int>(names.size()) - 1;
}

void add(LoadContext& context, ActionInfo action) { context.behavior.actions.push_back(action); }

void load_raise(LoadContext& context, const core::YamlNode& node) {
  const auto name = core::read_text(node, context.diagnostics, "the name of an event");
  if (!name) return;
  if (!core::is_dotted_name(*name)) {
    context.error(node.mark, "event-name",
                  fmt::format("'{}' is no event: names of letters, digits, '_' and '-', with dots "
                              "between",
                              *name));
    return;
  }
  const int event = context.add_event(*name);
  if (event < context.built_in_events && !context.declared_events.contains(*name)) {
    context.error(node.mark, "built-in-event",
                  fmt::format("'{}' is raised by the engine only", *name));
  }
  context.raised_events.push_back({*name, node.mark});
  add(context, {ActionKind::raise, event, -1, 0.0, 0.0});
}

void set_component(LoadContext& context, const ParameterInfo& info, int component,
                   const core::YamlNode& node, const ValueScope& scope) {
  // A parameter without unit accepts any dimension: `goal: [0, 0]` may be set to `[30 cm, 0 cm]`.
  const auto dimension = info.bare ? std::nullopt : std::optional(info.dimension);
  const int expression = context.compile_value(node, dimension, scope);
  const auto value = context.constant_value(expression);
  if (value && info.has_range() && (*value < info.min || *value > info.max)) {
    context.error(node.mark, "out-of-range",
                  fmt::format("'{}' is outside the range of '{}'", node.scalar, info.name));
  }
  context.set_marks[static_cast<int>(context.behavior.actions.size())] = node.mark;
  add(context, {ActionKind::set, info.slot + component, expression, info.min, info.max});
}

void load_set(LoadContext& context, const core::YamlNode& node, const ValueScope& scope) {
  if (!core::expect_map(node, "parameters by name", context.diagnostics)) return;
  if (node.entries.empty()) {
    context.error(node.mark, "empty-value", "nothing to set: expected {PARAMETER: VALUE}");
  }
  for (const core::YamlEntry& entry : node.entries) {
    const auto [index, component] = context.behavior.find_parameter_part(entry.key);
    if (index < 0) {
      context.error(entry.key_mark, "unknown-parameter",
                    fmt::format("unknown parameter '{}'{}", entry.key,
                                core::did_you_mean(entry.key, context.parameter_names())));
      continue;
    }
    ParameterInfo& info = context.behavior.parameters[static_cast<std::size_t>(index)];
    if (info.live) {
      context.error(
          entry.key_mark, "live-variable",
          fmt::format("'{}' is live: an action may not set it; write `live: false`, or leave "
                      "`live` out",
                      entry.key));
    }
    info.variable = true;
    const ParameterInfo copy = info;
    if (component >= 0) {  // `goal.y`
      set_component(context, copy, component, entry.value, scope);
    } else if (!entry.value.is_sequence()) {
      for (int k = 0; k < copy.size; ++k) set_component(context, copy, k, entry.value, scope);
    } else if (static_cast<int>(entry.value.items.size()) == copy.size) {
      for (int k = 0; k < copy.size; ++k) {
        set_component(context, copy, k, entry.value.items[static_cast<std::size_t>(k)], scope);
      }
    } else {
      context.error(entry.value.mark, "size",
                    fmt::format("expected {} values, got {}", copy.size, entry.value.items.size()));
    }
  }
}

// TEXT with `{expr}` fields; `{{` and `}}` are literal braces.
void load_log(LoadContext& context, const core::YamlNode& node, const ValueScope& scope) {
  const auto text = core::read_text(node, context.diagnostics, "a text to log");
  if (!text) return;
  core::warn_cut(node, context.diagnostics);
  LogText log;
  log.pieces.emplace_back();
  for (std::size_t k = 0; k < text->size(); ++k) {
    const char c = (*text)[k];
    if ((c == '{' || c == '}') && k + 1 < text->size() && (*text)[k + 1] == c) {
      log.pieces.back() += c;
      ++k;
    } else if (c == '{') {
      const std::size_t end = text->find('}', k);
      if (end == std::string::npos) {
        context.error(node.mark, "log-text", "'{' without '}' in a text");
        return;
      }
      log.expressions.push_back(context.compile(
          node, std::string_view(*text).substr(k + 1, end - k - 1), k + 1, std::nullopt, scope));
      log.pieces.emplace_back();
      k = end;
    } else {
      log.pieces.back() += c;
    }
  }
  if (log.expressions.size() > kMaxLogValues) {
    context.error(node.mark, "log-text",
                  fmt::format("a text has at most {} fields", kMaxLogValues));
    return;
  }
  add(context, {ActionKind::log, static_cast<int>(context.behavior.logs.size()), -1, 0.0, 0.0});
  context.behavior.logs.push_back(std::move(log));
}

void load_mark(LoadContext& context, const core::YamlNode& node) {
  const auto name = core::read_name(node, context.diagnostics, "the name of a mark");
  if (!name) return;
  context.marks.emplace_back(*name, node.mark);
  const int mark = intern(context.behavior.marks, *name);
  if (*name == "step") context.behavior.step = mark;
  add(context, {ActionKind::mark, mark, -1, 0.0, 0.0});
}

// A registered C++ function, or a script function.
void load_call(LoadContext& context, const core::YamlNode& node) {
  const auto name = core::read_text(node, context.diagnostics, "the name of a function");
  if (!name) return;
  CallInfo info{*name, nullptr};
  std::vector<std::string> known = context.script_functions;
  for (const NativeFunctionInfo& native : context.options.functions) {
    known.push_back(native.name);
    if (native.name == *name) info.native = native.function;
  }
  if (std::find(known.begin(), known.end(), *name) == known.end()) {
    if (context.scripts_failed) return;
    context.error(node.mark, "unknown-function",
                  fmt::format("unknown function '{}': no file of `scripts` defines it, and the "
                              "program registers none of this name{}",
                              *name, core::did_you_mean(*name, known)));
    return;
  }
  auto& calls = context.behavior.calls;
  const auto same = [&](const CallInfo& other) { return other.name == *name; };
  const auto found = std::find_if(calls.begin(), calls.end(), same);
  const int index = static_cast<int>(found - calls.begin());
  if (found == calls.end()) calls.push_back(info);
  add(context, {ActionKind::call, index, -1, 0.0, 0.0});
}

void load_action(LoadContext& context, const core::YamlNode& node, const ValueScope& scope) {
  if (!core::expect_map(node, "an action such as {mark: NAME}", context.diagnostics)) return;
  core::check_keys(node, kActionKeys, context.diagnostics);
  for (const core::YamlEntry& entry : node.entries) {
    if (entry.key == "raise") load_raise(context, entry.value);
    if (entry.key == "set") load_set(context, entry.value, scope);
    if (entry.key == "log") load_log(context, entry.value, scope);
    if (entry.key == "mark") load_mark(context, entry.value);
    if (entry.key == "call") load_call(context, entry.value);
  }
}

}  // namespace

Range load_actions(LoadContext& context, const core::YamlNode& node, int state) {
  const int first = static_cast<int>(context.behavior.actions.size());
  if (!core::expect_sequence(node, "a list of actions", context.diagnostics)) return {};
  ValueScope scope;
  scope.state = state;
  for (const core::YamlNode& item : node.items) load_action(context, item, scope);
  return {first, static_cast<int>(context.behavior.actions.size()) - first};
}

}  // namespace footfall::behaviors
