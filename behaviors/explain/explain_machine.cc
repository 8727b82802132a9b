// Effective values of a behavior file and of expanded states; see explain_machine.h.
#include "behaviors/explain/explain_machine.h"

#include <fmt/format.h>

#include <algorithm>

#include "behaviors/compile.h"
#include "behaviors/language/language.h"
#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"
#include "behaviors/load/substitution.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

// Removes the next part from a dotted key and returns it.
std::string_view take_part(std::string_view& key) {
  const std::size_t dot = std::min(key.find('.'), key.size());
  const std::string_view part = key.substr(0, dot);
  key.remove_prefix(std::min(dot + 1, key.size()));
  return part;
}

// Removes the control bytes that frame arguments in expressions, for display.
void clean(core::YamlNode& node) {
  if (node.is_scalar()) node.scalar = read_marked(node.scalar).text;
  for (core::YamlNode& item : node.items) clean(item);
  for (core::YamlEntry& entry : node.entries) clean(entry.value);
}

const StateSource* child_named(const StateSource& state, std::string_view name) {
  for (const StateSource& child : state.children) {
    if (child.name == name) return &child;
  }
  return nullptr;
}

}  // namespace

void apply_settings(core::YamlNode& root,
                    const std::vector<std::pair<std::string, std::string>>& settings,
                    core::Diagnostics& diagnostics) {
  Behavior behavior;
  LoadOptions options;
  options.set = settings;
  LoadContext context(behavior, options, diagnostics);
  context.root = std::move(root);
  apply_overrides(context);
  root = std::move(context.root);
}

StateExplanation explain_state(core::YamlNode root, const std::string& path,
                               const LoadOptions& options, std::string_view key,
                               core::Diagnostics& diagnostics) {
  StateExplanation out;
  Behavior behavior;
  LoadContext context(behavior, options, diagnostics);
  if (!compile_behavior(context, std::move(root), path)) {
    out.explanation.problem = "the states are not known before these errors are mended";
    return out;
  }
  const StateSource* state = &context.machine;
  std::string_view rest = key;
  take_part(rest);  // skip `machine`
  while (!rest.empty()) {
    std::string_view after = rest;
    const std::string_view part = take_part(after);
    const StateSource* child = child_named(*state, part);
    if (child == nullptr && part != "states") break;
    if (child != nullptr && !child->origin.empty()) out.made_from.push_back(child->origin);
    if (child != nullptr) state = child;
    rest = after;
  }
  const std::string wrong(rest.substr(0, rest.find('.')));
  const bool known = wrong.empty() || state->keys.find(wrong) != nullptr ||
                     core::find_key(kStateKeys, wrong) != nullptr;
  if (!known) {
    std::vector<std::string> names = core::key_names(kStateKeys);
    for (const StateSource& child : state->children) names.push_back(child.name);
    out.explanation.problem =
        fmt::format("unknown state or key '{}'{}", wrong, core::did_you_mean(wrong, names));
    return out;
  }
  core::YamlNode keys = state->keys;
  clean(keys);
  out.explanation = core::explain(keys, {}, &kStateKeys, rest);
  for (core::ValueOrigin& value : out.explanation.values) {
    const std::string_view prefix = key.substr(0, key.size() - rest.size());
    value.path = std::string(prefix) + (rest.empty() ? "." : "") + value.path;
  }
  return out;
}

}  // namespace footfall::behaviors
