// The estimators by name.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/estimators/estimator.h"
#include "model/robot/description.h"

namespace footfall::engine {

inline constexpr std::string_view kDefaultEstimator = "true_state";

// A new estimator for this robot. Throws std::runtime_error with one clear sentence if none has
// the name.
std::unique_ptr<Estimator> make_estimator(std::string_view name,
                                          const model::RobotDescription& robot);
std::vector<std::string> estimator_names();

}  // namespace footfall::engine
