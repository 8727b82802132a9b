// Look-ups in the catalogue of task types; see task_types.h.
#include "tasks/task_types.h"

#include "model/robot/description.h"

namespace footfall::tasks {
namespace {

// Each row stands at its enumerator and describes itself. (That it has its functions, a test
// checks: with UBSan g++ compares no address of a function at compile time.)
constexpr bool is_complete() {
  for (std::size_t k = 0; k < kTaskTypes.size(); ++k) {
    const TaskTypeInfo& row = kTaskTypes[k].info;
    if (kTaskTypes[k].type != static_cast<TaskType>(k)) return false;
    if (row.name.empty() || row.doc.empty() || row.axes.empty() != row.of_joints()) return false;
  }
  return true;
}
static_assert(is_complete(), "kTaskTypes has a row for each TaskType, in their order");

}  // namespace

std::optional<TaskType> find_task_type(std::string_view name) {
  for (const TaskTypeRow& row : kTaskTypes) {
    if (row.info.name == name) return row.type;
  }
  return std::nullopt;
}

std::vector<std::string> axis_names(TaskType type, const model::RobotDescription& robot) {
  std::vector<std::string> names;
  if (info(type).of_joints()) {
    for (const model::JointDescription& joint : robot.joints) names.push_back(joint.name);
  }
  for (const AxisInfo& axis : info(type).axes) names.emplace_back(axis.name);
  return names;
}

std::string_view frame_name(Frame frame) {
  switch (frame) {
    case Frame::world:
      return "world";
    case Frame::stance:
      return "stance";
    case Frame::usual:
    case Frame::heading:
      break;
  }
  return "heading";
}

}  // namespace footfall::tasks
