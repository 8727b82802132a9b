// The figures of one run, gathered tick by tick; no clock, no physics.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lab/figures/step_counter.h"
#include "lab/figures/tick_sample.h"

namespace footfall::lab {

// rms and largest magnitude of a signal.
struct ErrorFigure {
  double sum_of_squares = 0.0;
  double max = 0.0;
  std::int64_t count = 0;
  // ticks: how many had this value.
  void add(double value, std::int64_t ticks = 1) noexcept;
  double rms() const noexcept;
};

// What a run amounts to; SI.
struct RunFigures {
  std::int64_t steps = 0;
  double time = 0.0;
  double counted_from = 0.0;  // s: errors, placements and torques count from here on
  bool fell = false;
  ErrorFigure roll, pitch, yaw, height;
  double placement_mean = 0.0, placement_max = 0.0;
  std::int64_t placements = 0;
  double max_torque_step = 0.0;  // while the run goes on
  double end_torque_step = 0.0;  // in the tick that ended it: control was let go, or went to `safe`
  double peak_torque = 0.0;
  double goal_error = 0.0;                        // mean over the last 10 steps
  double path_length = 0.0;                       // of the CoM, horizontal
  double max_distance = 0.0;                      // CoM to goal, largest
  std::array<double, 2> start{}, end{};           // of the CoM, m, world
  std::array<double, 2> mean_velocity_last_50{};  // m/s, world
  double worst_clearance = 0.0;                   // m, smallest rise of a swing foot
  double mean_step_time = 0.0;                    // s
  struct Internal {                               // N, in the behavior's convention
    ErrorFigure error;
    double reference = 0.0;
  };
  std::map<std::string, Internal> internal;
};

// Error figures and torques count from here on, when the start has died away; in runs shorter than
// kShortRun from the beginning, because nothing much would be left.
inline constexpr double kSettledAfter = 2.0;  // s
inline constexpr double kShortRun = 4.0;      // s

class RunMetrics {
 public:
  // period: of the tick, s. counted_from: everything counts from here on; none: as of a run that
  // starts, see kSettledAfter.
  RunMetrics(const SampleNames& names, double period, std::optional<double> counted_from = {});
  RunMetrics(const RunMetrics&) = delete;
  RunMetrics& operator=(const RunMetrics&) = delete;

  // From now on ticks of another behavior of the same robot, which has taken over.
  void go_on(const SampleNames& names);
  // One tick after the other. Returns the step counted in this tick.
  StepEvent observe(const TickSample& tick) noexcept;

  // time: the run's length, s.
  RunFigures figures(double time, bool fell) const;
  const StepCounter& counter() const noexcept { return counter_; }
  // Duration of the last whole step, s; 0 before there are two.
  double last_step_duration() const noexcept { return last_step_duration_; }

 private:
  void observe_errors(const TickSample& tick) noexcept;
  void observe_placement(const TickSample& tick) noexcept;
  void observe_step(const TickSample& tick) noexcept;

  // Figures of which errors, placements and torques count from a time on.
  struct Sums {
    RunFigures figures;
    std::vector<RunFigures::Internal*> internal;  // by TickSample::internal
    void add_errors(const TickSample& tick, const std::array<double, 3>& rpy_reference,
                    double height_reference) noexcept;
    void add_placement(double error) noexcept;
  };

  std::size_t contacts_;
  StepCounter counter_;
  Sums settled_;  // from kSettledAfter on
  Sums whole_;    // from the beginning; nothing but errors, placements and torques
  struct StepSample {
    double time;
    std::array<double, 2> com;
    double goal_distance;
  };
  std::vector<StepSample> recent_;  // ring of the last 51 steps
  std::size_t recent_head_ = 0;
  double last_step_time_ = 0.0, last_step_duration_ = 0.0;
  std::array<double, 2> last_com_{};
  std::array<double, 3> rpy_reference_{};  // the last ones that were in force
  double height_reference_ = kAbsent;
  bool first_ = true;
};

}  // namespace footfall::lab
