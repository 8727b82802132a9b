// The simulator's own state: what an ideal estimator would give.
#pragma once

#include "engine/estimators/estimator.h"
#include "model/robot/description.h"

namespace footfall::engine {

class TrueState final : public Estimator {
 public:
  explicit TrueState(const model::RobotDescription& robot)
      : joints_(robot.joint_count()), contacts_(static_cast<int>(robot.contacts.size())) {}
  bool estimate(const EstimatorInput& input, Estimate& estimate) noexcept override;

 private:
  int joints_, contacts_;
};

}  // namespace footfall::engine
