// Forces in a run: what the control law predicts against what the simulator's ground does, and the
// feedback of internal forces around the simulator's own actuator.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "engine/tick/control_loop.h"
#include "sim/mujoco_backend.h"
#include "tests/support/fake_robot.h"

namespace footfall::tests {
namespace {

// Both feet pushed apart; the height by `reference`; `states` of the machine.
std::string standing(const std::string& reference, const std::string& states = "{stand: {}}",
                     double feedback = 0.0) {
  return fmt::format(R"(
behavior: 1
robot: hume
machine:
  contacts: [right_foot, left_foot]
  tasks:
    height: {{type: com_position, axes: [z], priority: 1, gains: {{kp: 270, kd: 10}}, reference: {}}}
    attitude: {{type: body_orientation, priority: 1, gains: {{kp: 200, kd: 15}}, reference: 0}}
    rest: {{type: joint_damping, priority: 2, gains: {{kd: 2}}}}
  internal: {{tension: {{between: [right_foot, left_foot], reference: 20 N, feedback: {}, bandwidth: 0 Hz}}}}
  states: {}
)",
                     reference, feedback, states);
}

struct SimRig {
  explicit SimRig(const std::string& text)
      : behavior(load_inline(text)),
        backend(behavior->robot, sim::WorldDescription()),
        hardware(backend) {}
  std::unique_ptr<behaviors::Behavior> behavior;
  sim::MujocoBackend backend;
  Meddler hardware;
  engine::ControlLoop loop{*behavior, hardware, {}};
};

// Largest difference of a component of a foot's force between prediction and the ground after it,
// from 0.1 s on: the drop onto a soft ground has ended by then (time constant 1 ms).
double misprediction(const std::string& text, int ticks) {
  SimRig rig(text);
  rig.loop.start();
  double largest = 0.0;
  for (int k = 0; k < ticks; ++k) {
    const auto predicted = rig.loop.controller().result().force;
    rig.loop.tick();
    for (std::size_t foot = 0; k > 150 && foot < 2; ++foot) {
      for (std::size_t i = 0; i < 3; ++i) {
        largest =
            std::max(largest, std::abs(rig.loop.sensors().force[foot][i] - predicted[foot][i]));
      }
    }
  }
  return largest;
}

// The ground lags by its time constant of 1 ms behind a force that changes: with 10 N in 0.1 s that
// is 0.1 N; the bar is 1 % of a foot's share of the weight (98 N).
TEST(ContactForce, AForceThatTheLawPredictsIsTheOneThatTheGroundHas) {
  EXPECT_LT(misprediction(standing("entry"), 900), 1.0);
  EXPECT_LT(misprediction(
                standing("{trajectory: minimum_jerk, to: \"= entry - 3 cm\", over: 400 ms}"), 900),
            1.0);
}

TEST(ContactForce, AndBesideARegionThatDoesSomethingElse) {
  EXPECT_LT(
      misprediction(standing("entry",
                             "{both: {type: parallel, states: {nod: {tasks: {attitude: "
                             "{reference: {trajectory: minimum_jerk, to: [0, 2 deg, 0], over: "
                             "400 ms}}}}, clock: {states: {a: {after: 30 ms, to: b}, b: "
                             "{after: 30 ms, to: a}}}}}}"),
                    900),
      1.0);
}

TEST(ContactForce, AndNearlyStraightLegs) {
  EXPECT_LT(misprediction(
                standing("{trajectory: minimum_jerk, to: \"= entry + 6 cm\", over: 500 ms}"), 800),
            1.0);
}

constexpr int kCause = 300;  // the tick from which one hip gets 2 Nm too much

// The tension in the ground's own force in the 8 ticks after kCause.
std::array<double, 8> tensions(double feedback, double torque_error) {
  SimRig rig(standing("entry", "{stand: {}}", feedback));
  rig.hardware.add = [torque_error](hal::Commands& commands, std::int64_t tick) {
    if (tick >= kCause) commands.tau[0] += torque_error;
  };
  rig.loop.start();
  std::array<double, 8> out{};
  for (int k = 0; k <= kCause + 8; ++k) {
    rig.loop.tick();
    const auto& f = rig.loop.sensors().force;
    if (k > kCause) out[static_cast<std::size_t>(k - kCause - 1)] = 0.5 * (f[0][1] - f[1][1]);
  }
  return out;
}

// Without feedback the error d stays for these 5 ms, in which the robot hardly moves. With it the
// command answers the torque of the tick before: d (1 - (-K)^n)/(1 + K) after n ticks. That the
// ground takes its time leaves 0.2 % of d.
TEST(ContactForce, FeedbackLeavesOneOverOnePlusItsGainOfAnActuatorsError) {
  const double d = tensions(0.0, 2.0)[0] - 20.0;
  EXPECT_GT(std::abs(d), 1.0);
  for (const double gain : {0.0, 0.5, 0.8}) {
    for (const double still : tensions(gain, 0.0)) EXPECT_NEAR(still, 20.0, 0.01);
    const auto found = tensions(gain, 2.0);
    for (int n = 1; n <= 8; ++n) {
      const double left = d * (1.0 - std::pow(-gain, n)) / (1.0 + gain);
      EXPECT_NEAR(found[static_cast<std::size_t>(n - 1)] - 20.0, left, 0.01 * std::abs(d)) << n;
    }
  }
}

}  // namespace
}  // namespace footfall::tests
