// A scenario against the plain run that it watches, same process, rounds interleaved; both log.
// Prints {"ratio", ...}: the median over the rounds of their wall times' ratio.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "hal/sensors/faults.h"
#include "lab/judge/scenario_run.h"
#include "lab/run/run_log.h"
#include "lab/scenario/loader.h"
#include "tests/support/rig.h"

namespace footfall {
namespace {

using Clock = std::chrono::steady_clock;

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

lab::ScenarioDescription load(const std::string& path) {
  core::Diagnostics diagnostics;
  auto scenario = lab::load_scenario(path, {{FOOTFALL_SOURCE_DIR}}, diagnostics);
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
  return scenario;
}

// Wall time of one run of the scenario's behavior, watched or not.
double timed(const lab::ScenarioDescription& scenario, const std::string& log_path, bool watched) {
  const sim::WorldDescription world;
  const behaviors::Behavior& behavior = *scenario.behavior;
  sim::MujocoBackend backend(behavior.robot, world);
  hal::SensorFaults sensors(backend);
  hal::Hardware& plain = backend;
  engine::LoopSettings settings;
  settings.planner_latency = world.planner_latency;
  engine::ControlLoop loop(behavior, watched ? sensors : plain, settings);
  engine::LogWriter log(log_path, behavior.signals, lab::make_log_header(behavior, {}));
  lab::RunSpec spec;
  spec.max_time = scenario.duration;
  spec.log = &log;
  lab::ScenarioHooks hooks;
  hooks.push = [&](const std::string& body, const lab::ScriptedPush& push) {
    return backend.push(backend.find_body(body), push.force, push.direction, push.duration);
  };
  const Clock::time_point start = Clock::now();
  if (watched) {
    lab::run_scenario(scenario, scenario.seeds.front(), loop, hooks, spec);
  } else {
    lab::run(loop, spec);
  }
  log.close();
  if (loop.time() < scenario.duration - 1e-6) throw std::runtime_error("a run ended early");
  return std::chrono::duration<double>(Clock::now() - start).count();
}

int run(const std::string& path, int rounds) {
  const lab::ScenarioDescription scenario = load(path);
  const std::string log =
      (std::filesystem::temp_directory_path() / "footfall_bench_scenario_cost.mcap").string();
  std::vector<double> plain, watched, ratios;
  for (int round = 0; round < rounds; ++round) {
    plain.push_back(timed(scenario, log, false));
    watched.push_back(timed(scenario, log, true));
    ratios.push_back(watched.back() / plain.back());
  }
  std::filesystem::remove(log);
  const nlohmann::ordered_json out = {{"ratio", median(ratios)},
                                      {"ratio_worst_round", *std::ranges::max_element(ratios)},
                                      {"plain_s", median(plain)},
                                      {"scenario_s", median(watched)},
                                      {"rounds", rounds}};
  std::printf("%s\n", out.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) {
  return footfall::run(argc > 1 ? argv[1] : FOOTFALL_SOURCE_DIR "/tests/bench/scenario_cost.yaml",
                       argc > 2 ? std::atoi(argv[2]) : 9);
}
