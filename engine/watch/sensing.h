// From what a read brought to the state: the sensors' watch, then the estimator; the same in a run
// and in a replay of an estimator.
#pragma once

#include <memory>
#include <span>

#include "behaviors/compiled/behavior.h"
#include "engine/estimators/estimator.h"
#include "engine/watch/sensor_watch.h"

namespace footfall::engine {

struct Sensed {
  SensorFindings findings;
  bool estimated = false;  // else the estimate is the last one
};

class Sensing {
 public:
  // Throws std::runtime_error if the robot lacks what the estimator needs.
  Sensing(const behaviors::Behavior& behavior, const model::ControlModel& model);

  // An estimator that has seen nothing.
  void reset(const model::ControlModel& model);
  // Before the first tick: nothing is watched. `parameters`: all of the behavior; `support`:
  // contacts that the law relies on.
  bool start(const hal::Sensors& sensors, const model::ControlModel& model, std::uint64_t support,
             std::span<const double> parameters, Estimate& estimate) noexcept;
  // Once a tick. `fresh`: the read brought something.
  Sensed step(const hal::Sensors& sensors, bool fresh, const model::ControlModel& model,
              std::uint64_t support, std::span<const double> parameters,
              Estimate& estimate) noexcept;
  // After each tick.
  void commanded(const hal::Commands& commands) noexcept { watch_.commanded(commands); }
  // Goes on from another loop on the same robot, whose last estimate is `last`.
  void take_over(const Sensing& old, const Estimate& last) noexcept;

  const Estimator& estimator() const noexcept { return *estimator_; }

 private:
  const behaviors::Behavior& behavior_;
  std::unique_ptr<Estimator> estimator_;
  SensorWatch watch_;
};

}  // namespace footfall::engine
