// What a planner sees besides the plain measurements: the CoM velocity, filtered, and the goal,
// approached at a speed that the robot can follow. make_input() is the only place that assembles a
// plan's input: planners' answers and the closed form that replaces a late one follow one law.
#pragma once

#include <array>

#include "behaviors/planners/foot_planner.h"

namespace footfall::behaviors {

// The pendulum of one tick: m and m/s, world.
struct PendulumMeasurement {
  std::array<double, 3> com{};
  std::array<double, 3> com_vel{};
  std::array<double, 3> support{};  // mean of the stance contacts
  bool supported = false;           // false: no stance contact
};

// Of one planner; updated in every tick, asked or not.
struct PlannerObservation {
  std::array<double, 2> velocity{};  // m/s, world, of the CoM
  std::array<double, 2> goal{};      // m, world, as approached
  bool primed = false;               // false: no tick observed yet
};

// One tick of `period` seconds; wanted: the goal, m, world. The velocity is LIPM-predictive,
//   v̂' = (g/h)(x - p) + (v - v̂)/τ:
// the pendulum predicts and the measured velocity corrects slowly, so that noise is averaged over τ
// without the lag of a plain low-pass. A goal that jumps is approached from the former goal, the
// first one from the CoM.
void observe(PlannerObservation& seen, const FootPlannerSpec& spec,
             const PendulumMeasurement& measured, const std::array<double, 2>& wanted,
             double period) noexcept;

// com, stance: m, world; yaw: rad; swing_side: +1 left, -1 right; switch_in: s.
FootPlannerInput make_input(const PlannerObservation& seen, const std::array<double, 3>& com,
                            const std::array<double, 3>& stance, double yaw, double swing_side,
                            double switch_in) noexcept;

}  // namespace footfall::behaviors
