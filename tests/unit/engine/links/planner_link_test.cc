// Requests and answers in lock-step, and the velocity that planners see.
#include "engine/links/planner_link.h"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/tick/signals.h"
#include "tests/support/fake_robot.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

// Asks in every tick for the step that would be taken now: the plan's predicted velocity is then
// the velocity that the planner was given.
std::string asking(const std::string& filter) {
  return "behavior: 1\nrobot: hume\nplanners:\n  foot: {type: velocity_reversal, kappa: 0.4, "
         "reversal: 185 ms" +
         filter +
         "}\nmachine:\n  states:\n    a:\n      contacts: [right_foot]\n      invoke: [{planner: "
         "foot, at: 0 ms, every: 0.6 ms, with: {stance: right_foot, swing: left_foot, switch_in: "
         "0 s}}]\n";
}

struct Link {
  explicit Link(int latency, const std::string& filter = "")
      : behavior(load_inline(asking(filter))),
        signals(behavior->signals),
        model(behavior->robot),
        writer(*behavior, signals),
        machine(*behavior, signals, &model),
        planners(*behavior, latency) {
    state = standing_state(behavior->robot);
    measure();
    machine.start();
  }
  void tick() {
    measure();
    planners.deliver(now, machine);
    machine.tick(now);
    planners.post(now, machine);
    ++now;
  }
  void measure() {
    model.update(state);
    writer.write_measured(0.0, model, {}, {});
  }
  double predicted(int axis) const {
    return signals[behavior->layout.planner[0].predicted_vel + axis];
  }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  model::ControlModel model;
  engine::SignalWriter writer;
  behaviors::Machine machine;
  engine::PlannerLink planners;
  model::State state;
  std::int64_t now = 0;
};

TEST(PlannerLink, AnAnswerArrivesExactlyTheLatencyLater) {
  for (const int latency : {1, 2, 3, 4}) {
    Link link(latency);
    for (int k = 0; k < 60; ++k) {
      link.state.v_WB[0] = 0.001 * k;  // each tick has its own velocity
      link.tick();
      // The answer that came at tick k is of the state at tick k - latency.
      EXPECT_NEAR(link.predicted(0), k < latency ? 0.0 : 0.001 * (k - latency), 1e-12) << k;
    }
  }
}

TEST(PlannerLink, ALatencyOfNothingIsOneTick) {
  Link link(0);
  link.state.v_WB[0] = 0.3;
  link.tick();
  EXPECT_EQ(link.predicted(0), 0.0);
  link.tick();
  EXPECT_NEAR(link.predicted(0), 0.3, 1e-12);
}

TEST(PlannerLink, TheVelocityFilterFollowsAPendulumWithoutLag) {
  Link link(1, ", velocity_filter: 50 ms");
  const double period = link.behavior->robot.period_s();
  const auto& com = link.model.com().position;
  const auto& foot = link.model.point(0).position;
  // CoM and stance foot move together, accelerating as the pendulum of this offset does.
  const double rate = 9.81 / (com[2] - foot[2]);
  const std::array<double, 2> a = {rate * (com[0] - foot[0]), rate * (com[1] - foot[1])};
  ASSERT_GT(std::abs(a[1]), 1.0);
  for (int k = 0; k < 1500; ++k) {
    const double t = k * period;
    for (std::size_t i = 0; i < 2; ++i) {
      link.state.v_WB[i] = a[i] * t;
    }
    link.tick();
    if (k < 1) continue;
    // e' = (1 - dt/τ) e + dt² a/τ: the error of the discrete filter is below dt |a|, where a plain
    // low-pass would lag by τ |a|, 75 times as much. The answer seen is of the tick before.
    const double asked = (k - 1) * period;
    for (int i = 0; i < 2; ++i) {
      const double acceleration = a[static_cast<std::size_t>(i)];
      EXPECT_NEAR(link.predicted(i), acceleration * asked,
                  1.001 * period * std::abs(acceleration) + 1e-12);
    }
  }
}

TEST(PlannerLink, TheVelocityFilterAveragesNoiseAway) {
  constexpr double kNoise = 0.2;  // m/s, alternating
  Link link(1, ", velocity_filter: 50 ms");
  const double period = link.behavior->robot.period_s();
  double least = 1e9, most = -1e9;
  for (int k = 0; k < 600; ++k) {
    // Forward, the CoM of a standing Hume is over its feet: nothing else moves the estimate much.
    link.state.v_WB[0] = k % 2 == 0 ? kNoise : -kNoise;
    link.tick();
    if (k < 500) continue;
    least = std::min(least, link.predicted(0));
    most = std::max(most, link.predicted(0));
  }
  EXPECT_LT(most - least, 2.0 * kNoise * period / 0.05 * 1.01);
}

TEST(PlannerLink, WithoutAFilterThePlannerSeesWhatIsMeasured) {
  Link link(1);
  link.state.v_WB = {0.3, -0.2, 0.1};
  link.tick();
  link.tick();
  EXPECT_NEAR(link.predicted(0), 0.3, 1e-12);
  EXPECT_NEAR(link.predicted(1), -0.2, 1e-12);
}

// What is due while planners are dropped is lost; what is asked then and due later comes.
TEST(PlannerLink, DroppedPlannersDoNotAnswer) {
  Link link(2);
  for (int k = 0; k < 30; ++k) {
    link.planners.drop(k >= 10 && k < 20);
    link.state.v_WB[0] = 0.001 * k;
    link.tick();
    const int asked = k < 10 ? k - 2 : k < 20 ? 7 : k - 2;
    EXPECT_NEAR(link.predicted(0), k < 2 ? 0.0 : 0.001 * asked, 1e-12) << k;
  }
}

}  // namespace
}  // namespace footfall::tests
