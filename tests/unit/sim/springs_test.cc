// External aids against closed forms, on a brick: a robot of one body, without joints or contacts.
#include "sim/springs.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <fstream>
#include <numbers>

#include "core/diagnostics/diagnostics.h"
#include "sim/mujoco_backend.h"
#include "sim/springs_check.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/hume.h"
#include "tests/unit/sim/brick.h"

namespace footfall::sim {
namespace {

constexpr double kBrickMass = 2.0;      // kg
constexpr double kGravity = 9.81;       // m/s^2
constexpr double kStep = 1.0 / 3000.0;  // s
constexpr double kRadPerDegree = std::numbers::pi / 180.0;

class Springs : public Brick {
 protected:
  model::AxisSpring spring(double stiffness, std::optional<double> damping = {}) {
    model::AxisSpring out;
    out.stiffness = stiffness;
    out.damping = damping;
    return out;
  }
};

TEST_F(Springs, AHungBodySagsByItsWeightOverTheStiffness) {
  for (auto& axis : aid().axes) axis = spring(20000);
  start();
  ticks(3000);
  EXPECT_NEAR(position(2), 10.0 - kBrickMass * kGravity / 20000, 1e-12);
  EXPECT_NEAR(force(2), kBrickMass * kGravity, 1e-8);
  EXPECT_NEAR(position(0), 0.0, 1e-12);
}

// Semi-implicit Euler oscillates at w' with cos(w' h) = 1 - h^2 k/(2 m), which is sqrt(k/m) but for
// (h w)^2/24; from x = 0 it is x_n = h v sin(n w' h)/sin(w' h).
TEST_F(Springs, AnUndampedSpringOscillatesAtTheRootOfStiffnessOverMass) {
  constexpr double kStiffness = 2000;
  aid().axes[0] = spring(kStiffness, 0.0);
  world_.constraints[0].axes[2] = spring(20000);
  world_.start.velocity = {0.1, 0.0};
  world_.physics.steps_per_tick = 1;
  robot_.rate_mhz = 3'000'000;
  start();
  const double turn = std::acos(1.0 - kStep * kStep * kStiffness / (2.0 * kBrickMass));
  const double w = std::sqrt(kStiffness / kBrickMass);
  EXPECT_NEAR(turn / kStep, w * (1.0 + kStep * kStep * w * w / 24.0), 1e-8);
  for (int n = 1; n < 9000; ++n) {
    ticks(1);
    ASSERT_NEAR(position(0), kStep * 0.1 * std::sin(n * turn) / std::sin(turn), 1e-11) << n;
  }
}

// v t exp(-w t) has its largest value v/(e w) at 1/w, but for the order h w of the step.
TEST_F(Springs, WithoutDampingWrittenItIsCritical) {
  aid().axes[0] = spring(2000);
  world_.start.velocity = {0.1, 0.0};
  start();
  const double w = std::sqrt(2000 / kBrickMass);
  double largest = 0.0, least = 0.0;
  for (int n = 0; n < 1500; ++n) {
    ticks(1);
    largest = std::max(largest, position(0));
    least = std::min(least, position(0));
  }
  EXPECT_NEAR(largest, 0.1 / (std::numbers::e * w), 3.0 * kStep * w * largest);
  EXPECT_EQ(least, 0.0);
}

TEST_F(Springs, JustInsideTheBoundHoldsAndBeyondItIsRefusedAndGrows) {
  const double bound = 4.0 * kBrickMass / (kStep * kStep);
  aid().axes[0] = spring(0.99 * bound, 0.0);
  world_.start.velocity = {1e-3, 0.0};
  EXPECT_EQ(refusals(), "");
  start();
  for (int n = 0; n < 3000; ++n) {
    ticks(1);
    ASSERT_LT(std::abs(position(0)), 4e-6) << n;  // h v/sin(w' h) = 1.7e-6 m
  }
  world_.constraints[0].axes[0] = spring(1.01 * bound, 0.0);
  EXPECT_EQ(refusals(),
            "the physics step of 1/3000 s integrates the spring 'x' of 'brick' stably only with "
            "stiffness below 7.2e+07 N/m\n");
  start();
  double largest = 0.0;
  for (int n = 0; n < 300; ++n) {
    ticks(1);
    largest = std::max(largest, std::abs(position(0)));
  }
  EXPECT_GT(largest, 1.0);
  world_.constraints[0].axes[0] = spring(1000, 2.0 * kBrickMass / kStep);
  EXPECT_EQ(refusals(),
            "the physics step of 1/3000 s integrates the spring 'x' of 'brick' stably only with "
            "damping below 1.2e+04 N s/m\n");
}

TEST_F(Springs, TheBoundIsOfTheSumAndOfTheLeastInertiaAndOfTheIntegrator) {
  const double bound = 4.0 * kBrickMass / (kStep * kStep);
  aid("one").axes[0] = spring(0.6 * bound, 0.0);
  aid("two").axes[0] = spring(0.6 * bound, 0.0);
  EXPECT_NE(refusals().find("stiffness below 2.88e+07 N/m"), std::string::npos) << refusals();
  // Of one angle alone the spring counts (pi/2)^2 times.
  world_.constraints.clear();
  const double turn = 4.0 * 0.01 / (kStep * kStep);
  aid().axes[3] = spring(0.9 * turn, 0.0);
  EXPECT_NE(refusals().find("stiffness below 1.46e+05 Nm/rad"), std::string::npos) << refusals();
  for (std::size_t k = 3; k < 6; ++k) world_.constraints[0].axes[k] = spring(0.9 * turn, 0.0);
  EXPECT_EQ(refusals(), "");
  // With rk4 an undamped one gains energy.
  world_.physics.integrator = Integrator::rk4;
  world_.constraints.clear();
  aid().axes[0] = spring(2000, 0.0);
  EXPECT_NE(refusals(), "");
  world_.constraints[0].axes[0] = spring(2000);
  EXPECT_EQ(refusals(), "");
}

TEST_F(Springs, AHoldsOwnValuesAreCheckedBesideTheWorlds) {
  model::BodySprings hold;
  hold.body.name = "brick";
  hold.all = true;
  EXPECT_EQ(refusals({hold}), "");
  hold.all = false;
  hold.axes[2] = spring(1e9);
  EXPECT_NE(refusals({hold}), "");
}

// Free fall for 5 cm, then a spring of 3000 N/m with a damping that only ever brakes: energy falls,
// but for a step that tightens the rope before its force begins: k (h v)^2/2.
TEST_F(Springs, AHarnessCatchesAFallingBodyAndNeverGainsEnergy) {
  constexpr double kStiffness = 3000, kSlack = 0.05;
  aid("harness").axes[2] = spring(kStiffness, 300.0);
  world_.constraints[0].axes[2]->travel = {-kSlack, 1.0};
  world_.physics.steps_per_tick = 1;
  robot_.rate_mhz = 3'000'000;
  start();
  double before = kBrickMass * kGravity * 10.0;
  bool caught = false;
  for (int n = 1; n < 15000; ++n) {
    const bool slack = position(2) >= 10.0 - kSlack;
    ticks(1);
    if (slack) {
      ASSERT_EQ(force(2), 0.0) << n;
    } else {
      ASSERT_GE(force(2), 0.0) << n;
    }
    caught = caught || !slack;
    const double fallen = 0.5 * kGravity * kStep * kStep * n * (n + 1);
    if (!caught) {
      ASSERT_NEAR(position(2), 10.0 - fallen, 1e-9) << n;
    }
    const double v = backend_->data()->qvel[2];
    const double stretch = std::max(0.0, 10.0 - kSlack - position(2));
    const double energy =
        kBrickMass * (kGravity * position(2) + 0.5 * v * v) + 0.5 * kStiffness * stretch * stretch;
    ASSERT_LE(energy, before + 0.5 * kStiffness * kStep * kStep * v * v + 1e-12) << n;
    before = energy;
  }
  EXPECT_TRUE(caught);
  EXPECT_NEAR(position(2), 10.0 - kSlack - kBrickMass * kGravity / kStiffness, 1e-9);
}

TEST_F(Springs, ARopeThatSlackensFastDoesNotPush) {
  ActiveAxis rope;
  rope.acts = rope.one_sided = true;
  rope.stiffness = 1000;
  rope.damping = 1000;
  rope.low = -0.1;
  rope.high = 0.2;
  EXPECT_EQ(spring_force(rope, 1.0, 0.15, 1.0), 0.0);  // 5 cm beyond low, on its way back
  EXPECT_DOUBLE_EQ(spring_force(rope, 1.0, 0.15, 0.0), 50.0);
  EXPECT_DOUBLE_EQ(spring_force(rope, 1.0, 0.15, -1.0), 1050.0);
  EXPECT_EQ(spring_force(rope, 1.0, -0.25, -1.0), 0.0);
  EXPECT_DOUBLE_EQ(spring_force(rope, 1.0, -0.25, 0.0), -50.0);
  EXPECT_EQ(spring_force(rope, 1.0, -0.15, 5.0), 0.0);
}

// Roll and pitch are held, yaw is free and goes round several times: the springs must not drive it.
TEST_F(Springs, AnglesThatAreHeldBesideAFreeOneKeepTheEnergy) {
  model::BodySprings& held = aid();
  for (const std::size_t k : {0u, 1u, 2u}) held.axes[k] = spring(20000);
  held.axes[3] = held.axes[4] = spring(20.0, 0.0);
  world_.start.rates = {0.3, 0.2, 4.0};
  start();
  const auto energy = [&] {
    const mjData* d = backend_->data();
    const double* w = d->qvel + 3;
    double sum = 0.5 * (0.01 * w[0] * w[0] + 0.02 * w[1] * w[1] + 0.025 * w[2] * w[2]);
    std::array<double, 3> e{};
    mju_quat2Vel(e.data(), d->qpos + 3, 1.0);
    return sum + 0.5 * 20.0 * (e[0] * e[0] + e[1] * e[1]);
  };
  const double before = energy();
  double most = before, least = before, turned = 0.0;
  for (int n = 0; n < 15000; ++n) {
    ticks(1);
    most = std::max(most, energy());
    least = std::min(least, energy());
    turned += backend_->data()->qvel[5] / 1500.0;
  }
  EXPECT_GT(turned, 4.0 * std::numbers::pi);
  EXPECT_LT(most, 1.02 * before);
  EXPECT_GT(least, 0.98 * before);
}

TEST_F(Springs, AnAnchorMayBeWritten) {
  for (auto& axis : aid().axes) axis = spring(2000);
  world_.constraints[0].axes[1]->at = 0.1;
  for (std::size_t k = 3; k < 6; ++k) world_.constraints[0].axes[k] = spring(20);
  world_.constraints[0].axes[4]->at = -20 * kRadPerDegree;
  world_.constraints[0].axes[5]->at = 30 * kRadPerDegree;
  start();
  ticks(3000);
  EXPECT_NEAR(position(1), 0.1, 1e-9);
  EXPECT_NEAR(position(0), 0.0, 1e-9);
  std::array<double, 9> r{};
  mju_quat2Mat(r.data(), backend_->data()->qpos + 3);
  EXPECT_NEAR(std::atan2(r[3], r[0]), 30 * kRadPerDegree, 1e-6);
  EXPECT_NEAR(std::asin(-r[6]), -20 * kRadPerDegree, 1e-6);
}

// A physics step a tick: the force of the first one is that of the start as it was drawn.
TEST_F(Springs, TheDefaultAnchorIsWhereTheDrawnStartPutsTheBody) {
  robot_ = tests::load_hume();
  world_.start.joints = {0.05, -0.1, 0.2, -0.05, 0.1, 0.3};
  world_.physics.steps_per_tick = 1;
  model::BodySprings& held = aid();
  held.body.name = "torso";
  for (std::size_t k = 0; k < 6; ++k) held.axes[k] = spring(k < 3 ? 20000 : 500);
  start();
  ticks(1);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(force(k), 0.0) << k;
  ticks(300);
  EXPECT_GT(force(2), 0.0);
  backend_->start();
  ticks(1);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(force(k), 0.0) << k;
}

// Without torque Hume folds up; the rope catches its torso 5 cm lower.
TEST_F(Springs, AHarnessCatchesARobotWithoutTorque) {
  robot_ = tests::load_hume();
  aid("harness").axes[2] = spring(3000);
  world_.constraints[0].body.name = "torso";
  world_.constraints[0].axes[2]->travel = {-0.05, 1.0};
  start();
  const double before = position(2);
  double least = before;
  for (int n = 0; n < 7500; ++n) {
    ticks(1);
    least = std::min(least, position(2));
    ASSERT_GE(force(2), 0.0) << n;
    ASSERT_EQ(force(0), 0.0) << n;
  }
  EXPECT_LT(position(2), before - 0.05);
  // At rest it hangs by m g/k = 6.5 cm at most. Critical damping stops it before twice that.
  EXPECT_GT(least, before - 0.05 - 2.0 * 20.0 * kGravity / 3000);
}

TEST_F(Springs, AreAppliedWithoutAllocation) {
  if (!tests::AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  for (auto& axis : aid().axes) axis = spring(2000);
  world_.constraints[0].axes[2]->travel = {-0.05, 1.0};
  start();
  model::BodySprings hold;
  hold.axes[5].emplace();
  const tests::AllocationGuard guard;
  const int number = backend_->hold(1, hold);
  for (int n = 0; n < 100; ++n) backend_->write({});
  backend_->release(number);
  EXPECT_EQ(guard.allocations(), 0);
}

TEST_F(Springs, ABodyThatTheRobotLacksIsRefused) {
  aid().body.name = "brik";
  EXPECT_THROW(start(), std::runtime_error);
}

// m (w^2 (x_held - x) - 2 w v) at the centre of mass, likewise about it: bit for bit.
TEST_F(Springs, AWholeHoldIsCriticallyDampedWithTheHandsOfTheWorld) {
  world_.physics.steps_per_tick = 1;
  world_.start.velocity = {0.1, -0.2};
  world_.start.rates = {0.3, 0.2, -0.1};
  start();
  model::BodySprings whole;
  whole.body.name = "brick";
  whole.all = true;
  const mjData* d = backend_->data();
  const std::array<double, 3> held = {d->xipos[3], d->xipos[4], d->xipos[5]};
  const std::array<double, 4> facing = {d->xquat[4], d->xquat[5], d->xquat[6], d->xquat[7]};
  ASSERT_EQ(backend_->hold(1, whole), 0);
  const double w = 50.0;
  for (int n = 0; n < 500; ++n) {
    std::array<double, 6> velocity{};
    mj_objectVelocity(backend_->model(), d, mjOBJ_BODY, 1, velocity.data(), 0);
    std::array<double, 4> back{}, turn{};
    mju_negQuat(back.data(), d->xquat + 4);
    mju_mulQuat(turn.data(), facing.data(), back.data());
    std::array<double, 3> angle{};
    mju_quat2Vel(angle.data(), turn.data(), 1.0);
    const double inertia =
        std::min({d->qM[backend_->model()->dof_Madr[3]], d->qM[backend_->model()->dof_Madr[4]],
                  d->qM[backend_->model()->dof_Madr[5]]});
    std::array<double, 6> expected{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double behind = held[k] - d->xipos[3 + k];
      expected[k] += kBrickMass * (w * w * behind - 2.0 * w * velocity[3 + k]);
      expected[3 + k] += inertia * (w * w * angle[k] - 2.0 * w * velocity[k]);
    }
    ticks(1);
    for (int k = 0; k < 6; ++k) ASSERT_EQ(force(k), expected[static_cast<std::size_t>(k)]) << n;
  }
}

TEST_F(Springs, AHoldByAxisLeavesTheOthersFree) {
  world_.start.velocity = {0.05, 0.0};
  start();
  model::BodySprings hold;
  hold.body.name = "brick";
  for (const std::size_t k : {0u, 1u, 3u, 4u, 5u}) hold.axes[k].emplace();
  const int number = backend_->hold(1, hold);
  for (int n = 1; n < 300; ++n) {
    ticks(1);
    ASSERT_NEAR(position(2), 10.0 - 0.5 * kGravity * kStep * kStep * 2 * n * (2 * n + 1), 1e-9);
    ASSERT_LT(std::abs(position(0)), 0.05 / (std::numbers::e * 50.0) * 1.02);
    ASSERT_EQ(force(2), 0.0);
  }
  backend_->release(number);
  ticks(1);
  for (int k = 0; k < 6; ++k) EXPECT_EQ(force(k), 0.0);
  std::vector<int> holds;
  for (std::size_t k = 0; k < kMaxHeld; ++k) holds.push_back(backend_->hold(1, hold));
  EXPECT_EQ(holds.back(), static_cast<int>(kMaxHeld) - 1);
  EXPECT_EQ(backend_->hold(1, hold), -1);
}

}  // namespace
}  // namespace footfall::sim
