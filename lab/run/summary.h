// A run's summary: one JSON object for scripts, a short text for people, and the file of what only
// a wall clock knows.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "lab/run/run.h"

namespace footfall::lab {

// A `torque_loop:` table of the behavior that the backend has no use for.
struct UnusedTorqueLoop {
  std::string name;
  int joints = 0;  // that some state gives it to
};
std::vector<UnusedTorqueLoop> unused_torque_loops(const behaviors::Behavior& behavior,
                                                  const hal::Hardware& hardware);

// Of summary.json and `--json`: the key `format`. 2 counts runs under 4 s from the beginning, and
// has fault_ticks, and `finished` as an end.
inline constexpr int kSummaryFormat = 2;

struct RunIdentity {
  std::string behavior, robot, world, backend;
  std::uint64_t seed = 0;
  std::string log;      // path, empty: none
  std::string physics;  // one line: what is behind the figures
  std::vector<UnusedTorqueLoop> unused_torque_loops{};
  // What the seed drew, by name with its unit.
  std::vector<std::pair<std::string, std::vector<double>>> variation{};
  // External aids: names of the world's constraints, and `hold of BODY` of a scenario.
  std::vector<std::string> constraints{};
  std::string estimator = "true_state";  // by the name of its type
  // Whether the errors of the world's sensors reach the state: `none`, `used`, or `unused` by an
  // estimator that reads no sensors.
  std::string sensor_errors = "none";
  // Where the world has errors of the ground's height: how often a foot got another one.
  std::optional<std::int64_t> footholds{};
};
// {NAME: number or list}
nlohmann::ordered_json variation_json(const RunIdentity& id);

// What summary_json says of the figures, and a page of a part of a run.
nlohmann::ordered_json figures_json(const RunFigures& figures);

// Names of the numbers of a summary, `error.pitch.max`; true for `faults.NAME`,
// `internal_force.NAME.rms` and the like, too, whose NAME is the behavior's.
std::vector<std::string> figure_names();
bool is_figure_of_a_part(std::string_view name);

// `physics_only` leaves out what a wall clock measured (tick_us, real_time_factor).
nlohmann::ordered_json summary_json(const RunIdentity& id, const RunResult& result,
                                    bool physics_only = false);
std::string summary_text(const RunIdentity& id, const RunResult& result);
// tick_us, wall time and the histogram of tick times.
nlohmann::ordered_json timing_json(const RunResult& result);

}  // namespace footfall::lab
