// Unused names, usually a sign of a misspelt one elsewhere.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <set>

#include "behaviors/check/structure/structure.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

void collect_names(const std::string& text, std::set<std::string>& names) {
  const auto is_name = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  for (std::size_t k = text.find('$'); k != std::string::npos; k = text.find('$', k)) {
    const std::size_t first = ++k;
    while (k < text.size() && is_name(text[k])) ++k;
    names.insert(text.substr(first, k - first));
  }
}

// Collects every `$name` in the text of a tree.
void collect_names(const core::YamlNode& node, std::set<std::string>& names) {
  collect_names(node.scalar, names);
  for (const core::YamlNode& item : node.items) collect_names(item, names);
  for (const core::YamlEntry& entry : node.entries) {
    collect_names(entry.key, names);
    collect_names(entry.value, names);
  }
}

bool a_script_names(const LoadContext& context, const std::string& name) {
  const auto& scripts = context.behavior.scripts;
  return std::any_of(scripts.begin(), scripts.end(), [&](const ScriptFile& file) {
    return file.text.find(name) != std::string::npos;
  });
}

void check_parameters(LoadContext& context) {
  const core::YamlNode* parameters = context.section("parameters");
  if (parameters == nullptr) return;
  std::set<std::string> used;
  for (const core::YamlEntry& entry : context.root.entries) {
    if (entry.key != "parameters") collect_names(entry.value, used);
  }
  std::set<std::string> watched;
  for (const EventPattern& pattern : context.behavior.patterns) watched.insert(pattern.text);
  std::vector<std::string> read;  // parameters of which one may be meant
  for (const core::YamlEntry& entry : parameters->entries) {
    if (used.contains(entry.key)) read.push_back(entry.key);
  }
  for (const core::YamlEntry& entry : parameters->entries) {
    if (used.contains(entry.key) || watched.contains("parameter.changed." + entry.key)) continue;
    const int index = context.behavior.find_parameter(entry.key);
    if (index < 0 || a_script_names(context, entry.key)) continue;
    const bool set = context.behavior.parameters[at(index)].variable;
    context.warning(entry.key_mark, "unused",
                    fmt::format("parameter '{}' is {}: nothing reads ${}{}", entry.key,
                                set ? "set, but never used" : "never used", entry.key,
                                core::did_you_mean(entry.key, read)));
  }
}

bool is_mirrored(const LoadContext& context, const std::string& name) {
  return std::any_of(context.mirrored.begin(), context.mirrored.end(),
                     [&](const auto& mirrored) { return mirrored.first == name; });
}

// An argument may also be used in a stack named by the template's states; the first argument of a
// mirrored template names the two states.
void check_arguments(LoadContext& context, const core::YamlEntry& entry,
                     const std::set<std::string>& in_stacks) {
  const core::YamlNode* args = entry.value.find("args");
  if (args == nullptr) return;
  std::set<std::string> used = in_stacks;
  for (const core::YamlEntry& key : entry.value.entries) {
    if (key.key != "args") collect_names(key.value, used);
  }
  for (const core::YamlNode& item : args->items) {
    const bool names_states = &item == &args->items.front() && is_mirrored(context, entry.key);
    if (used.contains(item.scalar) || names_states) continue;
    context.warning(
        item.mark, "unused",
        fmt::format("argument '{}' of template '{}' is never used", item.scalar, entry.key));
  }
}

void check_templates(LoadContext& context) {
  const core::YamlNode* templates = context.section("templates");
  if (templates == nullptr) return;
  std::set<std::string> in_stacks;
  if (const core::YamlNode* stacks = context.section("stacks")) collect_names(*stacks, in_stacks);
  for (const core::YamlEntry& entry : templates->entries) {
    const auto& used = context.used_templates;
    if (std::find(used.begin(), used.end(), entry.key) == used.end()) continue;  // reported
    check_arguments(context, entry, in_stacks);
  }
}

void check_torque_loops(LoadContext& context) {
  const core::YamlNode* tables = context.section("torque_loop");
  if (tables == nullptr) return;
  for (const core::YamlEntry& entry : tables->entries) {
    const auto& used = context.used_torque_loops;
    if (entry.key == "ranges") continue;
    if (std::find(used.begin(), used.end(), entry.key) != used.end()) continue;
    context.warning(entry.key_mark, "unused",
                    fmt::format("torque_loop table '{}' is never used{}", entry.key,
                                core::did_you_mean(entry.key, used)));
  }
}

void check_planners(LoadContext& context) {
  const core::YamlNode* planners = context.section("planners");
  if (planners == nullptr) return;
  std::set<std::string> asked;
  for (const InvokeInfo& invoke : context.behavior.invokes) {
    if (invoke.planner >= 0) asked.insert(context.behavior.planners[at(invoke.planner)].name);
  }
  for (const core::YamlEntry& entry : planners->entries) {
    if (asked.contains(entry.key)) continue;
    context.warning(entry.key_mark, "unused",
                    fmt::format("no state invokes planner '{}': it never plans{}", entry.key,
                                core::did_you_mean(entry.key, {asked.begin(), asked.end()})));
  }
}

// A value of --set that an entry at the start overwrites before anything reads it.
void check_override(LoadContext& context, const std::string& name) {
  const Behavior& behavior = context.behavior;
  const int parameter = behavior.find_parameter_part(name).parameter;
  if (parameter < 0) return;
  const SetAtStart found = set_at_start(context, parameter);
  if (found.state < 0) return;
  context.warning(
      found.mark, "unused",
      fmt::format("--set {} changes nothing: the entry of '{}' sets '{}' here, at the start", name,
                  behavior.states[at(found.state)].path, behavior.parameters[at(parameter)].name));
}

}  // namespace

SetAtStart set_at_start(const LoadContext& context, int parameter) {
  const Behavior& behavior = context.behavior;
  const ParameterInfo& info = behavior.parameters[at(parameter)];
  if (!info.variable) return {};
  EntrySet entries(behavior);
  for (const int s : entries.of_start()) {
    const StateInfo& state = behavior.states[at(s)];
    for (int a = state.on_entry.first; a < state.on_entry.end(); ++a) {
      const ActionInfo& action = behavior.actions[at(a)];
      const bool sets = action.kind == ActionKind::set && action.index >= info.slot &&
                        action.index < info.slot + info.size;
      const auto mark = context.set_marks.find(a);
      if (sets && mark != context.set_marks.end()) return {s, mark->second};
    }
  }
  return {};
}

void check_unused(LoadContext& context) {
  for (const auto& [name, text] : context.options.set) check_override(context, name);
  check_parameters(context);
  check_templates(context);
  check_torque_loops(context);
  check_planners(context);
}

}  // namespace footfall::behaviors
