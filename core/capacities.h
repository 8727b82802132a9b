// Capacities of the fixed-size arrays that modules exchange inside a tick.
#pragma once

namespace footfall::core {

inline constexpr int kMaxJoints = 64;    // actuated joints of a robot
inline constexpr int kMaxContacts = 32;  // declared contacts of a robot
inline constexpr int kMaxMarkers = 16;   // of motion capture, on a robot
inline constexpr int kMaxTasks = 32;     // tasks active at once
inline constexpr int kMaxAxes = 256;     // task rows active at once
inline constexpr int kMaxInternal = 32;  // named internal forces active at once
inline constexpr int kMaxPlanners = 8;   // planners of a behavior

}  // namespace footfall::core
