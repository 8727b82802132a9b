// Writes values back to the files that define them; see values.h.
#include "behaviors/save/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <tuple>

#include "behaviors/check/structure/structure.h"
#include "behaviors/compile.h"
#include "behaviors/load/control/gains.h"
#include "behaviors/load/steps.h"
#include "behaviors/loader.h"
#include "behaviors/save/parts.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/same_bits.h"
#include "core/text/search_folders.h"
#include "core/yaml_text/write.h"

namespace footfall::behaviors {
namespace {

namespace fs = std::filesystem;

// Reason why there is no parameter with this name.
std::string unknown_reason(const SaveSource& source, const std::string& name) {
  const std::size_t dot = name.rfind('.');
  if (dot != std::string::npos) {
    const auto entry = source.context.gain_entries.find(name.substr(0, dot));
    const auto gain = std::ranges::find(kGainNames, name.substr(dot + 1));
    if (entry != source.context.gain_entries.end() && gain != kGainNames.end() &&
        entry->second.computed[static_cast<std::size_t>(gain - kGainNames.begin())]) {
      return fmt::format("it is given by an expression, {}: save the parameters in it",
                         core::to_flow_yaml(*entry->second.node->find(*gain)));
    }
  }
  std::vector<std::string> names;
  for (const ParameterInfo& info : source.behavior.parameters) names.push_back(info.name);
  return "there is no such parameter or gain" + core::did_you_mean(name, names);
}

// Reason why a parameter cannot have these values; empty if it can.
std::string reason_against(const ParameterInfo& info, const std::vector<double>& values) {
  for (const double value : values) {
    if (!std::isfinite(value)) return fmt::format("{} is not a finite number", value);
    const bool negative_gain = info.gain && value < 0.0;
    if (!negative_gain && (!info.has_range() || (value >= info.min && value <= info.max))) continue;
    const std::string unit = core::unit_text(info.dimension);
    return negative_gain && !info.has_range()
               ? "a gain cannot be negative"
               : fmt::format("{:g} is outside its range, {:g} to {:g}{}{}", value, info.min,
                             info.max, unit.empty() ? "" : " ", unit);
  }
  return "";
}

// Collects the parameters with new values from requests by name.
void collect_wanted(SavePlanner& planner, const std::vector<NamedValue>& values) {
  const Behavior& behavior = planner.source.behavior;
  std::map<int, std::vector<std::optional<double>>> asked;  // by parameter and component
  for (const NamedValue& value : values) {
    const ParameterPart part = behavior.find_parameter_part(value.name);
    if (part.parameter < 0) {
      planner.refuse({}, value.name, unknown_reason(planner.source, value.name));
      continue;
    }
    const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(part.parameter)];
    const auto size = static_cast<std::size_t>(part.component < 0 ? info.size : 1);
    if (value.values.size() != size) {
      planner.refuse({}, value.name,
                     fmt::format("expected {} values, got {}", size, value.values.size()));
      continue;
    }
    auto& all = asked[part.parameter];
    all.resize(static_cast<std::size_t>(info.size));
    for (std::size_t k = 0; k < size; ++k) {
      auto& one = all[part.component < 0 ? k : static_cast<std::size_t>(part.component)];
      if (one && !core::same_bits(*one, value.values[k])) {
        planner.refuse({}, value.name, "it is asked for twice, with different values");
      }
      one = value.values[k];
    }
  }
  for (const auto& [parameter, given] : asked) {
    const ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(parameter)];
    Wanted wanted{parameter, {}, {}};
    bool differs = false;
    for (std::size_t k = 0; k < given.size(); ++k) {
      const double old = behavior.values[static_cast<std::size_t>(info.slot) + k];
      wanted.values.push_back(given[k].value_or(old));
      differs = differs || !core::same_bits(wanted.values.back(), old);
    }
    if (!differs) continue;
    wanted.home = find_home(planner.source, info);
    const core::Mark mark = wanted.home.node == nullptr ? core::Mark{} : wanted.home.node->mark;
    const std::string reason = reason_against(info, wanted.values);
    if (!reason.empty()) planner.refuse(mark, info.name, reason);
    planner.wanted.push_back(std::move(wanted));
  }
}

// Value of `base:` in `overlay`: a file beside it, a library name, else a relative path.
std::string base_text(const std::string& overlay, const std::string& base,
                      const LoadOptions& options) {
  const fs::path folder = fs::path(identity(overlay)).parent_path();
  const fs::path real = identity(base);
  std::string text = real.lexically_relative(folder).string();
  for (const std::string& library : library_folders(options.search)) {
    std::error_code error;
    const fs::path file = fs::path(library) / real.filename();
    if (folder == real.parent_path() || !fs::is_regular_file(file, error)) continue;
    const fs::path beside = folder / real.filename();
    if (identity(file.string()) == real.string() && !fs::exists(beside, error)) {
      text = real.stem().string();
    }
    break;
  }
  core::YamlNode node;
  node.kind = core::YamlNode::Kind::scalar;
  node.scalar = text.empty() ? real.string() : text;
  return core::to_flow_yaml(node);
}

// Loads the behavior at `path`; false and errors on failure.
bool load_source(SaveSource& source, const std::string& path, core::Diagnostics& diagnostics) {
  core::YamlNode root = load_tree(path, source.context.options, diagnostics);
  return compile_behavior(source.context, std::move(root), path);
}

// Whether a file was read during a load.
bool was_read(const core::Diagnostics& files, const std::string& path) {
  for (int k = 0; k < files.file_count(); ++k) {
    if (identity(files.file(k)) == identity(path)) return true;
  }
  return false;
}

void note_bases(SavePlanner& planner, const std::string& path) {
  for (const core::FileChange& change : planner.plan.files) {
    if (change.is_new || identity(change.path) == identity(path)) continue;
    planner.plan.notes.push_back(
        fmt::format("{} is a base of {}: what is written there holds for every behavior on it",
                    change.path, path));
  }
}

void note_variables(SavePlanner& planner) {
  if (planner.plan.files.empty()) return;
  for (const Wanted& wanted : planner.wanted) {
    const SetAtStart found = set_at_start(planner.source.context, wanted.parameter);
    if (found.state < 0) continue;
    planner.plan.notes.push_back(fmt::format(
        "{}:{}:{}: the entry of '{}' sets '{}' at the start of a run: its value in the file is "
        "never used",
        planner.path_of(found.mark), found.mark.line, found.mark.column,
        planner.source.behavior.states[static_cast<std::size_t>(found.state)].path,
        planner.info(wanted).name));
  }
}

void make_plan(SavePlanner& planner, const std::string& path) {
  const auto place_of = [](const SavedPlace& place) {
    return std::tie(place.file, place.line, place.column);
  };
  for (const Wanted& wanted : planner.wanted) {
    if (!planner.plan.refused()) place_edits(planner, wanted);
  }
  std::ranges::stable_sort(planner.plan.places,
                           [&](const auto& a, const auto& b) { return place_of(a) < place_of(b); });
  for (auto& [id, file] : planner.changes) {
    if (planner.plan.refused() || !finish_file(planner, file)) return;
    if (file.change.before != file.change.after) planner.plan.files.push_back(file.change);
  }
  if (planner.plan.refused() || planner.plan.files.empty()) return;
  planner.plan.refusals =
      reasons_against_result(planner.source, path, planner.plan.files, planner.wanted,
                             planner.allowed, planner.plan.notes);
  note_bases(planner, path);
  note_variables(planner);
}

// Opens the file that gets all values; false and a refusal if it cannot be written.
bool open_target(SavePlanner& planner, const std::string& file, const std::string& path,
                 bool is_new) {
  planner.only = identity(file);
  if (!is_new) return open_file(planner, file, {}, file) != nullptr;
  if (const std::string reason = reason_against_file(planner, file); !reason.empty()) {
    planner.plan.refusals.push_back(reason);
    return false;
  }
  const std::string head =
      fmt::format("behavior: 1\nbase: {}\n", base_text(file, path, planner.source.context.options));
  planner.changes[planner.only].change = {file, "", head, true};
  return true;
}

}  // namespace

SavePlan plan_save(const std::string& path, const LoadOptions& options,
                   const std::vector<NamedValue>& values, const SaveTarget& target,
                   core::Diagnostics& diagnostics) {
  SavePlan plan;
  LoadOptions own = options;
  own.set.clear();
  std::error_code error;
  const bool is_new = !target.file.empty() && !fs::exists(fs::symlink_status(target.file, error));
  const std::string from = target.file.empty() || is_new ? path : target.file;
  core::Diagnostics problems;
  SaveSource source(own, problems);
  if (!load_source(source, from, problems)) {
    diagnostics = std::move(problems);
    plan.refusals.push_back(from + ": it does not load");
    return plan;
  }
  if (!was_read(problems, path)) {
    plan.refusals.push_back(
        fmt::format("{}: it is there already and {} is not among its bases", from, path));
    return plan;
  }
  SavePlanner planner{source, problems, plan};
  const std::string& file = is_new ? target.file : from;
  planner.named = identity(file);
  planner.libraries = library_folders(core::search_from(path, options.search));
  planner.installed = target.installed;
  collect_wanted(planner, values);
  if (plan.refused() || planner.wanted.empty()) return plan;
  if (target.into_bases || open_target(planner, file, path, is_new)) make_plan(planner, file);
  if (plan.refused()) plan.files.clear();
  return plan;
}

std::string unified_diff(const SavePlan& plan) {
  std::string out;
  for (const core::FileChange& change : plan.files) {
    out += core::unified_diff(change.path, change.before, change.after, change.is_new);
  }
  return out;
}

std::vector<std::string> write_saved(const SavePlan& plan) {
  if (plan.refused()) return plan.refusals;
  return core::write_changes(plan.files);
}

}  // namespace footfall::behaviors
