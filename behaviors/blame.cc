// Tries a file without single values that are given on top of it; see blame.h.
#include "behaviors/blame.h"

#include <fmt/format.h>

#include <set>
#include <tuple>

namespace footfall::behaviors {
namespace {

using Key = std::tuple<int, int, int, std::string>;

Key key_of(const core::Diagnostic& item) {
  return {item.mark.file, item.mark.line, item.mark.column, item.id};
}

std::set<Key> new_keys(const core::Diagnostics& diagnostics, std::size_t from) {
  std::set<Key> keys;
  for (std::size_t k = from; k < diagnostics.all().size(); ++k) {
    keys.insert(key_of(diagnostics.all()[k]));
  }
  return keys;
}

// The first new error of a load, nullptr if there is none.
const core::Diagnostic* first_error(const core::Diagnostics& diagnostics, std::size_t from) {
  for (std::size_t k = from; k < diagnostics.all().size(); ++k) {
    if (diagnostics.all()[k].severity == core::Severity::error) return &diagnostics.all()[k];
  }
  return nullptr;
}

// A problem of `from` at an override; at its own place if that is in the override's text.
core::Diagnostic at_override(const core::Diagnostic& problem, const core::Diagnostics& from,
                             const std::string& name, const char* why, core::Diagnostics& to) {
  const std::string file = "--set " + name;
  const bool there = problem.mark.file >= 0 && from.file(problem.mark.file) == file;
  core::Diagnostic moved = problem;
  moved.mark = {to.add_file(file), there ? problem.mark.line : 1, there ? problem.mark.column : 1};
  if (!there && problem.mark.file >= 0) {
    moved.text += fmt::format(" ({} {})", why, from.place_text(problem.mark));
  }
  return moved;
}

// Moves findings to the override that alone brings them.
core::Diagnostics blame_set(const core::YamlNode& root, const LoadOptions& options,
                            const core::Diagnostics& before, const core::Diagnostics& found,
                            const TreeWithOptions& load) {
  LoadOptions other = options;
  other.set.clear();
  core::Diagnostics without = before;
  load(root, other, without);
  const std::size_t first = before.all().size();
  const std::set<Key> own = new_keys(without, first);
  std::vector<std::set<Key>> alone;
  for (const auto& edit : options.set) {
    other.set = {edit};
    core::Diagnostics trial = before;
    load(root, other, trial);
    alone.push_back(new_keys(trial, first));
  }
  core::Diagnostics out = before;
  for (int k = 0; k < found.file_count(); ++k) out.add_file(found.file(k));
  for (std::size_t k = first; k < found.all().size(); ++k) {
    const core::Diagnostic& item = found.all()[k];
    const Key key = key_of(item);
    std::size_t by = 0;
    while (by < alone.size() && !alone[by].contains(key)) ++by;
    const bool blamed = !own.contains(key) && by < alone.size();
    out.add(blamed ? at_override(item, found, options.set[by].first, "found at", out) : item);
  }
  return out;
}

}  // namespace

bool blame_overrides(const core::YamlNode& root, const LoadOptions& options,
                     const TreeWithOptions& load, core::Diagnostics& diagnostics) {
  LoadOptions other = options;
  other.set.clear();
  core::Diagnostics without = diagnostics;
  if (!load(root, other, without)) return false;
  bool found = false;
  for (const auto& edit : options.set) {
    core::Diagnostics alone = without;
    const std::size_t before = alone.all().size();
    other.set = {edit};
    load(root, other, alone);
    const core::Diagnostic* problem = first_error(alone, before);
    if (problem == nullptr) continue;
    found = true;
    diagnostics.add(at_override(*problem, alone, edit.first, "needed at", diagnostics));
  }
  return found;
}

core::Diagnostics blame_findings(const core::YamlNode& root, const core::YamlLayers& layers,
                                 const LoadOptions& options, const core::Diagnostics& before,
                                 core::Diagnostics found, const TreeWithOptions& load) {
  if (found.all().size() == before.all().size()) return found;
  if (!options.set.empty()) found = blame_set(root, options, before, found, load);
  return core::blame_edits(
      layers, before, found,
      [&](const core::YamlNode& tree, core::Diagnostics& problems) {
        load(tree, options, problems);
      },
      core::Blamed::all);
}

}  // namespace footfall::behaviors
