// The figures of one run, gathered tick by tick from the control loop; no clock, no physics.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "engine/tick/control_loop.h"
#include "lab/run/step_counter.h"

namespace footfall::lab {

// rms and largest magnitude of a signal.
struct ErrorFigure {
  double sum_of_squares = 0.0;
  double max = 0.0;
  std::int64_t count = 0;
  void add(double value) noexcept;
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
  struct Internal {
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
  explicit RunMetrics(const engine::ControlLoop& loop);

  // From now on another loop, which has taken over from the one before.
  void go_on(const engine::ControlLoop& loop) noexcept { loop_ = &loop; }
  // After each tick's compute(); goal: where it was told to be, m, world. Returns the step counted
  // in this tick.
  StepEvent observe(const std::array<double, 2>& goal) noexcept;

  RunFigures figures(bool fell) const;
  const StepCounter& counter() const noexcept { return counter_; }
  // Duration of the last whole step, s; 0 before there are two.
  double last_step_duration() const noexcept { return last_step_duration_; }

 private:
  void observe_errors() noexcept;
  void add_errors(RunFigures& sums) noexcept;
  void observe_placement() noexcept;
  void observe_step(const StepEvent& event, const std::array<double, 2>& goal) noexcept;

  const engine::ControlLoop* loop_;
  StepCounter counter_;
  RunFigures sums_;   // errors from kSettledAfter on
  RunFigures whole_;  // errors from the beginning; nothing else
  struct StepSample {
    double time;
    std::array<double, 2> com;
    double goal_distance;
  };
  std::vector<StepSample> recent_;  // ring of the last 51 steps
  std::size_t recent_head_ = 0;
  double last_step_time_ = 0.0, last_step_duration_ = 0.0, first_step_time_ = 0.0;
  std::array<double, 2> last_com_{};
  std::array<double, 3> orientation_ref_{};  // last references of roll, pitch, yaw
  double height_ref_ = 0.0;
  bool have_height_ref_ = false;
  bool first_ = true;
};

}  // namespace footfall::lab
