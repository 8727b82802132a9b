// The main part of a sweep file: what runs, in which worlds, with which seeds; see loader.h.
#include "lab/sweep/plan/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/value_reader.h"
#include "lab/run/summary.h"
#include "lab/suite/discovery.h"
#include "lab/sweep/plan/axes.h"
#include "lab/sweep/plan/keys.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;
using core::Diagnostics;
using core::YamlNode;

constexpr double kLongest = 1e6;  // s
constexpr std::int64_t kGreatestSweepSeed = 1'000'000'000;

struct SweepReader {
  SweepDescription& sweep;
  const SweepOptions& options;
  Diagnostics& diagnostics;
};

// Finds a file beside the one that names it, in the working folder, or in the library.
std::string find_file(const SweepReader& reader, const YamlNode& node, const std::string& name,
                      const char* library) {
  std::vector<std::string> candidates;
  if (node.mark.file >= 0) {
    const fs::path from(reader.diagnostics.file(node.mark.file));
    candidates.push_back((from.parent_path() / name).string());
  }
  candidates.push_back(name);
  for (const std::string& folder : reader.options.search) {
    for (const char* ending : {"", ".yaml"}) candidates.push_back(folder + library + name + ending);
  }
  const auto is_file = [](const std::string& path) {
    std::error_code error;
    return fs::is_regular_file(path, error);
  };
  const auto found = std::ranges::find_if(candidates, is_file);
  return found == candidates.end() ? std::string() : fs::path(*found).lexically_normal().string();
}

void read_target(SweepReader& reader, const YamlNode& root, const char* key, std::string& path) {
  const YamlNode* node = root.find(key);
  if (node == nullptr) return;
  const auto name = core::read_text(*node, reader.diagnostics, "the path of a file");
  if (!name) return;
  const bool behavior = std::string_view(key) == "behavior";
  path = find_file(reader, *node, *name, behavior ? "/behaviors/library/" : "/");
  if (!path.empty()) return;
  reader.diagnostics.error(
      node->mark, "cannot-read",
      fmt::format("unknown {} '{}': no such file here{}", key, *name,
                  behavior ? ", and no behaviors/library/" + *name + ".yaml in " +
                                 fmt::format("{}", fmt::join(reader.options.search, ", "))
                           : ""));
}

void read_what(SweepReader& reader, const YamlNode& root) {
  const YamlNode* behavior = root.find("behavior");
  const YamlNode* scenario = root.find("scenario");
  if (behavior == nullptr && scenario == nullptr) {
    if (core::has_nearly(root, "behavior") || core::has_nearly(root, "scenario")) return;
    reader.diagnostics.error(root.mark, "missing-key",
                             "one of the keys 'behavior', 'scenario' is missing");
  } else if (behavior != nullptr && scenario != nullptr) {
    reader.diagnostics.error(scenario->mark, "misplaced-key",
                             "'scenario' beside 'behavior': only one is allowed");
  }
  read_target(reader, root, "behavior", reader.sweep.behavior);
  read_target(reader, root, "scenario", reader.sweep.scenario);
  if (const YamlNode* node = root.find("robot")) {
    reader.sweep.robot =
        core::read_text(*node, reader.diagnostics, "the name of a robot").value_or("");
    if (scenario != nullptr) {
      reader.diagnostics.error(node->mark, "misplaced-key",
                               "'robot' beside 'scenario': the scenario names its own");
    }
  }
}

void read_worlds(SweepReader& reader, const YamlNode& root) {
  const YamlNode* node = root.find("worlds");
  if (node == nullptr) return;
  std::vector<const YamlNode*> items;
  for (const YamlNode& item : node->items) items.push_back(&item);
  if (!node->is_sequence()) items.push_back(node);
  if (items.empty()) {
    reader.diagnostics.error(node->mark, "empty-value", "no worlds: nothing would be run");
  }
  for (const YamlNode* item : items) {
    const auto name = core::read_text(*item, reader.diagnostics, "the name of a world");
    if (!name) continue;
    if (std::ranges::find(reader.sweep.worlds, *name) != reader.sweep.worlds.end()) {
      reader.diagnostics.error(item->mark, "duplicate", fmt::format("world '{}' twice", *name));
    }
    reader.sweep.worlds.push_back(*name);
    reader.sweep.world_marks.push_back(item->mark);
  }
}

// A duration as written, after checking it; `what` is its name in messages.
std::string time_text(SweepReader& reader, const YamlNode& node, bool positive) {
  const auto time =
      core::read_bounded(node, core::kTime, 0.0, kLongest, reader.diagnostics, "a time");
  if (time && positive && !(*time > 0.0)) {
    reader.diagnostics.error(node.mark, "out-of-range",
                             "expected a time above 0 s, got " + core::describe(node));
  }
  return time ? node.scalar : std::string();
}

// Nothing for one that is not known: it is like no other.
std::optional<SweepFault> read_fault(SweepReader& reader, const YamlNode& node) {
  SweepFault fault;
  const YamlNode* word = &node;
  if (node.is_map()) {
    core::check_keys(node, kSweepFaultKeys, reader.diagnostics);
    word = core::require_key(node, "fault", reader.diagnostics);
    if (word == nullptr) return std::nullopt;
  }
  const auto index = core::read_choice(*word, kSweepFaults, reader.diagnostics, "a fault");
  if (!index) return std::nullopt;
  if (*index == 0) return fault;
  fault.fault = fault.label = word->scalar;
  if (const YamlNode* at = node.find("at")) {
    fault.at = time_text(reader, *at, false);
    fault.label += "@" + fault.at;
  }
  if (const YamlNode* duration = node.find("for")) {
    fault.duration = time_text(reader, *duration, true);
    fault.label += " for " + fault.duration;
  }
  return fault;
}

void read_faults(SweepReader& reader, const YamlNode& root) {
  const YamlNode* node = root.find("faults");
  if (node == nullptr) return;
  if (!core::expect_sequence(*node, "a list of faults", reader.diagnostics)) return;
  reader.sweep.faults.clear();
  for (const YamlNode& item : node->items) {
    std::optional<SweepFault> fault = read_fault(reader, item);
    if (!fault) continue;
    const auto same = [&](const SweepFault& other) { return other.label == fault->label; };
    if (std::ranges::any_of(reader.sweep.faults, same)) {
      reader.diagnostics.error(item.mark, "duplicate", fmt::format("'{}' twice", fault->label));
    }
    reader.sweep.faults.push_back(std::move(*fault));
  }
  if (node->items.empty()) {
    reader.diagnostics.error(node->mark, "empty-value",
                             "no faults, not even `none`: nothing would be run");
  }
}

void read_sweep_seeds(SweepReader& reader, const YamlNode& root) {
  const YamlNode* node = root.find("seeds");
  if (node == nullptr) return;
  auto& seeds = reader.sweep.seeds;
  reader.sweep.seeds_mark = node->mark;
  if (node->is_scalar()) {
    const auto parsed = parse_seeds(node->scalar);
    const bool list = node->scalar.find(',') != std::string::npos;  // in a file: `[1, 2]`
    if (parsed && !list && parsed->back() <= static_cast<std::uint64_t>(kGreatestSweepSeed)) {
      seeds = *parsed;
    } else {
      core::report_expected(*node, "a seed, or a range such as 100..119", reader.diagnostics);
    }
    return;
  }
  if (!core::expect_sequence(*node, "a list of seeds", reader.diagnostics)) return;
  for (const YamlNode& item : node->items) {
    const auto seed = core::read_integer(item, 0, kGreatestSweepSeed, reader.diagnostics);
    if (!seed) continue;
    if (std::ranges::find(seeds, static_cast<std::uint64_t>(*seed)) != seeds.end()) {
      reader.diagnostics.error(item.mark, "duplicate", fmt::format("seed {} twice", *seed));
    }
    seeds.push_back(static_cast<std::uint64_t>(*seed));
  }
  if (node->items.empty()) {
    reader.diagnostics.error(node->mark, "empty-value", "no seeds: nothing would be run");
  }
}

void read_figures(SweepReader& reader, const YamlNode& root) {
  const YamlNode* node = root.find("figures");
  if (node == nullptr) return;
  if (!core::expect_sequence(*node, "a list of figures", reader.diagnostics)) return;
  const std::vector<std::string> known = figure_names();
  for (const YamlNode& item : node->items) {
    const auto name = core::read_text(item, reader.diagnostics, "the name of a figure");
    if (!name) continue;
    if (std::ranges::find(known, *name) == known.end() && !is_figure_of_a_part(*name)) {
      reader.diagnostics.error(item.mark, "unknown-name",
                               fmt::format("'{}' is no figure of a run (see `run --json`){}", *name,
                                           core::did_you_mean(*name, known)));
    }
    reader.sweep.figures.push_back(*name);
  }
}

void read_times(SweepReader& reader, const YamlNode& root) {
  if (const YamlNode* node = root.find("for")) {
    reader.sweep.duration = time_text(reader, *node, true);
    if (const auto q = core::parse_quantity(reader.sweep.duration)) {
      reader.sweep.duration_s = q->value;
    }
  }
  if (const YamlNode* node = root.find("timeout")) {
    if (const auto q = core::parse_quantity(time_text(reader, *node, true))) {
      reader.sweep.timeout = q->value;
    }
  }
}

}  // namespace

SweepDescription read_sweep(const YamlNode& root, const std::string& path,
                            const SweepOptions& options, Diagnostics& diagnostics) {
  SweepDescription sweep;
  sweep.path = path;
  sweep.name = fs::path(path).stem().string();
  core::check_keys(root, kSweepKeys, diagnostics);
  SweepReader reader{sweep, options, diagnostics};
  if (const YamlNode* node = root.find("name")) {
    sweep.name = core::read_name(*node, diagnostics, "the sweep's name").value_or("");
  }
  if (const YamlNode* node = root.find("doc")) sweep.doc = node->scalar;
  read_what(reader, root);
  read_worlds(reader, root);
  read_faults(reader, root);
  read_sweep_seeds(reader, root);
  read_times(reader, root);
  read_figures(reader, root);
  if (const YamlNode* node = root.find("vary")) read_sweep_vary(*node, sweep, diagnostics);
  if (const YamlNode* node = root.find("zip")) read_sweep_zip(*node, sweep, diagnostics);
  if (const YamlNode* node = root.find("sample")) read_sweep_sample(*node, sweep, diagnostics);
  SweepDescription counted = sweep;
  if (counted.seeds.empty()) counted.seeds = {1};
  if (run_count(counted) > kMostSweepRuns) {
    diagnostics.error(root.mark, "out-of-range",
                      fmt::format("more than {} runs: use `sample` instead of every combination",
                                  kMostSweepRuns));
  }
  return sweep;
}

SweepDescription load_sweep(const std::string& path, const SweepOptions& options,
                            Diagnostics& diagnostics) {
  const YamlNode root = core::load_yaml_with_base(path, diagnostics);
  if (!core::check_kind(root, "sweep", 1, diagnostics)) {
    SweepDescription none;
    none.path = path;
    return none;
  }
  return read_sweep(root, path, options, diagnostics);
}

}  // namespace footfall::lab
