// One controlled axis of a task: its command, and its values after evaluation.
#pragma once

#include <cstdint>

namespace footfall::tasks {

// What a task's quantity is measured against. Directions are the world's except for `heading`.
enum class Frame : std::uint8_t {
  usual,  // the first frame of the task's type
  world,
  stance,   // positions: from the mean of the contact points in force
  heading,  // orientations, momentum: z up, x where the torso (or the frame itself) points
};

// One controlled axis of a task in this tick.
struct AxisCommand {
  int axis = 0;          // index into the axes of the task's type, or the joint's index
  double kp = 0.0;       // 1/s^2
  double ki = 0.0;       // 1/s^3
  double kd = 0.0;       // 1/s
  double ref = 0.0;      // position reference, in the unit of the axis
  double ref_vel = 0.0;  // feed-forward velocity
  double ref_acc = 0.0;  // feed-forward acceleration
  double weight = 1.0;   // inside a level, matters only where the level is over-determined
  double acceleration_limit = 0.0;  // m/s^2 or rad/s^2 on what is commanded; 0: none
  double integral_limit = 0.0;      // clamp of |integral of error|; 0: none
  double slope = 0.0;  // positions: the axis is p - slope x, so that a height follows a surface
  bool fresh = false;  // in force since this tick: its integral starts at 0
};

// One axis of one task after evaluation. Units: that of the axis (m, rad, kg m^2/s), and its
// derivatives.
struct AxisEvaluation {
  double measured = 0.0;
  double velocity = 0.0;
  double error = 0.0;      // reference minus measured (log map for orientations)
  double commanded = 0.0;  // u; with a slope that of p - slope x
};

}  // namespace footfall::tasks
