// The catalogue of task types: names, axes, units, and rows that agree with what is measured.
#include <gtest/gtest.h>

#include <set>

#include "tasks/task_types.h"
#include "tests/unit/tasks/task_law_fixture.h"

namespace footfall::tests {
namespace {

using tasks::info;

TEST(TaskCatalogue, NamesAreFoundAndDiffer) {
  std::set<std::string_view> names;
  for (const tasks::TaskTypeRow& row : tasks::kTaskTypes) {
    EXPECT_TRUE(names.insert(row.info.name).second) << row.info.name;
    EXPECT_EQ(tasks::find_task_type(row.info.name), row.type);
    EXPECT_NE(row.info.rows, nullptr) << row.info.name;
    EXPECT_NE(row.info.measured, nullptr) << row.info.name;
  }
  EXPECT_EQ(tasks::find_task_type("com_postion"), std::nullopt);
  EXPECT_EQ(tasks::find_task_type(""), std::nullopt);
}
TEST(TaskCatalogue, EveryEnumeratorHasItsOwnRow) {
  EXPECT_EQ(info(TaskType::com_position).name, "com_position");
  EXPECT_EQ(info(TaskType::body_orientation).name, "body_orientation");
  EXPECT_EQ(info(TaskType::point_position).name, "point_position");
  EXPECT_EQ(info(TaskType::joint_posture).name, "joint_posture");
  EXPECT_EQ(info(TaskType::joint_damping).name, "joint_damping");
  EXPECT_EQ(info(TaskType::frame_orientation).name, "frame_orientation");
  EXPECT_EQ(info(TaskType::frame_pose).name, "frame_pose");
  EXPECT_EQ(info(TaskType::centroidal_angular_momentum).name, "centroidal_angular_momentum");
}
TEST(TaskCatalogue, AxesAreNamedByTheTypeOrByTheRobotsJoints) {
  const model::RobotDescription robot = load_hume();
  EXPECT_EQ(tasks::axis_names(TaskType::frame_pose, robot),
            (std::vector<std::string>{"x", "y", "z", "roll", "pitch", "yaw"}));
  const std::vector<std::string> joints = tasks::axis_names(TaskType::joint_damping, robot);
  ASSERT_EQ(joints.size(), robot.joints.size());
  EXPECT_EQ(joints.front(), robot.joints.front().name);
  EXPECT_EQ(info(TaskType::joint_posture).axis_count(6), 6);
  EXPECT_EQ(info(TaskType::com_position).axis_count(6), 3);
}
TEST(TaskCatalogue, UnitsOfACommandAreThoseOfTheAxisPerTimeOnceForARateElseTwice) {
  EXPECT_EQ(info(TaskType::com_position).commanded_dimension(2), core::kAcceleration);
  EXPECT_EQ(info(TaskType::frame_pose).commanded_dimension(5), core::kRateSquared);
  EXPECT_EQ(info(TaskType::joint_posture).commanded_dimension(4), core::kRateSquared);
  EXPECT_EQ(info(TaskType::centroidal_angular_momentum).commanded_dimension(0), core::kTorque);
}

class CatalogueRows : public TaskLaw {};

// One axis at a time, against a random state: a row for every axis, with the measured value that
// the references start from; velocity = J q̇.
TEST_F(CatalogueRows, EveryAxisOfEveryTypeHasARowThatAgreesWithWhatIsMeasured) {
  const model::State s = random_state(robot_, random_);
  model_.update(s);
  Matrix v(12);
  for (int k = 0; k < 12; ++k) {
    const auto q = static_cast<std::size_t>(k);
    v(k) = k < 3 ? s.v_WB[q] : k < 6 ? s.w_WB_B[q - 3] : s.qd[q - 6];
  }
  for (const tasks::TaskTypeRow& row : tasks::kTaskTypes) {
    const int point = row.info.of_point() ? 0 : -1;
    for (int axis = 0; axis < row.info.axis_count(6); ++axis) {
      const Law law = evaluate(task(row.type, point), {{axis, 1, 0, 1, 0.0, 0, 0}});
      EXPECT_GT(law.J.norm(), 0.0) << row.info.name << " " << axis;
      EXPECT_NEAR((law.J * v)(0), law.axes[0].velocity, 1e-12) << row.info.name << " " << axis;
      EXPECT_NEAR(tasks::measured_position(model_, row.type, point, axis), law.axes[0].measured,
                  1e-9)
          << row.info.name << " " << axis;
      const bool has_velocity = row.info.velocity != nullptr && row.info.is_length(axis);
      EXPECT_NEAR(tasks::measured_velocity(model_, row.type, point, axis),
                  has_velocity ? law.axes[0].velocity : 0.0, 1e-12)
          << row.info.name << " " << axis;
    }
  }
}

}  // namespace
}  // namespace footfall::tests
