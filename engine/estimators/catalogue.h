// The estimators by type.
#pragma once

#include <memory>

#include "behaviors/compiled/estimator_spec.h"
#include "engine/estimators/estimator.h"
#include "model/control_model.h"
#include "model/robot/description.h"

namespace footfall::engine {

// A new estimator for this robot. `model` gives where its sensors are; not kept. Throws
// std::runtime_error with one clear sentence if the robot lacks a sensor that it needs.
std::unique_ptr<Estimator> make_estimator(const behaviors::EstimatorSpec& spec,
                                          const model::RobotDescription& robot,
                                          const model::ControlModel& model);

}  // namespace footfall::engine
