// Joints and contacts as all estimators that measure see them.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/estimators/parts/contact_filter.h"
#include "engine/estimators/parts/foot_kinematics.h"
#include "engine/estimators/parts/joint_filter.h"
#include "engine/estimators/parts/motion_history.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

using engine::Matrix3d;
using engine::Vector3d;

TEST(JointFilter, WithoutAMotorTheEncoderCounts) {
  engine::JointFilter filter(load_hume());
  hal::Sensors sensors;
  sensors.q[1] = 0.3;
  sensors.qd[1] = 2.0;
  model::State state;
  filter.update(sensors, true, 0.0, 0.05, state);
  EXPECT_EQ(state.q[1], 0.3);
  EXPECT_EQ(state.qd[1], 2.0);
}

// All motors at exactly 0 are as good as any other angle: q_m = -tau / spring.
TEST(JointFilter, MotorsCountWhereTheyAreReported) {
  const model::RobotDescription robot = load_hume();
  engine::JointFilter filter(robot);
  hal::Sensors sensors;
  sensors.has_motors = true;
  model::State state;
  for (int i = 1; i <= 2; ++i) {
    sensors.tau[1] = -10.0 * i;
    filter.update(sensors, true, 0.0, 0.05, state);
  }
  EXPECT_NEAR(state.qd[1], 10.0 / robot.joints[1].spring / robot.period_s(), 1e-12);
}

// A spring that is not nominal: tau is the nominal constant times the measured deflection.
TEST(JointFilter, MotorLessDeflectionIsTheJointWhateverTheSpring) {
  const model::RobotDescription robot = load_hume();
  engine::JointFilter filter(robot);
  const double dt = robot.period_s(), spring = robot.joints[1].spring;
  hal::Sensors sensors;
  model::State state;
  for (int i = 0; i <= 1000; ++i) {
    const double q = 0.1 + 0.4 * std::sin(8.0 * dt * i), torque = 50.0 * std::sin(60.0 * dt * i);
    const double deflection = torque / (1.03 * spring);
    sensors.q[1] = 3.8e-4 * std::round(q / 3.8e-4);
    sensors.tau[1] = spring * deflection;
    sensors.motor[1] = q + deflection;
    filter.update(sensors, true, 0.0, 0.05, state);
    // The encoder's rounding is at most half a count, and mostly averaged out.
    ASSERT_NEAR(state.q[1], q, 1.9e-4);
    if (i > 0) {
      const double mean = (q - 0.1 - 0.4 * std::sin(8.0 * dt * (i - 1))) / dt;
      ASSERT_NEAR(state.qd[1], mean, 1e-10);
    }
  }
}

// A joint that moves on at a constant rate while three reads bring nothing: it is where it would
// have been seen, and the next sample makes no rate of four ticks' way in one.
TEST(JointFilter, WithoutNewValuesAJointGoesOnAsItMoved) {
  const model::RobotDescription robot = load_hume();
  engine::JointFilter filter(robot);
  hal::Sensors sensors;
  model::State state;
  const double step = 0.7 * robot.period_s();
  for (int k = 0; k < 20; ++k) {
    const bool fresh = k < 10 || k > 12;
    if (fresh) sensors.motor[3] = 0.1 + step * k;
    if (fresh) sensors.q[3] = sensors.motor[3];
    sensors.qd[3] = 0.7;
    filter.update(sensors, fresh, 1e-3, 0.05, state);
    ASSERT_NEAR(state.q[3], 0.1 + step * k, 1e-12) << k;
    ASSERT_NEAR(state.qd[3], 0.7, 1e-9) << k;
  }
}

TEST(JointFilter, VelocitiesAreLowPassed) {
  const model::RobotDescription robot = load_hume();
  engine::JointFilter filter(robot);
  hal::Sensors sensors;
  model::State state;
  filter.update(sensors, true, 10e-3, 0.0, state);
  sensors.qd[0] = 1.0;
  for (int i = 0; i < 15; ++i) filter.update(sensors, true, 10e-3, 0.0, state);
  EXPECT_NEAR(state.qd[0], 1.0 - std::exp(-15 * robot.period_s() / 10e-3), 1e-12);
}

class ContactRig {
 public:
  explicit ContactRig(behaviors::ContactSource source)
      : robot(load_hume()), model(robot), filter(robot, source) {
    model.update(standing_state(robot));
  }
  void tick(std::uint64_t support = 3) { filter.update(sensors, model, support, settings); }
  // The torques of a leg under a force of the ground: tau = h - Jᵀ f.
  void press(int foot, const Vector3d& force) {
    const auto& J = model.point(foot).jacobian;
    const std::size_t nv = static_cast<std::size_t>(model.nv());
    for (std::size_t j = 0; j < 6; ++j) {
      const Vector3d column(J[6 + j], J[nv + 6 + j], J[2 * nv + 6 + j]);
      if (column.norm() > 0.0) sensors.tau[j] = model.bias()[6 + j] - column.dot(force);
    }
  }

  model::RobotDescription robot;
  model::ControlModel model;
  engine::ContactFilter filter;
  hal::Sensors sensors;
  engine::ContactSettings settings{.debounce = 3e-3, .force = 50.0, .settle = 5e-3, .release = 0.0};
};

TEST(ContactFilter, ASwitchClosesAtOnceAndOpensWhenItStaysOpen) {
  ContactRig rig(behaviors::ContactSource::switches);
  rig.tick();
  rig.sensors.contact[0] = true;
  rig.tick();
  EXPECT_TRUE(rig.filter.contact()[0]);
  rig.sensors.contact[0] = false;  // 3 ms are 4.5 ticks
  for (int i = 0; i < 4; ++i) {
    rig.tick();
    EXPECT_TRUE(rig.filter.contact()[0]);
  }
  rig.tick();
  EXPECT_FALSE(rig.filter.contact()[0]);
}

TEST(ContactFilter, TorquesTellTheForceThatTheLegStandsAgainst) {
  ContactRig rig(behaviors::ContactSource::torque);
  for (const double force : {40.0, 60.0, 30.0, 20.0}) {
    rig.press(1, {5.0, -3.0, force});
    rig.tick();
    EXPECT_NEAR(rig.filter.force(1), force, 1e-2);
    EXPECT_EQ(rig.filter.contact()[1], force == 60.0 || force == 30.0) << force;
  }
  EXPECT_FALSE(rig.filter.contact()[0]);
}

TEST(ContactFilter, BothCloseByEitherAndOpenByBoth) {
  ContactRig rig(behaviors::ContactSource::both);
  rig.settings.debounce = 0.0;
  rig.press(0, {0.0, 0.0, 100.0});
  rig.tick();
  EXPECT_TRUE(rig.filter.contact()[0]);
  rig.sensors.contact[0] = true;
  rig.press(0, {0.0, 0.0, 0.0});
  rig.tick();
  EXPECT_TRUE(rig.filter.contact()[0]);
  rig.sensors.contact[0] = false;
  rig.tick();
  EXPECT_FALSE(rig.filter.contact()[0]);
}

TEST(ContactFilter, AnAnchorTouchesHasSettledAndIsReliedOn) {
  ContactRig rig(behaviors::ContactSource::switches);
  rig.sensors.contact[0] = true;
  rig.tick();
  EXPECT_TRUE(rig.filter.anchor(0));  // it stood there before the start
  rig.sensors.contact[1] = true;
  rig.tick();
  EXPECT_FALSE(rig.filter.anchor(1));  // 5 ms are 7.5 ticks
  for (int i = 0; i < 7; ++i) rig.tick();
  EXPECT_TRUE(rig.filter.anchor(1));
  rig.tick(2);
  EXPECT_FALSE(rig.filter.anchor(0));
  EXPECT_TRUE(rig.filter.anchor(1));
}

// The oracle: a model updated with this tick's state. The remainder is of second order.
TEST(FootKinematics, AreThoseOfThisTicksJoints) {
  const model::RobotDescription robot = load_hume();
  model::ControlModel before(robot), now(robot);
  Random random(9);
  const double dt = robot.period_s();
  for (int i = 0; i < 20; ++i) {
    const model::State last = random_state(robot, random);
    const model::State state = integrated(last, dt, robot.joint_count());
    before.update(last);
    now.update(state);
    const auto foot = engine::foot_kinematics(before, 1, state);
    const Matrix3d R = engine::rotation_of(state.q_WB);
    const Vector3d p(state.p_WB.data()), w(state.w_WB_B.data()), v(state.v_WB.data());
    const Vector3d contact = R.transpose() * (Vector3d(now.point(1).position.data()) - p);
    EXPECT_LT((foot.contact - contact).norm(), 5e-5);
    const Vector3d velocity = v + R * (w.cross(foot.contact) + foot.velocity);
    EXPECT_LT((velocity - Vector3d(now.point(1).velocity.data())).norm(), 3e-3);
  }
}

TEST(MotionHistory, ReachesBackByAnyAge) {
  engine::MotionHistory history(1e-3);
  engine::Motion motion;
  EXPECT_FALSE(history.since(0.0, motion));
  for (int i = 0; i < 300; ++i) history.add({0.0, 0.0, 1e-3 * i}, {1e-3 * i, 0.0, 0.0});
  ASSERT_TRUE(history.since(2.5e-3, motion));
  const double angle = 1e-3 * (299 + 298 + 0.5 * 297);
  EXPECT_NEAR(engine::rotation_log(motion.turn)[2], angle, 1e-12);
  EXPECT_NEAR(motion.shift[0], angle, 1e-12);
  EXPECT_FALSE(history.since(0.2, motion));
  EXPECT_FALSE(history.since(-1e-3, motion));
}

}  // namespace
}  // namespace footfall::tests
