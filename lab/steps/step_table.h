// One row per touchdown of a swing foot: what a run's steps were like, from samples of its ticks.
// Pure: knows neither logs nor robots, see log_steps.h.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/capacities.h"
#include "lab/figures/tick_sample.h"

namespace footfall::lab {

// One tick. SI, world frame unless said otherwise; NaN where something is not known.
struct StepSample {
  struct Foot {
    std::array<double, 3> force{};                      // N, ground on robot
    std::array<double, 3> position{}, velocity{};       // m, m/s, of the material point of contact
    std::array<double, 2> reference{kAbsent, kAbsent};  // m, of the tasks on it
    std::array<double, 2> measured{kAbsent, kAbsent};   // m, what these tasks measure
  };
  // Last answer of the first planner.
  struct Plan {
    std::array<double, 2> target{kAbsent, kAbsent};         // m
    std::array<double, 2> predicted_vel{kAbsent, kAbsent};  // m/s, of the CoM at touchdown
    double landing = kAbsent;    // s, time of touchdown as planned, extension included
    double extension = kAbsent;  // s, by the swing-time rule
    double yaw = 0.0;            // rad, heading by the estimate, which the plan was made in
  };
  double time = 0.0;  // s
  std::array<Foot, core::kMaxContacts> foot{};
  double yaw = 0.0, yaw_rate = 0.0;  // rad, rad/s about the vertical
  double tilt = 0.0;                 // rad, of roll and pitch together from their references
  std::array<double, 2> com_velocity{};
  bool saturated = false;  // a joint's torque is at its limit
  Plan plan{};
};

// A touchdown, and the step that it ends: from the touchdown before. What each column is, with its
// unit, is said once, in step_columns.cc. NaN: not known.
struct StepRow {
  int foot = -1;  // contact
  double number = 0.0, time = 0.0, step_time = kAbsent, flight_time = 0.0;
  double extension = kAbsent, early = kAbsent;
  double speed = 0.0, sink_speed = 0.0;
  double error = kAbsent, not_reached = kAbsent, tracking = kAbsent;
  double width = kAbsent;
  double lateral_speed = 0.0, lateral_predicted = kAbsent;
  double friction = kAbsent, slip_single = 0.0, slip_double = 0.0;
  double yaw = 0.0, yaw_rate = 0.0, yaw_rate_after = kAbsent;
  double tilt = 0.0, saturated = 0.0, clearance = 0.0;
};

// Fed with every tick, in order.
class StepTable {
 public:
  // feet: number of contacts; loaded: N, normal force from which on friction and slip count (near
  // zero force the ratio of two small numbers says nothing).
  StepTable(int feet, double loaded) : feet_(feet), loaded_(loaded) {}

  void observe(const StepSample& sample);
  const std::vector<StepRow>& rows() const noexcept { return rows_; }

 private:
  struct Swing {
    bool in_contact = true;
    double left_at = 0.0, lift_height = 0.0, rise = 0.0;
  };
  void begin(const StepSample& sample);
  void during(const StepSample& sample, double period);
  void land(int foot, const StepSample& sample);
  void plan_of(StepRow& row) const;
  double side(int foot) const noexcept;  // 1: to the left of the others at the start, -1: right

  int feet_;
  double loaded_;
  bool first_ = true;
  StepSample last_{};
  std::array<Swing, core::kMaxContacts> swing_{};
  std::array<double, core::kMaxContacts> side_{};
  double last_touchdown_ = kAbsent;
  StepRow running_{};        // what adds up over a step
  bool after_open_ = false;  // the last row waits for its yaw rate after the double support
  std::vector<StepRow> rows_;
};

}  // namespace footfall::lab
