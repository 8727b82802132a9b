// Names and columns of what figures are computed of; see tick_sample.h.
#include "lab/figures/tick_sample.h"

#include "behaviors/compiled/behavior.h"
#include "behaviors/language/estimators.h"

namespace footfall::lab {
namespace {

void add_once(std::vector<std::string>& list, const std::string& name) {
  if (std::ranges::find(list, name) == list.end()) list.push_back(name);
}

}  // namespace

SampleNames sample_names(const behaviors::Behavior& behavior) {
  SampleNames names;
  for (const auto& contact : behavior.robot.contacts) names.contacts.push_back(contact.name);
  for (const auto& joint : behavior.robot.joints) names.joints.push_back(joint.name);
  for (const behaviors::TaskInstance& task : behavior.task_instances) {
    const std::string& name = behavior.task_names[static_cast<std::size_t>(task.signals)].name;
    if (task.type == tasks::TaskType::com_position) add_once(names.height_tasks, name);
    if (task.type == tasks::TaskType::body_orientation) add_once(names.orientation_tasks, name);
  }
  names.internals = behavior.internal_instances;
  if (!behavior.planners.empty()) names.planner = behavior.planners.front().name;
  names.odometry = has_own_frame(behaviors::estimator_info(behavior.estimator.type).name);
  return names;
}

bool has_own_frame(std::string_view estimator) {
  for (const behaviors::EstimatorInfo& type : behaviors::estimator_types()) {
    if (type.name == estimator) return type.needs_imu && !type.needs_mocap;
  }
  return false;
}

SampleColumns sample_columns(const SampleNames& names,
                             const std::function<int(std::string_view)>& find) {
  const auto axes = [&](const std::string& stem, const auto& axis_names) {
    std::array<int, std::tuple_size_v<std::decay_t<decltype(axis_names)>>> columns{};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      columns[k] = find(stem + "." + axis_names[k]);
    }
    return columns;
  };
  static constexpr std::array<const char*, 3> kXyz = {"x", "y", "z"};
  static constexpr std::array<const char*, 3> kRpy = {"roll", "pitch", "yaw"};
  static constexpr std::array<const char*, 2> kXy = {"x", "y"};
  SampleColumns columns;
  columns.time = find("time");
  columns.torque_step = find("torque.step");
  for (const std::string& contact : names.contacts) {
    columns.contact.push_back(find("contact." + contact));
    columns.point.push_back(axes("point." + contact, kXyz));
  }
  for (const std::string& joint : names.joints) {
    columns.command.push_back(find("joint." + joint + ".command"));
  }
  columns.com = axes("com.pos", kXyz);
  columns.rpy = axes("base.rpy", kRpy);
  columns.true_com = axes("truth.com.pos", kXyz);
  if (names.odometry) columns.true_com[0] = columns.true_com[1] = -1;
  columns.true_rpy = axes("truth.base.rpy", kRpy);
  for (const std::string& task : names.orientation_tasks) {
    columns.rpy_reference.push_back(axes("task." + task + ".reference", kRpy));
  }
  for (const std::string& task : names.height_tasks) {
    columns.height_reference.push_back(find("task." + task + ".reference.z"));
  }
  columns.goal = axes("goal", kXy);
  columns.target = axes("planner." + names.planner + ".target", kXy);
  for (const std::string& internal : names.internals) {
    columns.internal.emplace_back(find("internal." + internal + ".reference"),
                                  find("internal." + internal + ".measured"));
  }
  return columns;
}

}  // namespace footfall::lab
