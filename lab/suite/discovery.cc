// Finds and selects scenario files; see discovery.h.
#include "lab/suite/discovery.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "behaviors/load/options.h"
#include "core/text/whole_file.h"
#include "core/yaml/glob.h"
#include "core/yaml/value_reader.h"
#include "core/yaml/yaml.h"
#include "lab/scenario/loader.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

std::string window_text(const Expectation& expectation) {
  std::string text;
  if (expectation.to) {
    text += fmt::format(", between {:g} s and {:g} s", expectation.from, *expectation.to);
  } else if (expectation.from > 0.0) {
    text += fmt::format(", after {:g} s", expectation.from);
  }
  if (expectation.within) text += fmt::format(", within {:g} s", *expectation.within);
  if (expectation.part < 1.0) text += fmt::format(", in {:g} % of seeds", expectation.part * 100.0);
  return text;
}

std::string expectation_text(const ScenarioDescription& scenario, const Expectation& expectation) {
  std::string text = expectation.text;
  if (expectation.kind == Expectation::Kind::never) text = "never: " + text;
  if (expectation.kind == Expectation::Kind::sequence && scenario.behavior != nullptr) {
    text = "sequence ";
    for (const int state : expectation.states) {
      if (text.size() > 9) text += ", ";
      text += state >= 0 ? scenario.behavior->states[static_cast<std::size_t>(state)].path : "?";
    }
  }
  return text + window_text(expectation);
}

// Why a file of another kind is no test; empty for a scenario, and for a file without a kind, which
// the loader reports.
std::string other_kind(const std::string& path, const std::vector<std::string>& search) {
  const std::string key = first_key(path, behaviors::library_folders(search));
  for (const char* kind : {"behavior", "robot", "world", "sweep"}) {
    if (key != kind) continue;
    return fmt::format("{}:1:1: error: this is a {}, no scenario: `footfall {}` is for it\n", path,
                       kind,
                       key == "behavior" ? "run"
                       : key == "sweep"  ? "sweep"
                                         : "check");
  }
  return {};
}

SuiteScenario load_one(const std::string& path, const std::vector<std::string>& search) {
  SuiteScenario out;
  out.path = path;
  out.errors = other_kind(path, search);
  if (!out.errors.empty()) {
    out.name = fs::path(path).stem().string();
    return out;
  }
  core::Diagnostics diagnostics;
  ScenarioDescription scenario = load_scenario(path, {search}, diagnostics);
  out.name = scenario.name.empty() ? fs::path(path).stem().string() : scenario.name;
  out.labels = scenario.labels;
  out.seeds = scenario.seeds;
  out.duration = scenario.duration;
  if (diagnostics.has_errors()) {
    out.errors = diagnostics.to_string();
    return out;
  }
  for (const Expectation& expectation : scenario.expectations) {
    const core::Mark mark = expectation.mark;
    const std::string file = mark.file >= 0 ? diagnostics.file(mark.file) : path;
    out.expectations.push_back({expectation_text(scenario, expectation),
                                fmt::format("{}:{}:{}", file, mark.line, mark.column),
                                expectation.part});
  }
  const std::string behavior = fs::path(scenario.behavior_path).lexically_normal().string();
  out.map = std::make_shared<CoverageMap>(
      coverage_map(*scenario.behavior, behavior, scenario.behavior_files));
  out.scripted = !scenario.script.empty();
  if (scenario.golden) out.golden = scenario.golden->path;
  scenario.behavior.reset();  // large
  out.source = std::make_shared<const ScenarioDescription>(std::move(scenario));
  return out;
}

// Scenarios with the same name in different files are identified by their paths.
void make_names_unique(std::vector<SuiteScenario>& scenarios) {
  std::multiset<std::string> names;
  for (const SuiteScenario& scenario : scenarios) names.insert(scenario.name);
  for (SuiteScenario& scenario : scenarios) {
    if (names.count(scenario.name) == 1) continue;
    scenario.name = fs::path(scenario.path).lexically_normal().replace_extension().string();
    std::ranges::replace(scenario.name, '/', '.');
  }
}

bool is_selected(const SuiteScenario& scenario, const SuiteSelection& selection) {
  if (!selection.filter.empty() && !core::glob_matches(selection.filter, scenario.name) &&
      !core::glob_matches(selection.filter, scenario.path)) {
    return false;
  }
  const auto among = [](const std::vector<std::string>& list, const std::string& word) {
    return std::ranges::find(list, word) != list.end();
  };
  if (!selection.paths.empty() && !among(selection.paths, scenario.path)) return false;
  // The labels of a file with errors are unknown, so it is always selected.
  return selection.labels.empty() || !scenario.errors.empty() ||
         std::ranges::any_of(scenario.labels,
                             [&](const auto& l) { return among(selection.labels, l); });
}

}  // namespace

std::string first_key(const std::string& path, const std::vector<std::string>& bases) {
  // Check only whether a line begins with the word: parsing would double the load time of large
  // files.
  std::string problem;
  std::istringstream file(
      core::read_file(path, std::string::npos, problem).value_or(std::string()));
  for (std::string line; std::getline(file, line);) {
    const std::size_t colon = line.find(':');
    const std::string key = line.substr(0, colon);
    if (colon == std::string::npos || !core::is_name(key)) continue;
    if (key != "base") return key;
    break;
  }
  core::Diagnostics ignored;
  const core::YamlNode root = core::load_yaml_with_base(path, ignored, nullptr, bases);
  return root.is_map() && !root.entries.empty() ? root.entries.front().key : std::string();
}

std::vector<std::string> find_scenarios(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  const auto add = [&files](const std::string& path) {
    if (std::ranges::find(files, path) == files.end()) files.push_back(path);
  };
  for (const std::string& argument : arguments) {
    std::error_code error;
    if (fs::is_regular_file(argument, error)) {
      add(argument);
      continue;
    }
    if (!fs::is_directory(argument, error)) {
      throw std::runtime_error(argument + ": error: no such scenario file or folder");
    }
    std::vector<std::string> found;
    for (const auto& entry : fs::recursive_directory_iterator(
             argument, fs::directory_options::skip_permission_denied)) {
      if (entry.is_regular_file(error) && entry.path().extension() == ".yaml" &&
          first_key(entry.path().string()) == "scenario") {
        found.push_back(entry.path().lexically_normal().string());
      }
    }
    std::ranges::sort(found);
    std::ranges::for_each(found, add);
  }
  return files;
}

std::vector<SuiteScenario> load_suite(const std::vector<std::string>& files,
                                      const SuiteSelection& selection,
                                      const std::vector<std::string>& search) {
  std::vector<SuiteScenario> scenarios;
  for (const std::string& file : files) scenarios.push_back(load_one(file, search));
  make_names_unique(scenarios);
  std::erase_if(scenarios, [&](const SuiteScenario& s) { return !is_selected(s, selection); });
  if (!selection.seeds.empty()) {
    for (SuiteScenario& scenario : scenarios) scenario.seeds = selection.seeds;
  }
  return shard_of(std::move(scenarios), selection.shard, selection.shards);
}

std::vector<SuiteScenario> shard_of(std::vector<SuiteScenario> scenarios, int shard, int shards) {
  if (shards <= 1) return scenarios;
  // Longest first, each to the shard with the shortest total.
  std::vector<std::size_t> order(scenarios.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto cost = [&scenarios](std::size_t i) {
    return static_cast<double>(scenarios[i].seeds.size()) * (scenarios[i].duration + 1.0);
  };
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) { return cost(a) > cost(b); });
  std::vector<double> load(static_cast<std::size_t>(shards));
  std::vector<bool> mine(scenarios.size());
  for (const std::size_t i : order) {
    const auto least = std::ranges::min_element(load);
    mine[i] = least - load.begin() == shard - 1;
    *least += cost(i);
  }
  std::vector<SuiteScenario> part;
  for (std::size_t i = 0; i < scenarios.size(); ++i) {
    if (mine[i]) part.push_back(std::move(scenarios[i]));
  }
  return part;
}

namespace {

// Appends `A..B` or `A`; false if malformed, twice, or more than a session may have.
bool add_seeds(std::string_view text, std::vector<std::uint64_t>& seeds) {
  const std::size_t dots = text.find("..");
  const auto number = [](std::string_view part) -> std::optional<std::uint64_t> {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), value);
    const bool good = error == std::errc() && end == part.data() + part.size();
    return good ? std::optional(value) : std::nullopt;
  };
  const auto first = number(text.substr(0, dots));
  const auto last = dots == std::string_view::npos ? first : number(text.substr(dots + 2));
  const auto room = static_cast<std::uint64_t>(kMostSeeds) - seeds.size();
  if (!first || !last || *last < *first || *last - *first >= room) return false;
  const auto inside = [&](std::uint64_t seed) { return seed >= *first && seed <= *last; };
  if (std::ranges::any_of(seeds, inside)) return false;
  const std::size_t before = seeds.size();
  seeds.resize(before + *last - *first + 1);
  std::iota(seeds.begin() + static_cast<std::ptrdiff_t>(before), seeds.end(), *first);
  return true;
}

}  // namespace

std::optional<std::vector<std::uint64_t>> parse_seeds(const std::string& text) {
  std::vector<std::uint64_t> seeds;
  std::string_view rest = text;
  while (true) {
    const std::size_t comma = rest.find(',');
    std::string_view part = rest.substr(0, comma);
    part.remove_prefix(std::min(part.find_first_not_of(' '), part.size()));
    if (!add_seeds(part, seeds)) return std::nullopt;
    if (comma == std::string_view::npos) return seeds;
    rest.remove_prefix(comma + 1);
  }
}

}  // namespace footfall::lab
