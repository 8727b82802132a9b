// What the log costs the tick: CPU time of the loop's own thread for handing a tick to the log,
// with waiting, over a stepping run. One JSON object.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <vector>

#include "lab/run/run_log.h"
#include "tests/support/rig.h"

namespace footfall {
namespace {

constexpr double kSimulated = 20.0;  // s

double thread_seconds() {
  timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

int run(const char* name) {
  tests::Rig rig(name);
  const std::string path =
      (std::filesystem::temp_directory_path() / "footfall_bench_log.mcap").string();
  engine::LogWriter writer(path, rig.behavior->signals, lab::make_log_header(*rig.behavior, {}));
  lab::RunLog log(*rig.loop, &writer);
  rig.loop->start();
  log.after_start();
  std::vector<double> costs, readings;
  while (rig.loop->time() < kSimulated && rig.loop->state() == engine::LoopState::running) {
    rig.loop->sense();
    rig.loop->compute();
    // What a reading of the clock costs here, between two ticks, is not what it costs in a loop of
    // its own: it is measured in place, and the median taken off.
    const double first = thread_seconds();
    const double before = thread_seconds();
    log.after_tick({});
    costs.push_back(thread_seconds() - before);
    readings.push_back(before - first);
    rig.loop->actuate();
  }
  writer.close();
  const double ticks = static_cast<double>(costs.size());
  std::ranges::nth_element(readings, readings.begin() + static_cast<long>(readings.size() / 2));
  const double reading = readings[readings.size() / 2];
  for (double& cost : costs) cost -= reading;
  double sum = 0.0;
  for (const double cost : costs) sum += cost;
  std::ranges::sort(costs);
  const nlohmann::ordered_json out = {
      {"ticks", costs.size()},
      {"mean_us", 1e6 * sum / ticks},
      {"median_us", 1e6 * costs[costs.size() / 2]},
      {"reading_us", 1e6 * reading},
      {"p99_us", 1e6 * costs[costs.size() * 99 / 100]},
      {"bytes_a_minute",
       static_cast<double>(std::filesystem::file_size(path)) * 60.0 / kSimulated}};
  std::filesystem::remove(path);
  std::printf("%s\n", out.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) { return footfall::run(argc > 1 ? argv[1] : "balance_best"); }
