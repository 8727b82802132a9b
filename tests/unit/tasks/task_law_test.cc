// The tasks' control laws: closed loops that obey their gains, axes, integrals and limits.
// Equations: [Kim16] eq. (37).
#include "tasks/task_law.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/allocation_guard.h"
#include "tests/unit/tasks/task_law_fixture.h"

namespace footfall::tests {
namespace {

constexpr int kStanceFoot = 0;

TEST_F(TaskLaw, CentreOfMassErrorsDecayAsTheGainsSay) {
  model_.update(standing_state(robot_));
  const auto com = model_.com().position;
  const std::vector<AxisCommand> axes = {{0, 100, 0, 20, com[0] + 0.03, 0, 0},
                                         {2, 100, 0, 20, com[2] - 0.02, 0, 0}};
  const Matrix e =
      error_after(task(TaskType::com_position), axes, standing_state(robot_), kDuration);
  EXPECT_NEAR(e(0), 0.03 * critically_damped(kDuration), 0.03 * kStep);
  EXPECT_NEAR(e(1), -0.02 * critically_damped(kDuration), 0.02 * kStep);
}

TEST_F(TaskLaw, PointErrorsDecayAsTheGainsSay) {
  model_.update(standing_state(robot_));
  const auto knee = model_.point(6).position;
  const std::vector<AxisCommand> at_knee = {{0, 100, 0, 20, knee[0] + 0.05, 0, 0},
                                            {2, 100, 0, 20, knee[2] + 0.02, 0, 0}};
  const Matrix k =
      error_after(task(TaskType::point_position, 6), at_knee, standing_state(robot_), kDuration);
  EXPECT_NEAR(k(0), 0.05 * critically_damped(kDuration), 0.05 * kStep);
  EXPECT_NEAR(k(1), 0.02 * critically_damped(kDuration), 0.05 * kStep);
}

TEST_F(TaskLaw, OrientationErrorsDecayAsTheGainsSayAtAnyHeading) {
  for (const double yaw : {0.0, 2.0, -2.5}) {
    const std::vector<AxisCommand> axes = {{1, 100, 0, 20, 0, 0, 0}, {0, 100, 0, 20, 0, 0, 0}};
    const Matrix e =
        error_after(task(TaskType::body_orientation), axes, turned(yaw, kY, 0.1), kDuration);
    EXPECT_NEAR(e(0), -0.1 * critically_damped(kDuration), 0.1 * kStep);
    EXPECT_NEAR(e(1), 0.0, 0.1 * kStep);
  }
}

TEST_F(TaskLaw, JointErrorsDecayAsTheGainsSay) {
  const model::State s = standing_state(robot_);
  const std::vector<AxisCommand> axes = {{2, 100, 0, 20, s.q[2] + 0.1, 0, 0}};
  const Matrix e = error_after(task(TaskType::joint_posture), axes, s, kDuration);
  EXPECT_NEAR(e(0), 0.1 * critically_damped(kDuration), 0.1 * kStep);
}

TEST_F(TaskLaw, DampingLetsAJointsSpeedDecayWithoutAReference) {
  model::State s = standing_state(robot_);
  s.qd[4] = 2.0;
  model_.update(s);
  const Law law = evaluate(task(TaskType::joint_damping), {{4, 100, 50, 3, 7.0, 0, 0}});
  EXPECT_DOUBLE_EQ(law.axes[0].error, 0.0);
  EXPECT_DOUBLE_EQ(law.axes[0].commanded, -6.0);
}

TEST_F(TaskLaw, FeedForwardEntersAsItIs) {
  model_.update(standing_state(robot_));
  const double z = model_.com().position[2];
  const Law law = evaluate(task(TaskType::com_position), {{2, 100, 0, 20, z + 0.01, 0.5, 3.0}});
  EXPECT_NEAR(law.axes[0].commanded, 3.0 + 100 * 0.01 + 20 * 0.5, 1e-12);
}

TEST_F(TaskLaw, RowsAreTheModelsJacobianAndBias) {
  model_.update(random_state(robot_, random_));
  const Law law = evaluate(task(TaskType::point_position, 1), {{2}, {0}});
  const model::Kinematics3& k = model_.point(1);
  for (int q = 0; q < 12; ++q) {
    EXPECT_EQ(law.J(0, q), k.jacobian[static_cast<std::size_t>(24 + q)]);
    EXPECT_EQ(law.J(1, q), k.jacobian[static_cast<std::size_t>(q)]);
  }
  EXPECT_EQ(law.bias(0), k.bias[2]);
  EXPECT_EQ(law.axes[1].velocity, k.velocity[0]);
}

TEST_F(TaskLaw, AnOrientationErrorIsTheRotationVectorEvenWhenLarge) {
  const std::array<double, 3> axis = {0.6, -0.64, 0.48};
  for (const double yaw : {0.0, 2.0}) {
    model_.update(turned(yaw, axis, 1.5));
    // Reference: the heading frame itself, whose roll, pitch and yaw are those of `yaw` alone. The
    // body's own heading differs: errors are given on its axes.
    const Law law =
        evaluate(task(TaskType::body_orientation),
                 {{0, 1, 0, 0, 0.0, 0, 0}, {1, 1, 0, 0, 0.0, 0, 0}, {2, 1, 0, 0, yaw, 0, 0}});
    const Matrix z = Matrix::vector(kZ);
    const Matrix world = rotation(z, yaw) * (-1.5 * Matrix::vector(axis));
    const Matrix expected = rotation(z, -model_.rpy()[2]) * world;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(law.axes[k].error, expected(static_cast<int>(k)), 1e-12);
    }
  }
}

TEST_F(TaskLaw, PitchAndRollKeepTheirMeaningAtAnyYaw) {
  model_.update(turned(2.0, kY, 0.2));
  const std::vector<AxisCommand> axes = {{1, 1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0}};
  const Law pitched = evaluate(task(TaskType::body_orientation), axes);
  EXPECT_NEAR(pitched.axes[0].error, -0.2, 1e-12);
  EXPECT_NEAR(pitched.axes[1].error, 0.0, 1e-12);
  model_.update(turned(2.0, kX, 0.2));
  const Law rolled = evaluate(task(TaskType::body_orientation), axes);
  EXPECT_NEAR(rolled.axes[0].error, 0.0, 1e-12);
  EXPECT_NEAR(rolled.axes[1].error, -0.2, 1e-12);
}

TEST_F(TaskLaw, YawThatIsNotControlledIsNoError) {
  model_.update(turned(2.0, kZ, 0.0));
  const Law law =
      evaluate(task(TaskType::body_orientation), {{1, 1, 0, 0, 0, 0, 0}, {0, 1, 0, 0, 0, 0, 0}});
  EXPECT_NEAR(law.axes[0].error, 0.0, 1e-12);
  EXPECT_NEAR(law.axes[1].error, 0.0, 1e-12);
}

TEST_F(TaskLaw, AYawErrorGoesTheShortWayRound) {
  model_.update(turned(3.0, kZ, 0.0));
  const Law law = evaluate(task(TaskType::body_orientation), {{2, 1, 0, 0, -3.0, 0, 0}});
  EXPECT_NEAR(law.axes[0].error, 2.0 * 3.14159265358979 - 6.0, 1e-12);
}

TEST_F(TaskLaw, TheStanceFrameMeasuresFromTheStanceFoot) {
  model_.update(random_state(robot_, random_));
  TaskCommand t = task(TaskType::com_position);
  t.frame = tasks::Frame::stance;
  const Law law = evaluate(t, {{2, 1, 0, 0, 0.9, 0, 0}}, 0, {kStanceFoot});
  const double height = model_.com().position[2] - model_.point(kStanceFoot).position[2];
  EXPECT_NEAR(law.axes[0].measured, height, 1e-15);
  EXPECT_NEAR(law.axes[0].error, 0.9 - height, 1e-15);
}

TEST_F(TaskLaw, TheIntegralGrowsWithTheErrorAndStopsAtItsLimit) {
  model_.update(standing_state(robot_));
  const double z = model_.com().position[2];
  const TaskCommand t = task(TaskType::com_position);
  std::vector<AxisCommand> axes = {{2, 0, 10, 0, z + 0.01, 0, 0}};
  axes[0].integral_limit = 5e-5;
  for (int tick = 1; tick <= 10; ++tick) {
    const double expected = std::min(0.01 * kPeriod * tick, 5e-5);
    EXPECT_NEAR(evaluate(t, axes, tick).axes[0].commanded, 10 * expected, 1e-12);
  }
  std::vector<AxisCommand> back = {{2, 0, 10, 0, z - 0.01, 0, 0}};
  back[0].integral_limit = 5e-5;
  EXPECT_NEAR(evaluate(t, back, 11).axes[0].commanded, 10 * 4e-5, 1e-12);  // no wind-up
}

TEST_F(TaskLaw, AFreshTaskForgetsItsIntegral) {
  model_.update(standing_state(robot_));
  const double z = model_.com().position[2];
  TaskCommand t = task(TaskType::com_position);
  const std::vector<AxisCommand> axes = {{2, 0, 10, 0, z + 0.01, 0, 0}};
  for (int tick = 1; tick <= 10; ++tick) evaluate(t, axes, tick);
  t.fresh = true;
  EXPECT_NEAR(evaluate(t, axes, 11).axes[0].commanded, 10 * 0.01 * kPeriod, 1e-12);
}

TEST_F(TaskLaw, AnInstanceThatServesTwoLawsIntegratesOnce) {
  model_.update(standing_state(robot_));
  const double z = model_.com().position[2];
  const TaskCommand t = task(TaskType::com_position);
  const std::vector<AxisCommand> axes = {{2, 0, 10, 0, z + 0.01, 0, 0}};
  const double first = evaluate(t, axes, 1).axes[0].commanded;
  EXPECT_EQ(evaluate(t, axes, 1).axes[0].commanded, first);
  EXPECT_NEAR(evaluate(t, axes, 2).axes[0].commanded, 2 * first, 1e-12);
}

TEST_F(TaskLaw, InstancesKeepTheirOwnIntegrals) {
  model_.update(standing_state(robot_));
  const double z = model_.com().position[2];
  TaskCommand t = task(TaskType::com_position);
  const std::vector<AxisCommand> axes = {{2, 0, 10, 0, z + 0.01, 0, 0}};
  evaluate(t, axes, 1);
  t.instance = 1;
  EXPECT_NEAR(evaluate(t, axes, 1).axes[0].commanded, 10 * 0.01 * kPeriod, 1e-12);
}

TEST_F(TaskLaw, TheAccelerationLimitBoundsWhatIsAskedFor) {
  model_.update(standing_state(robot_));
  const double z = model_.com().position[2];
  const TaskCommand t = task(TaskType::com_position);
  AxisCommand axis = {2, 1000, 0, 0, z + 1.0, 0, 0};
  axis.acceleration_limit = 2.0;
  EXPECT_DOUBLE_EQ(evaluate(t, {axis}).axes[0].commanded, 2.0);
  axis.ref = z - 1.0;
  EXPECT_DOUBLE_EQ(evaluate(t, {axis}).axes[0].commanded, -2.0);
}

TEST_F(TaskLaw, EvaluatingAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  model_.update(random_state(robot_, random_));
  const std::array<AxisCommand, 3> axes = {AxisCommand{0, 1, 1, 1, 0, 0, 0}, {1}, {2}};
  TaskCommand t = task(TaskType::body_orientation);
  t.axis_count = 3;
  std::array<double, 36> J{};
  std::array<double, 3> bias{};
  std::array<AxisEvaluation, 3> out{};
  const tasks::LawContext context = {&model_, &memory_, 3, kPeriod, nullptr, 0};
  const AllocationGuard guard;
  tasks::evaluate_task(t, axes.data(), context, J.data(), bias.data(), out.data());
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
