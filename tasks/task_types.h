// The catalogue of task types: an enumerator and a row each. Everybody who needs to know something
// about a type (loader, language tables, reference, checks, log, control law) asks here.
// A new type is a pair of files in tasks/types/ and its lines below: docs/adding_a_task.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tasks/rows/task_type.h"
#include "tasks/types/body_orientation.h"
#include "tasks/types/centroidal_angular_momentum.h"
#include "tasks/types/com_position.h"
#include "tasks/types/frame_orientation.h"
#include "tasks/types/frame_pose.h"
#include "tasks/types/joint_damping.h"
#include "tasks/types/joint_posture.h"
#include "tasks/types/point_position.h"

namespace footfall::model {
struct RobotDescription;
}  // namespace footfall::model

namespace footfall::tasks {

enum class TaskType : std::uint8_t {
  com_position,
  body_orientation,
  point_position,
  joint_posture,
  joint_damping,
  frame_orientation,
  frame_pose,
  centroidal_angular_momentum,
  count,
};

struct TaskTypeRow {
  TaskType type;
  TaskTypeInfo info;
};

inline constexpr std::array<TaskTypeRow, static_cast<std::size_t>(TaskType::count)> kTaskTypes = {{
    {TaskType::com_position, kComPosition},
    {TaskType::body_orientation, kBodyOrientation},
    {TaskType::point_position, kPointPosition},
    {TaskType::joint_posture, kJointPosture},
    {TaskType::joint_damping, kJointDamping},
    {TaskType::frame_orientation, kFrameOrientation},
    {TaskType::frame_pose, kFramePose},
    {TaskType::centroidal_angular_momentum, kCentroidalAngularMomentum},
}};

constexpr const TaskTypeInfo& info(TaskType type) noexcept {
  return kTaskTypes[static_cast<std::size_t>(type)].info;
}

// The type that a behavior file calls `name`.
std::optional<TaskType> find_task_type(std::string_view name);
// Names of all axes of a type on this robot, by AxisCommand::axis.
std::vector<std::string> axis_names(TaskType type, const model::RobotDescription& robot);
// As behavior files write it: "world", "stance", "heading".
std::string_view frame_name(Frame frame);

}  // namespace footfall::tasks
