// Watch and estimator; see sensing.h.
#include "engine/watch/sensing.h"

#include "core/index.h"
#include "engine/estimators/catalogue.h"

namespace footfall::engine {
namespace {

std::span<const double> own(std::span<const double> parameters,
                            const behaviors::EstimatorSpec& spec) noexcept {
  return parameters.subspan(at(spec.first_slot), at(spec.slots));
}

}  // namespace

Sensing::Sensing(const behaviors::Behavior& behavior, const model::ControlModel& model)
    : behavior_(behavior),
      estimator_(make_estimator(behavior.estimator, behavior.robot, model)),
      watch_(behavior.estimator, behavior.robot) {}

void Sensing::reset(const model::ControlModel& model) {
  estimator_ = make_estimator(behavior_.estimator, behavior_.robot, model);
}

bool Sensing::start(const hal::Sensors& sensors, const model::ControlModel& model,
                    std::uint64_t support, std::span<const double> parameters,
                    Estimate& estimate) noexcept {
  return estimator_->estimate({sensors, model, support, own(parameters, behavior_.estimator)},
                              estimate);
}

Sensed Sensing::step(const hal::Sensors& sensors, bool fresh, const model::ControlModel& model,
                     std::uint64_t support, std::span<const double> parameters,
                     Estimate& estimate) noexcept {
  Sensed sensed;
  sensed.findings = watch_.check(sensors, fresh);
  sensed.estimated = estimator_->estimate(
      {watch_.usable(), model, support, own(parameters, behavior_.estimator), watch_.joints_new()},
      estimate);
  watch_.used(estimate.quality.markers);
  return sensed;
}

void Sensing::take_over(const Sensing& old, const Estimate& last) noexcept {
  estimator_->take_over(*old.estimator_, last);
  watch_.take_over(old.watch_);
}

}  // namespace footfall::engine
