// The loop that a series-elastic actuator's torque control closes around rotor and spring, output
// locked: the rotor moves exactly between two samples (hal/actuators/series_elastic.h), the motor
// torque is held. Pure functions. Load time only.
#pragma once

#include "hal/actuators/drive.h"
#include "hal/actuators/series_elastic.h"
#include "hal/actuators/torque_loop.h"

namespace footfall::behaviors {

// By what factor an error grows from one sample to the next, in the long run: the spectral radius
// of the map of spring torque, rotor rate and integrals. At most 1: it does not grow. `period`: s.
double torque_loop_growth(const hal::TorqueLoopGains& gains,
                          const hal::SeriesElasticParameters& actuator, double period,
                          const hal::RateFilters& filters = {});

}  // namespace footfall::behaviors
