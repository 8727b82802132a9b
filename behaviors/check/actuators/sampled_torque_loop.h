// The loop that a series-elastic actuator's torque control closes around rotor and spring, output
// locked: the rotor moves exactly between two samples (hal/actuators/series_elastic.h), the motor
// torque is held. Pure functions. Load time only.
#pragma once

#include <Eigen/Core>

#include "hal/actuators/drive.h"
#include "hal/actuators/series_elastic.h"
#include "hal/actuators/torque_loop.h"

namespace footfall::behaviors {

// x' = A x + B reference, from one sample to the next; the first state is the spring's torque, N m.
struct TorqueLoopMap {
  static constexpr int kStates = 8;
  Eigen::Matrix<double, kStates, kStates> A = decltype(A)::Zero();
  Eigen::Matrix<double, kStates, 1> B = decltype(B)::Zero();
};
// What is no part of the loop, as an integral without gain, has a column of zeros. `period`: s.
TorqueLoopMap torque_loop_map(const hal::TorqueLoopGains& gains,
                              const hal::SeriesElasticParameters& actuator, double period,
                              const hal::RateFilters& filters = {});

// By what factor an error grows from one sample to the next, in the long run: the spectral radius
// of the map of spring torque, rotor rate and integrals. At most 1: it does not grow. `period`: s.
double torque_loop_growth(const hal::TorqueLoopGains& gains,
                          const hal::SeriesElasticParameters& actuator, double period,
                          const hal::RateFilters& filters = {});

}  // namespace footfall::behaviors
