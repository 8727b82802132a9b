// Notices in a tick that a task level has lost rank: it has less than the same control law has in
// the robot's nominal posture, at load. Rows of weight 0 are no part of their level: each that is
// missing may cost a rank, and none is lost by it. And that a level is worse conditioned than the
// robot's limit: then a small error of the model is a large one of the task.
#pragma once

#include <vector>

#include "behaviors/compiled/behavior.h"
#include "engine/tick/faults.h"
#include "model/control_model.h"
#include "tasks/active_set.h"
#include "tasks/whole_body_controller.h"

namespace footfall::engine {

class RankWatch {
 public:
  // Updates the model with the nominal posture.
  RankWatch(const behaviors::Behavior& behavior, model::ControlModel& model);

  // control: index into Behavior::controls of the law in force, whose primary part the result is.
  FaultFindings check(int control, const tasks::ControllerResult& result) const noexcept;

 private:
  // Of the level of each task.
  struct Expected {
    int rows = 0;
    int rank = 0;
  };
  using Law = std::vector<Expected>;
  struct Expectation {
    std::vector<int> instances;  // by task
    Law at_load;                 // weights of the first tick
    Law all;                     // every row in force
  };
  static Law read(int tasks, const tasks::ControllerResult& result);

  double condition_limit_;
  std::vector<Expectation> expected_;  // by control
};

}  // namespace footfall::engine
