// The control laws of [Kim16] Table I for Hume as the machine would hand them to the controller.
#pragma once

#include <vector>

#include "tasks/active_set.h"
#include "tests/support/hume_problem.h"

namespace footfall::tests {

class SetBuilder {
 public:
  explicit SetBuilder(tasks::ControlSet& set) : set_(set) { set_ = {}; }
  void contact(int c) { set_.contacts[static_cast<std::size_t>(set_.contact_count++)] = c; }
  void task(int instance, tasks::TaskType type, int point, int priority,
            const std::vector<tasks::AxisCommand>& axes) {
    tasks::TaskCommand& t = set_.tasks[static_cast<std::size_t>(set_.task_count++)];
    t.instance = instance;
    t.type = type;
    t.point = point;
    t.priority = priority;
    t.first_axis = set_.axis_count;
    t.axis_count = static_cast<int>(axes.size());
    for (const tasks::AxisCommand& a : axes)
      set_.axes[static_cast<std::size_t>(set_.axis_count++)] = a;
  }
  void tension(double wanted) {
    set_.internals[static_cast<std::size_t>(set_.internal_count++)] = {
        .contacts = {kRightFoot, kLeftFoot}, .reference = wanted};
  }

 private:
  tasks::ControlSet& set_;
};

// Both feet: CoM height, then yaw, pitch, roll in one level; joint damping below.
inline void fill_dual_set(tasks::ControlSet& set) {
  using tasks::TaskType;
  SetBuilder b(set);
  b.contact(kRightFoot);
  b.contact(kLeftFoot);
  b.task(0, TaskType::com_position, -1, 1, {{2, 270, 20, 10, 0.91, 0, 0}});
  b.task(1, TaskType::body_orientation, -1, 1,
         {{2, 100, 0, 0, 0, 0, 0}, {1, 200, 20, 15, 0, 0, 0}, {0, 210, 35, 10, 0, 0, 0}});
  std::vector<tasks::AxisCommand> joints;
  for (int j = 0; j < 6; ++j) joints.push_back({j, 0, 0, 2, 0, 0, 0});
  b.task(2, TaskType::joint_damping, -1, 2, joints);
}

// Right foot: CoM height, pitch, roll and the left foot, one level. `foot`: where it should be.
inline void fill_single_set(tasks::ControlSet& set, const std::array<double, 3>& foot) {
  using tasks::TaskType;
  SetBuilder b(set);
  b.contact(kRightFoot);
  b.task(0, TaskType::com_position, -1, 1, {{2, 270, 20, 10, 0.91, 0, 0}});
  b.task(1, TaskType::body_orientation, -1, 1,
         {{1, 200, 20, 15, 0, 0, 0}, {0, 210, 35, 10, 0, 0, 0}});
  b.task(3, TaskType::point_position, kLeftFoot, 1,
         {{0, 220, 35, 35, foot[0], 0, 0},
          {1, 237, 40, 40, foot[1], 0, 0},
          {2, 400, 35, 60, foot[2], 0, 0}});
}

}  // namespace footfall::tests
