// From sensors to the state that the control model is updated with.
#pragma once

#include <cstdint>

#include "hal/hardware.h"
#include "model/state.h"

namespace footfall::engine {

class Estimator {
 public:
  virtual ~Estimator() = default;
  // False: the sensors cannot give a state (no truth, stale data); `state` is then unchanged.
  virtual bool estimate(const hal::Sensors& sensors, model::State& state) noexcept = 0;
};

// The simulator's own state: what an ideal estimator would give.
class TrueStateEstimator final : public Estimator {
 public:
  explicit TrueStateEstimator(int joints) : joints_(joints) {}
  bool estimate(const hal::Sensors& sensors, model::State& state) noexcept override;

 private:
  int joints_;
};

}  // namespace footfall::engine
