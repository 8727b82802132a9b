// Verifies that changed files load to exactly the requested values; see parts.h.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "behaviors/check/physics/check.h"
#include "behaviors/compile.h"
#include "behaviors/loader.h"
#include "behaviors/save/parts.h"
#include "core/same_bits.h"
#include "core/text/search_folders.h"
#include "core/yaml_text/edit.h"

namespace footfall::behaviors {
namespace {

std::string path_text(const KeyPath& path) { return fmt::format("{}", fmt::join(path, ".")); }

// The first path at which two trees differ, except for allowed paths.
std::optional<KeyPath> first_difference(const core::YamlNode& a, const core::YamlNode& b,
                                        KeyPath& path, const std::vector<KeyPath>& allowed) {
  const auto is_allowed = [&](const KeyPath& head) { return begins_with(path, head); };
  if (std::ranges::any_of(allowed, is_allowed)) return std::nullopt;
  if (a.kind != b.kind || a.scalar != b.scalar || a.quoted != b.quoted) return path;
  const auto inside = [&](const std::string& key, const core::YamlNode& x,
                          const core::YamlNode& y) {
    path.push_back(key);
    auto found = first_difference(x, y, path, allowed);
    path.pop_back();
    return found;
  };
  if (a.items.size() != b.items.size() || a.entries.size() != b.entries.size()) return path;
  for (std::size_t k = 0; k < a.items.size(); ++k) {
    if (auto found = inside(std::to_string(k), a.items[k], b.items[k])) return found;
  }
  for (std::size_t k = 0; k < a.entries.size(); ++k) {
    if (a.entries[k].key != b.entries[k].key) return path;
    auto found = inside(a.entries[k].key, a.entries[k].value, b.entries[k].value);
    if (found) return found;
  }
  return std::nullopt;
}

bool same_parameter(const ParameterInfo& a, const ParameterInfo& b) {
  return a.name == b.name && a.size == b.size && a.slot == b.slot && a.dimension == b.dimension &&
         core::same_bits(a.min, b.min) && core::same_bits(a.max, b.max) && a.live == b.live &&
         a.variable == b.variable && a.gain == b.gain && a.bare == b.bare;
}

// The first error in the form `file:line:column: text`.
std::string first_error(const core::Diagnostics& diagnostics) {
  for (const core::Diagnostic& item : diagnostics.sorted()) {
    if (item.severity != core::Severity::error) continue;
    const std::string file = item.mark.file < 0 ? "" : diagnostics.file(item.mark.file);
    return fmt::format("{}:{}:{}: {}", file, item.mark.line, item.mark.column, item.text);
  }
  return "it cannot be loaded";
}

void compare_values(const Behavior& old, const Behavior& now, const std::vector<Wanted>& wanted,
                    std::vector<std::string>& reasons) {
  for (std::size_t p = 0; p < old.parameters.size(); ++p) {
    const ParameterInfo& info = old.parameters[p];
    const auto found = std::ranges::find(wanted, static_cast<int>(p), &Wanted::parameter);
    for (int k = 0; k < info.size; ++k) {
      const auto slot = static_cast<std::size_t>(info.slot + k);
      const bool asked = found != wanted.end();
      const double expected = asked ? found->values[static_cast<std::size_t>(k)] : old.values[slot];
      if (core::same_bits(now.values[slot], expected)) continue;
      reasons.push_back(
          asked ? fmt::format("{}: it would read back as {}, not {}", info.name, now.values[slot],
                              expected)
                : fmt::format("{}: it shares its text with what is saved and would become {} too "
                              "(save the same value for both)",
                              info.name, now.values[slot]));
      break;
    }
  }
}

// Notes new physics problems: a running behavior tolerates values with which `run` refuses to
// start.
void note_physics(const Behavior& old, const Behavior& now, core::Diagnostics& diagnostics,
                  std::vector<std::string>& notes) {
  core::Diagnostics before = diagnostics;
  check_physics(old, before);
  if (before.has_errors()) return;  // unchanged by the save
  check_physics(now, diagnostics);
  if (!diagnostics.has_errors()) return;
  notes.push_back("with these values `run` refuses it: " + first_error(diagnostics));
}

}  // namespace

std::vector<std::string> reasons_against_result(const SaveSource& old, const std::string& path,
                                                const std::vector<core::FileChange>& changes,
                                                const std::vector<Wanted>& wanted,
                                                const std::vector<KeyPath>& allowed,
                                                std::vector<std::string>& notes) {
  core::Diagnostics diagnostics;
  SaveSource now(old.context.options, diagnostics);
  core::YamlNode root = core::load_changed_yaml_with_base(
      path, changes, diagnostics,
      library_folders(core::search_from(path, old.context.options.search)));
  if (!compile_behavior(now.context, std::move(root), path)) {
    return {"with these values it does not load: " + first_error(diagnostics)};
  }
  if (!std::ranges::equal(old.behavior.parameters, now.behavior.parameters, same_parameter)) {
    return {"with these values it does not have the same parameters any more"};
  }
  std::vector<std::string> reasons;
  compare_values(old.behavior, now.behavior, wanted, reasons);
  KeyPath at;
  const auto other = first_difference(old.context.root, now.context.root, at, allowed);
  if (reasons.empty() && other) {
    reasons.push_back(fmt::format("{} would change too: it shares its text with what is saved",
                                  path_text(*other)));
  }
  if (reasons.empty()) note_physics(old.behavior, now.behavior, diagnostics, notes);
  return reasons;
}

}  // namespace footfall::behaviors
