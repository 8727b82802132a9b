// The estimators of `estimator: {type: ...}` as data: what each needs and its parameters. One table
// for the loader, the schema, the reference and the estimators themselves.
#pragma once

#include <span>
#include <string_view>

#include "behaviors/compiled/estimator_spec.h"
#include "core/units/units.h"

namespace footfall::behaviors {

// A parameter, live between its bounds unless the estimator takes it only when it starts.
struct EstimatorParameter {
  std::string_view name;
  core::Dimension dimension;
  double value = 0.0, least = 0.0, most = 0.0;  // SI
  std::string_view doc;
  bool at_start = false;
};

struct EstimatorInfo {
  std::string_view name;
  std::string_view doc;
  bool needs_imu = false, needs_mocap = false, needs_contacts = false;
  std::span<const EstimatorParameter> parameters;

  const EstimatorParameter* find(std::string_view parameter) const;  // nullptr: not its own
};

// In the order of EstimatorType.
std::span<const EstimatorInfo> estimator_types();
inline const EstimatorInfo& estimator_info(EstimatorType type) {
  return estimator_types()[static_cast<std::size_t>(type)];
}

}  // namespace footfall::behaviors
