// Warnings about unused and missing items, after everything is loaded. Suppressed after errors,
// which may be the cause.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void warn_stacks(LoadContext& context) {
  const core::YamlNode* stacks = context.section("stacks");
  if (stacks == nullptr || !core::expect_map(*stacks, "stacks by name", context.diagnostics)) {
    return;
  }
  for (const core::YamlEntry& entry : stacks->entries) {
    core::check_name(entry, context.diagnostics, "the name of a stack");
    context.behavior.stacks.push_back(entry.key);
    if (contains(context.used_stacks, entry.key)) continue;
    context.absence(entry.key_mark, "unused",
                    fmt::format("stack '{}' is never used, and not checked{}", entry.key,
                                core::did_you_mean(entry.key, context.used_stacks)));
  }
}

// `mark: step` counts steps: a behavior without it, but with a similar mark, probably has a typo.
void warn_marks(LoadContext& context) {
  if (context.behavior.step >= 0) return;
  for (const auto& [name, mark] : context.marks) {
    if (core::did_you_mean(name, {"step"}).empty()) continue;
    context.warning(mark, "near-step",
                    fmt::format("only `mark: step` counts steps, '{}' does not", name));
  }
}

}  // namespace

void warn_absences(LoadContext& context) {
  warn_stacks(context);
  warn_marks(context);
}

}  // namespace footfall::behaviors
