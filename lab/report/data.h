// Data that a report derives from a log: states, single-support phases, touchdowns, and curves
// thinned such that every peak is kept.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "lab/log/reader.h"

namespace footfall::lab {

using Point2 = std::array<double, 2>;

// An interval in which one atomic state was active.
struct StateInterval {
  double begin = 0.0, end = 0.0;  // s
  int name = 0;                   // index into StateBands::names
};
struct StateBands {
  std::vector<std::string> names;  // last parts of the paths: both mirror images share one
  std::vector<StateInterval> intervals;
};
// Paths of the states, indexed by the value of the signal `state`.
std::vector<std::string> state_paths(const Log& log);
// From the signal `state` and the run's `states`; empty if absent.
StateBands state_bands(const Log& log);
// Path of the active state in a row, "" if unknown.
std::string state_path(const Log& log, std::size_t row);

// A single-support phase: rows [begin, end).
struct SupportPhase {
  std::size_t begin = 0, end = 0;
  std::string foot;
};
std::vector<SupportPhase> single_support(const Log& log);

// Touchdown of a foot after a swing. Positions in m, world.
struct Touchdown {
  double time = 0.0;
  std::string foot;
  Point2 actual{};
  Point2 target{};       // last planned target
  bool planned = false;  // whether there was a target
};
// Of the swings that the run's figures count, see lab/figures/step_counter.h.
std::vector<Touchdown> touchdowns(const Log& log);

// Columns of a planner: predicted CoM position and velocity at the switch, and the foot's target.
// Null if the log has none.
struct PlannerColumns {
  std::string name;
  std::array<const std::vector<float>*, 2> target{}, position{}, velocity{};
  bool predicts() const { return position[0] && position[1] && velocity[0] && velocity[1]; }
};
std::vector<PlannerColumns> planners(const Log& log);

// Rows [begin, end) of a log on a common time axis of at most `points` points. Thinned if
// necessary: each bucket keeps its minimum and maximum in their order of time.
class Grid {
 public:
  Grid(const Log& log, std::size_t begin, std::size_t end, std::size_t points);
  const std::vector<double>& time() const { return time_; }
  std::vector<float> thin(const std::vector<float>& column, double scale) const;
  std::size_t begin() const { return begin_; }
  std::size_t end() const { return end_; }

 private:
  std::size_t begin_, end_, buckets_;  // buckets_ 0: no thinning
  std::vector<double> time_;
};

}  // namespace footfall::lab
