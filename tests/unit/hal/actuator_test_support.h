// What the tests of actuators share: Hume's knee and the step of its loops.
#pragma once

#include "hal/actuators/series_elastic.h"
#include "hal/actuators/torque_loop.h"

namespace footfall::tests {

inline constexpr double kLoopStep = 1.0 / 12000.0;  // s
inline constexpr hal::SeriesElasticParameters kKnee{
    .spring = 415.0, .rotor = 0.0872756, .viscous = 0.5};

// Stable loops on that knee, one of each type.
inline constexpr hal::TorqueLoopGains kCascade{.type = hal::TorqueLoopGains::Type::cascade,
                                               .p = 0.8,
                                               .i = 2.0,
                                               .velocity_p = 25.0,
                                               .velocity_i = 50.0};
inline constexpr hal::TorqueLoopGains kDirect{.type = hal::TorqueLoopGains::Type::direct,
                                              .p = 20.0,
                                              .i = 10.0,
                                              .forward = 1.0,
                                              .damping = 25.0};

// A motor that gives what its loop asks for.
inline double one_step(hal::TorqueLoop& loop, const hal::TorqueLoopInput& input) {
  const double asked = loop.ask(input);
  loop.settle(input, asked, asked);
  return asked;
}

}  // namespace footfall::tests
