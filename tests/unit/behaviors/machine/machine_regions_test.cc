// Control where several regions run side by side: what a region without control does changes
// nothing, and a state that is entered again starts anew.
#include <gtest/gtest.h>

#include <cmath>

#include "behaviors/machine/machine.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using tasks::TaskType;

// A region that stands, lifts and lowers; a lamp that `blink` switches, with what it does `more`.
std::string legs_and_lamp(const std::string& more = "") {
  const std::string text = R"(behavior: 1
robot: hume
events: {blink: ""}
machine:
  type: parallel
  states:
    legs:
      states:
        stand:
          contacts: [right_foot, left_foot]
          tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: minimum_jerk, to: 1 m, over: 400 ms}}}
          after: 100 ms
          to: unload
        unload:
          contacts: [right_foot]
          contact_transition: {releases: left_foot, over: 200 ms}
          tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: cosine, to: 0.8 m, over: 150 ms}}}
          after: 200 ms
          to: swing
        swing:
          contacts: [right_foot]
          tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: ellipse, radius: 1 cm, period: 300 ms}}}
          after: 300 ms
          to: load
        load:
          contacts: [right_foot]
          contact_transition: {loads: left_foot, over: 100 ms, toward: both}
          tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: waypoints, points: [{at: 20 ms, to: 0.9 m}, {at: 80 ms, to: 0.95 m}]}}}
          after: 100 ms
          to: stand
    lamp:
      states:
        dark: {transitions: [{on: blink, to: light, internal: true}]}
        light: {transitions: [{on: blink, to: dark, internal: true}]@}
stacks:
  both:
    contacts: [right_foot, left_foot]
    tasks: {h: {type: com_position, axes: [z], priority: 1, gains: {kp: 1}, reference: entry}}
)";
  return std::string(text).replace(text.find('@'), 1, more);
}

void expect_same(const tasks::ControlSet& a, const tasks::ControlSet& b) {
  ASSERT_EQ(a.axis_count, b.axis_count);
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.axis_count); ++k) {
    EXPECT_EQ(a.axes[k].ref, b.axes[k].ref);
    EXPECT_EQ(a.axes[k].ref_vel, b.axes[k].ref_vel);
    EXPECT_EQ(a.axes[k].ref_acc, b.axes[k].ref_acc);
    EXPECT_EQ(a.axes[k].kp, b.axes[k].kp);
    EXPECT_EQ(a.axes[k].fresh, b.axes[k].fresh);
  }
}

TEST(MachineRegions, ARegionWithoutControlLeavesControlToTheLastBitAsItIs) {
  Runner dark(load(legs_and_lamp()), Body::standing);
  Runner blinking(load(legs_and_lamp()), Body::standing);
  const int blink = blinking.behavior->find_event("blink");
  for (Runner* run : {&dark, &blinking}) {
    run->carry_com(2, 0.9);
    run->start();
  }
  int switched = 0, states = 0;
  std::string before;
  for (int k = 0; k < 2500; ++k) {  // more than two rounds, every tick a transition
    blinking.machine.raise(blink);
    dark.tick();
    blinking.tick();
    switched += blinking.machine.transitions_taken().empty() ? 0 : 1;
    const std::string now = dark.active();
    states += now == before ? 0 : 1;
    before = now;
    const tasks::ActiveControl& a = dark.machine.control();
    const tasks::ActiveControl& b = blinking.machine.control();
    expect_same(a.primary, b.primary);
    ASSERT_EQ(a.has_other, b.has_other) << k;
    if (a.has_other) expect_same(a.other, b.other);
    ASSERT_EQ(a.other_weight, b.other_weight) << k;
    ASSERT_EQ(a.transition_entered, b.transition_entered) << k;
    ASSERT_FALSE(HasFailure()) << k << " " << now;
  }
  EXPECT_EQ(switched, 2500);
  EXPECT_GE(states, 9);
}

TEST(MachineRegions, AnotherTaskBesideAContactTransitionStartsNoReferenceAnew) {
  const std::string damping = ", tasks: {d: {type: joint_damping, priority: 2, gains: {kd: 1}}}";
  Runner dark(load(legs_and_lamp(damping)), Body::standing);
  Runner blinking(load(legs_and_lamp(damping)), Body::standing);
  const int blink = blinking.behavior->find_event("blink");
  for (Runner* run : {&dark, &blinking}) {
    run->carry_com(2, 0.9);
    run->start();
  }
  for (int k = 0; k < 1200; ++k) {
    blinking.machine.raise(blink);
    dark.tick();
    blinking.tick();
    EXPECT_EQ(blinking.task("d") != nullptr, k % 2 == 0);
    const tasks::AxisCommand& a = dark.axis("h", 0);
    const tasks::AxisCommand& b = blinking.axis("h", 0);
    ASSERT_EQ(a.ref, b.ref) << k << " " << dark.active();
    ASSERT_EQ(a.ref_vel, b.ref_vel) << k;
    ASSERT_EQ(a.fresh, b.fresh) << k;
    ASSERT_EQ(dark.machine.control().other_weight, blinking.machine.control().other_weight) << k;
  }
}

// `to: stand` from stand: the same tasks, but a new entry.
TEST(MachineRegions, AStateThatIsEnteredAgainStartsItsReferenceAnew) {
  Runner run(
      load("behavior: 1\nrobot: hume\nevents: {again: '', other: ''}\nmachine:\n  contacts: "
           "[right_foot, left_foot]\n  transitions: [{on: other, do: [{mark: m}]}]\n  states:\n"
           "    up:\n      tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: "
           "{trajectory: polynomial, order: 3, to: 1 m, over: 1 s}}}\n"
           "      transitions: [{on: again, to: up}]\n"),
      Body::standing);
  run.carry_com(2, 0.9);
  run.start();
  run.run_to(749);
  run.machine.raise(run.behavior->find_event("other"));  // a transition without exit or entry
  run.tick();
  const double half = run.axis("h", 0).ref;
  EXPECT_NEAR(half, 0.95, 1e-12);  // at half time half the way: 3 s^2 - 2 s^3
  run.machine.raise(run.behavior->find_event("again"));
  run.tick();
  ASSERT_EQ(run.machine.transitions_taken().size(), 1U);
  EXPECT_EQ(run.axis("h", 0).ref, half);  // from where it was, one second from now
  EXPECT_FALSE(run.axis("h", 0).fresh);
  run.run_to(1500);
  EXPECT_LT(run.axis("h", 0).ref, 0.9999);
  run.run_to(751 + 1500);
  EXPECT_NEAR(run.axis("h", 0).ref, 1.0, 1e-12);
}

}  // namespace
}  // namespace footfall::tests
