// The simulator's own state: what an ideal estimator would give.
#pragma once

#include "engine/estimators/estimator.h"
#include "model/robot/description.h"

namespace footfall::engine {

class TrueState final : public Estimator {
 public:
  explicit TrueState(const model::RobotDescription& robot) : joints_(robot.joint_count()) {}
  bool estimate(const hal::Sensors& sensors, model::State& state) noexcept override;

 private:
  int joints_;
};

}  // namespace footfall::engine
