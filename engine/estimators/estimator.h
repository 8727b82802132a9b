// From sensors to the state that the control model is updated with. Estimators are listed in
// catalogue.h; docs/adding_an_estimator.md says how to add one.
#pragma once

#include "hal/hardware.h"
#include "model/state.h"

namespace footfall::engine {

class Estimator {
 public:
  virtual ~Estimator() = default;
  // Once per tick; allocates nothing. False: the sensors cannot give a state (no truth, stale
  // data); `state` is then unchanged.
  virtual bool estimate(const hal::Sensors& sensors, model::State& state) noexcept = 0;
};

}  // namespace footfall::engine
