// A whole run with its log against a bare mj_step loop over the same physics steps, same process.
// The rounds alternate; the lowest of each counts. Prints {"ratio", "real_time_factor", ...}.
// bench_run_cost [BEHAVIOR [WORLD]]: a world of sim/worlds, in which the bare loop is as in `flat`.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "engine/log/writer.h"
#include "lab/run/run.h"
#include "lab/run/run_log.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/rig.h"

namespace footfall {
namespace {

using Clock = std::chrono::steady_clock;
constexpr double kSimulated = 10.0;  // s
constexpr int kRounds = 7;

double seconds(Clock::time_point from) {
  return std::chrono::duration<double>(Clock::now() - from).count();
}

// The torques of a run, so that the bare loop steps through the same physics.
std::vector<std::array<double, 6>> record(const char* name) {
  tests::Rig rig(name);
  std::vector<std::array<double, 6>> torques;
  rig.loop->start();
  while (rig.loop->time() < kSimulated && rig.loop->state() == engine::LoopState::running) {
    rig.loop->tick();
    std::array<double, 6> tau{};
    std::copy_n(rig.loop->commands().tau.begin(), 6, tau.begin());
    torques.push_back(tau);
  }
  return torques;
}

double bare_loop(const char* name, const std::vector<std::array<double, 6>>& torques) {
  tests::Rig rig(name);
  rig.backend->start();
  const Clock::time_point start = Clock::now();
  for (const auto& tau : torques) {
    for (int s = 0; s < rig.world.physics.steps_per_tick; ++s) {
      std::copy(tau.begin(), tau.end(), rig.backend->data()->ctrl);
      mj_step(rig.backend->model(), rig.backend->data());
    }
  }
  return seconds(start);
}

double whole_run(const char* name, const sim::WorldDescription& world,
                 const std::string& log_path) {
  tests::Rig rig(name, world);
  engine::LogWriter log(log_path, rig.behavior->signals, lab::make_log_header(*rig.behavior, {}));
  lab::RunSpec spec;
  spec.max_time = kSimulated;
  spec.log = &log;
  const Clock::time_point start = Clock::now();
  lab::run(*rig.loop, spec);
  log.close();
  return seconds(start);
}

// Heap calls in a second of ticks, after one.
long allocations_in(const char* name, const sim::WorldDescription& world) {
  tests::Rig rig(name, world);
  rig.loop->start();
  while (rig.loop->time() < 1.0) rig.loop->tick();
  const tests::AllocationGuard guard;
  while (rig.loop->time() < 2.0) rig.loop->tick();
  return guard.allocations();
}

sim::WorldDescription world_of(const std::string& name) {
  core::Diagnostics problems;
  return sim::load_world(std::string(FOOTFALL_SOURCE_DIR) + "/sim/worlds/" + name + ".yaml",
                         problems);
}

int run(const char* name, const std::string& world_name) {
  const sim::WorldDescription world = world_of(world_name);
  const auto torques = record(name);
  const std::string log =
      (std::filesystem::temp_directory_path() / "footfall_bench_run_cost.mcap").string();
  double bare = 1e9, whole = 1e9;
  for (int round = 0; round < kRounds; ++round) {
    bare = std::min(bare, bare_loop(name, torques));
    whole = std::min(whole, whole_run(name, world, log));
  }
  std::filesystem::remove(log);
  const nlohmann::ordered_json out = {{"ratio", whole / bare},
                                      {"real_time_factor", kSimulated / whole},
                                      {"bare_s", bare},
                                      {"run_s", whole},
                                      {"allocations", allocations_in(name, world)},
                                      {"ticks", torques.size()}};
  std::printf("%s\n", out.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) {
  return footfall::run(argc > 1 ? argv[1] : "balance", argc > 2 ? argv[2] : "flat");
}
