// Notices in a tick that a task level has lost rank: it has less than the same control law has in
// the robot's nominal posture, at load.
#pragma once

#include <vector>

#include "behaviors/compiled/behavior.h"
#include "engine/tick/faults.h"
#include "model/control_model.h"
#include "tasks/whole_body_controller.h"

namespace footfall::engine {

class RankWatch {
 public:
  // Updates the model with the nominal posture.
  RankWatch(const behaviors::Behavior& behavior, model::ControlModel& model);

  // control: index into Behavior::controls of the law in force, whose primary part the result is.
  FaultFindings check(int control, const tasks::ControllerResult& result) const noexcept;

 private:
  std::vector<std::vector<int>> expected_;  // by control and task: rank of the task's level
};

}  // namespace footfall::engine
