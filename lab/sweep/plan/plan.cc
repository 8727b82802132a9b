// Numbers, names and digests of the runs of a sweep; see sweep.h.
#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::lab {

namespace {

std::size_t world_count(const SweepDescription& sweep) {
  return std::max<std::size_t>(sweep.worlds.size(), 1);
}

}  // namespace

std::size_t run_count(const SweepDescription& sweep) {
  // Saturates at the maximum instead of overflowing.
  std::size_t count = 1;
  const auto times = [&count](std::size_t factor) {
    count = factor != 0 && count > kMostSweepRuns / factor ? kMostSweepRuns + 1 : count * factor;
  };
  times(world_count(sweep));
  times(sweep.faults.size());
  for (const SweepGroup& group : sweep.groups) times(group.size);
  times(sweep.seeds.size());
  return count;
}

SweepRun run_of(const SweepDescription& sweep, std::size_t id) {
  SweepRun run;
  run.id = id;
  std::size_t rest = id;
  const auto take = [&rest](std::size_t size) {
    const std::size_t index = rest % size;
    rest /= size;
    return index;
  };
  run.seed = sweep.seeds[take(sweep.seeds.size())];
  run.values.resize(sweep.axes.size());
  for (auto group = sweep.groups.rbegin(); group != sweep.groups.rend(); ++group) {
    const std::size_t index = take(group->size);
    for (const std::size_t axis : group->axes) run.values[axis] = index;
  }
  run.fault = take(sweep.faults.size());
  run.world = take(world_count(sweep));
  return run;
}

std::string world_of(const SweepDescription& sweep, const SweepRun& run) {
  return sweep.worlds.empty() ? std::string() : sweep.worlds[run.world];
}

std::vector<std::pair<std::string, std::string>> settings_of(const SweepDescription& sweep,
                                                             const SweepRun& run) {
  std::vector<std::pair<std::string, std::string>> settings;
  for (std::size_t a = 0; a < sweep.axes.size(); ++a) {
    settings.emplace_back(sweep.axes[a].name, sweep.axes[a].values[run.values[a]].text);
  }
  return settings;
}

std::string key_of(const SweepDescription& sweep, const SweepRun& run) {
  nlohmann::json set = nlohmann::json::object();  // sorted by name: the order of axes is free
  for (const auto& [name, text] : settings_of(sweep, run)) set[name] = text;
  const nlohmann::json key = {{"world", world_of(sweep, run)},
                              {"fault", sweep.faults[run.fault].label},
                              {"for", sweep.duration},
                              {"robot", sweep.robot},
                              {"seed", run.seed},
                              {"set", std::move(set)}};
  return core::json_text(key);
}

std::string digest(const std::string& text) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (const char c : text) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  return fmt::format("{:016x}", hash);
}

std::string plan_digest(const SweepDescription& sweep) {
  nlohmann::json plan = {{"robot", sweep.robot},
                         {"worlds", sweep.worlds},
                         {"seeds", sweep.seeds},
                         {"for", sweep.duration},
                         {"faults", nlohmann::json::array()},
                         {"axes", nlohmann::json::array()},
                         {"groups", nlohmann::json::array()}};
  // Figures of merit and texts may change without changing the plan; so may paths, because the
  // contents of files are digested instead.
  plan["kind"] = sweep.scenario.empty() ? "behavior" : "scenario";
  for (const SweepFault& f : sweep.faults) {
    plan["faults"].push_back({f.label, f.fault, f.at, f.duration});
  }
  for (const SweepAxis& axis : sweep.axes) {
    nlohmann::json texts = nlohmann::json::array();
    for (const SweepValue& value : axis.values) texts.push_back(value.text);
    plan["axes"].push_back({axis.name, std::move(texts)});
  }
  for (const SweepGroup& group : sweep.groups) plan["groups"].push_back(group.axes);
  return digest(core::json_text(plan));
}

}  // namespace footfall::lab
