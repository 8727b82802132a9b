// Tasks on frames, momentum, stance contacts and surfaces: their errors decay as the gains say, and
// their rows are derivatives of what they measure.
#include <gtest/gtest.h>

#include <array>

#include "model/height_surface.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/tasks/task_law_fixture.h"

namespace footfall::tests {
namespace {

using tasks::Frame;

constexpr int kLeftFootPoint = 1;
constexpr int kLeftKneePoint = 6;  // without a ball about it

AxisCommand to(int axis, double ref) { return {axis, 100, 0, 20, ref, 0, 0}; }

class TaskTypes : public TaskLaw {
 protected:
  explicit TaskTypes(const model::RobotDescription& robot = load_hume()) : TaskLaw(robot) {}
  void SetUp() override { model_.update(standing_state(robot_)); }
  TaskCommand framed(TaskType type, Frame frame, int point = -1) {
    TaskCommand t = task(type, point);
    t.frame = frame;
    return t;
  }
  // The rows' velocity and bias against central differences of what is measured, along a motion at
  // constant generalised velocity. `measure`: the quantity whose rate the rows are.
  void expect_derivatives(const TaskCommand& t, const std::vector<AxisCommand>& axes,
                          const std::vector<int>& stance,
                          const std::function<double(const Law&, std::size_t)>& measure) {
    // h² / 6 times third derivatives (up to 40 rad³/s³ on 1 m) and round-off 1e-16/h: below 1e-6.
    constexpr double h = 1e-4;
    constexpr double kDifference = 2e-6;
    const model::State s = random_state(robot_, random_);
    model_.update(s);
    const Law now = evaluate(t, axes, 0, stance);
    Matrix v(12);
    for (int k = 0; k < 12; ++k) {
      const auto q = static_cast<std::size_t>(k);
      v(k) = k < 3 ? s.v_WB[q] : k < 6 ? s.w_WB_B[q - 3] : s.qd[q - 6];
    }
    std::vector<double> before, after, rate_before, rate_after;
    for (const bool later : {false, true}) {
      model_.update(integrated(s, later ? h : -h, 6));
      const Law law = evaluate(t, axes, 0, stance);
      const Matrix rate = law.J * v;
      for (std::size_t k = 0; k < axes.size(); ++k) {
        if (measure) (later ? after : before).push_back(measure(law, k));
        (later ? rate_after : rate_before).push_back(rate(static_cast<int>(k)));
      }
    }
    const Matrix rate = now.J * v;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const auto row = static_cast<int>(k);
      EXPECT_NEAR(rate(row), now.axes[k].velocity, 1e-12);
      if (measure) {
        EXPECT_NEAR(rate(row), (after[k] - before[k]) / (2 * h), kDifference) << k;
      }
      EXPECT_NEAR(now.bias(row), (rate_after[k] - rate_before[k]) / (2 * h), kDifference) << k;
    }
  }
};

TEST_F(TaskTypes, AFramesOrientationErrorsDecayAsTheGainsSay) {
  const auto rpy = model_.frame(kLeftFootPoint).rpy;
  for (const Frame frame : {Frame::heading, Frame::world}) {
    const Matrix e = error_after(framed(TaskType::frame_orientation, frame, kLeftFootPoint),
                                 {to(0, rpy[0] + 0.05), to(1, rpy[1] - 0.1), to(2, rpy[2])},
                                 standing_state(robot_), kDuration);
    model_.update(standing_state(robot_));
    const Law start = evaluate(framed(TaskType::frame_orientation, frame, kLeftFootPoint),
                               {to(0, rpy[0] + 0.05), to(1, rpy[1] - 0.1), to(2, rpy[2])});
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(e(static_cast<int>(k)), start.axes[k].error * critically_damped(kDuration),
                  0.1 * 5 * kStep);
    }
  }
}

TEST_F(TaskTypes, OneAxisOfAFramesOrientationDecaysAlone) {
  const auto rpy = model_.frame(kLeftFootPoint).rpy;
  const Matrix e = error_after(framed(TaskType::frame_orientation, Frame::heading, kLeftFootPoint),
                               {to(1, rpy[1] + 0.1)}, standing_state(robot_), kDuration);
  EXPECT_NEAR(e(0), 0.1 * critically_damped(kDuration), 0.1 * kStep);
}

// The base's own site is turned with it, so its frame task is the base's orientation task.
TEST_F(TaskTypes, TheFrameOfASiteOnTheBaseIsTheBasesOrientation) {
  const int torso = 3;
  ASSERT_EQ(robot_.points[1].name, "torso_com");
  model_.update(random_state(robot_, random_));
  const std::vector<AxisCommand> axes = {to(0, 0.1), to(1, -0.2), to(2, 0.3)};
  const Law frame = evaluate(framed(TaskType::frame_orientation, Frame::heading, torso), axes);
  const Law base = evaluate(framed(TaskType::body_orientation, Frame::heading), axes, 1);
  EXPECT_LE((frame.J - base.J).max_abs(), 1e-14);
  EXPECT_LE((frame.bias - base.bias).max_abs(), 1e-13);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(frame.axes[k].error, base.axes[k].error, 1e-14);
  }
}

TEST_F(TaskTypes, TheWorldsAxesGiveTheSameErrorTurned) {
  model_.update(random_state(robot_, random_));
  const std::vector<AxisCommand> axes = {to(0, 0.1), to(1, -0.2), to(2, 0.3)};
  const Law heading = evaluate(framed(TaskType::body_orientation, Frame::heading), axes);
  const Law world = evaluate(framed(TaskType::body_orientation, Frame::world), axes, 1);
  const Matrix e =
      Matrix::vector({heading.axes[0].error, heading.axes[1].error, heading.axes[2].error});
  const Matrix turn = rotation(Matrix::vector(kZ), model_.rpy()[2]);
  const Matrix expected = turn * e;
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(world.axes[k].error, expected(static_cast<int>(k)), 1e-14);
  }
  EXPECT_LE((world.J - turn * heading.J).max_abs(), 1e-14);
}

TEST_F(TaskTypes, APosesErrorsDecayAsTheGainsSay) {
  const auto p = model_.point(kLeftKneePoint).position;
  const auto rpy = model_.frame(kLeftKneePoint).rpy;
  const std::vector<AxisCommand> axes = {to(0, p[0] + 0.03),  to(1, p[1]),
                                         to(2, p[2] + 0.05),  to(3, rpy[0]),
                                         to(4, rpy[1] + 0.1), to(5, rpy[2])};
  const Matrix e = error_after(task(TaskType::frame_pose, kLeftKneePoint), axes,
                               standing_state(robot_), kDuration);
  const std::array<double, 6> start = {0.03, 0.0, 0.05, 0.0, 0.1, 0.0};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(e(static_cast<int>(k)), start[k] * critically_damped(kDuration), 0.1 * kStep);
  }
}

TEST_F(TaskTypes, AngularMomentumDiesOutAtTheRateOfKd) {
  const model::State moving = random_state(robot_, random_);
  model_.update(moving);
  const auto h = model_.angular_momentum().velocity;
  // h' = -5 h: from h0 to h0 exp(-1). Euler: relative error kd² dt t/2 = 2.5e-4.
  const std::vector<AxisCommand> axes = {
      {0, 0, 0, 5, 0, 0, 0}, {1, 0, 0, 5, 0, 0, 0}, {2, 0, 0, 5, 0, 0, 0}};
  const Matrix e =
      error_after(task(TaskType::centroidal_angular_momentum), axes, moving, kDuration);
  const double size = std::hypot(h[0], h[1], h[2]);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(e(static_cast<int>(k)), -h[k] * std::exp(-1.0), 1e-3 * size);
  }
}

TEST_F(TaskTypes, KpActsOnTheIntegralOfTheMomentumsError) {
  period_ = kIntegrationStep;
  const model::State moving = random_state(robot_, random_);
  model_.update(moving);
  const double h = model_.angular_momentum().velocity[1];
  // With z = ∫e: z'' + 20 z' + 100 z = 0, z(0) = 0, z'(0) = e0: e = e0 (1 - 10 t) exp(-10 t).
  const Matrix e = error_after(task(TaskType::centroidal_angular_momentum),
                               {{1, 100, 0, 20, 0.2, 0, 0}}, moving, kDuration);
  const double expected = (0.2 - h) * (1.0 - 10.0 * kDuration) * std::exp(-10.0 * kDuration);
  // h/2 t max|e''| = 1e-4/2 x 0.2 x 300 e0.
  EXPECT_NEAR(e(0), expected, 4e-3 * std::abs(0.2 - h));
}

TEST_F(TaskTypes, MomentumsReferenceRateIsFeedForward) {
  model_.update(random_state(robot_, random_));
  const double h = model_.angular_momentum().velocity[0];
  const Law law =
      evaluate(task(TaskType::centroidal_angular_momentum), {{0, 0, 0, 4, 1.0, 7.0, 99.0}});
  EXPECT_NEAR(law.axes[0].commanded, 7.0 + 4 * (1.0 - h), 1e-12);
}

double as_measured(const Law& law, std::size_t k) { return law.axes[k].measured; }

TEST_F(TaskTypes, MomentumsBiasIsTheDerivativeOfItsRows) {
  for (int i = 0; i < 10; ++i) {
    expect_derivatives(task(TaskType::centroidal_angular_momentum), {{0}, {1}, {2}}, {}, nullptr);
  }
}

// On feet without a ball, whose contact point is the same material point all the time.
class TaskTypesOnPoints : public TaskTypes {
 protected:
  static model::RobotDescription on_points() {
    model::RobotDescription robot = load_hume();
    for (auto& contact : robot.contacts) contact.radius = 0.0;
    return robot;
  }
  TaskTypesOnPoints() : TaskTypes(on_points()) {}
};

TEST_F(TaskTypesOnPoints, RowsFromTheStanceFeetAreDerivativesOfTheDistance) {
  for (const std::vector<int>& stance : {std::vector<int>{0}, std::vector<int>{0, 1}}) {
    expect_derivatives(framed(TaskType::com_position, Frame::stance), {{0}, {1}, {2}}, stance,
                       as_measured);
    expect_derivatives(framed(TaskType::frame_pose, Frame::stance, 5), {{2}, {0}}, stance,
                       as_measured);
  }
}

TEST_F(TaskTypesOnPoints, APlaceOverTheStanceFeetDecaysAsTheGainsSay) {
  const double x =
      model_.com().position[0] - 0.5 * (model_.point(0).position[0] + model_.point(1).position[0]);
  const Matrix e = error_after(framed(TaskType::com_position, Frame::stance), {to(0, x + 0.03)},
                               standing_state(robot_), kDuration, {0, 1});
  EXPECT_NEAR(e(0), 0.03 * critically_damped(kDuration), 0.03 * kStep);
}

TEST_F(TaskTypes, FromTwoStanceFeetTheOriginIsTheirMiddle) {
  model_.update(random_state(robot_, random_));
  const Law law = evaluate(framed(TaskType::com_position, Frame::stance), {{1}}, 0, {0, 1});
  const double middle = 0.5 * (model_.point(0).position[1] + model_.point(1).position[1]);
  EXPECT_NEAR(law.axes[0].measured, model_.com().position[1] - middle, 1e-15);
}

TEST_F(TaskTypes, AHeightOverTheStanceFootDecaysAsTheGainsSay) {
  const double z = model_.com().position[2] - model_.point(0).position[2];
  const Matrix e = error_after(framed(TaskType::com_position, Frame::stance), {to(2, z + 0.02)},
                               standing_state(robot_), kDuration, {0});
  EXPECT_NEAR(e(0), 0.02 * critically_damped(kDuration), 0.02 * kStep);
}

TEST_F(TaskTypes, ARowWithASlopeIsTheDerivativeOfTheHeightOverIt) {
  std::vector<AxisCommand> axes = {{2}};
  axes[0].slope = 0.3;
  expect_derivatives(task(TaskType::com_position), axes, {}, [this](const Law&, std::size_t) {
    return model_.com().position[2] - 0.3 * model_.com().position[0];
  });
}

// The CoM runs up a ramp at 0.6 m/s; its height above the surface still obeys the gains exactly.
TEST_F(TaskTypes, AHeightOverASurfaceDecaysAsTheGainsSayOnTheRampToo) {
  const model::HeightSurface surface = {{{0.0, 0.1, 0.03}}};
  model::State running = standing_state(robot_);
  running.v_WB[0] = 0.6;
  model_.update(running);
  const double x = model_.com().position[0];
  running.p_WB[0] -= x;  // over the foot of the ramp
  const double offset = model_.com().position[2] - 0.02;
  const auto follow = [&](std::vector<AxisCommand>& axes) {
    const auto ground = surface.at(model_.com().position[0]);
    const double speed = model_.com().velocity[0];
    axes[0].ref = ground.height + offset;
    axes[0].ref_vel = 0.0;
    axes[0].ref_acc = ground.curvature * speed * speed;
    axes[0].slope = ground.slope;
  };
  const Matrix e =
      error_after(task(TaskType::com_position), {to(2, 0.0)}, running, 0.1, {}, follow);
  // Curvature is up to 17 /m: of what it asks for, an Euler step sees h/2 x 17 x 0.36 m/s² late.
  EXPECT_NEAR(e(0), -0.02 * critically_damped(0.1), 0.02 * kStep + 0.5e-4 * 6.2 * 0.1);
  EXPECT_GT(model_.com().position[0], 0.05);
}

TEST_F(TaskTypes, ANewAxisForgetsItsIntegralTheOthersKeepTheirs) {
  const auto com = model_.com().position;
  const TaskCommand t = task(TaskType::com_position);
  std::vector<AxisCommand> axes = {{0, 0, 10, 0, com[0] + 0.01, 0, 0},
                                   {2, 0, 10, 0, com[2] + 0.01, 0, 0}};
  for (int tick = 1; tick <= 3; ++tick) evaluate(t, axes, tick);
  axes[1].fresh = true;
  const Law law = evaluate(t, axes, 4);
  EXPECT_NEAR(law.axes[0].commanded, 10 * 0.01 * kPeriod * 4, 1e-12);
  EXPECT_NEAR(law.axes[1].commanded, 10 * 0.01 * kPeriod, 1e-12);
}

TEST_F(TaskTypes, TwoLawsWithOtherAxesOfOneTaskEachIntegrateTheirOwn) {
  const auto com = model_.com().position;
  const TaskCommand t = task(TaskType::com_position);
  const AxisCommand x = {0, 0, 10, 0, com[0] + 0.01, 0, 0};
  const AxisCommand z = {2, 0, 10, 0, com[2] + 0.01, 0, 0};
  evaluate(t, {x}, 1);
  const Law law = evaluate(t, {x, z}, 1);
  EXPECT_NEAR(law.axes[0].commanded, 10 * 0.01 * kPeriod, 1e-12);
  EXPECT_NEAR(law.axes[1].commanded, 10 * 0.01 * kPeriod, 1e-12);
}

TEST_F(TaskTypes, EvaluatingFramesAndMomentumAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  model_.update(random_state(robot_, random_));
  std::array<AxisCommand, 6> axes{};
  for (int k = 0; k < 6; ++k) axes[static_cast<std::size_t>(k)].axis = k;
  std::array<double, 72> J{};
  std::array<double, 6> bias{};
  std::array<AxisEvaluation, 6> out{};
  const std::array<int, 2> stance = {0, 1};
  const tasks::LawContext context = {&model_, &memory_, 3, kPeriod, stance.data(), 2};
  TaskCommand pose = framed(TaskType::frame_pose, Frame::stance, kLeftFootPoint);
  pose.axis_count = 6;
  TaskCommand momentum = task(TaskType::centroidal_angular_momentum);
  momentum.axis_count = 3;
  const AllocationGuard guard;
  tasks::evaluate_task(pose, axes.data(), context, J.data(), bias.data(), out.data());
  tasks::evaluate_task(momentum, axes.data(), context, J.data(), bias.data(), out.data());
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
