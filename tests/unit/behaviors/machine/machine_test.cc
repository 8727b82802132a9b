// Control in a state: merged stacks, references that never jump, contact transitions.
#include "behaviors/machine/machine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/allocation_guard.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using tasks::TaskType;

std::unique_ptr<behaviors::Behavior> balance() {
  core::Diagnostics diagnostics;
  auto behavior = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  if (behavior == nullptr) throw std::runtime_error(diagnostics.to_string());
  return behavior;
}

std::unique_ptr<behaviors::Behavior> hume(const std::string& text) {
  return load("behavior: 1\nrobot: hume\n" + text);
}

// Balance, let go at 5.5 s, so that the first stride begins at tick 8250.
class Balance : public testing::Test {
 protected:
  Balance() : run(balance(), Body::standing) {
    run.signal("com.pos.z") = 0.9;
    run.signal("contact.right_foot") = run.signal("contact.left_foot") = 1.0;
    run.carry_com(2, 0.84);
    run.start();
    run.run_to(8249);
    run.machine.raise(run.behavior->find_event("start"));
    run.tick();
  }
  Runner run;
};

TEST_F(Balance, RisesOnAMinimumJerkPathFromWhatIsMeasured) {
  Runner rise(balance(), Body::standing);
  rise.carry_com(2, 0.84);
  rise.start();
  rise.tick();
  EXPECT_EQ(rise.active(), "rise");
  EXPECT_DOUBLE_EQ(rise.axis("height", 0).ref, 0.84);
  EXPECT_EQ(rise.axis("height", 0).kp, 270.0);
  rise.run_to(4125);  // half of 5.5 s
  EXPECT_NEAR(rise.axis("height", 0).ref, 0.875, 1e-12);
  rise.run_to(8251);
  EXPECT_DOUBLE_EQ(rise.axis("height", 0).ref, 0.91);
}
TEST_F(Balance, StartsItsStrideWithAMarkAndTheHeightThatIsMeasured) {
  EXPECT_EQ(run.active(), "step.right_foot.dual");
  ASSERT_EQ(run.machine.marks().size(), 1u);
  EXPECT_EQ(run.machine.marks()[0], run.behavior->step);
  EXPECT_EQ(run.axis("height", 0).ref, 0.9);
  EXPECT_EQ(run.signal("steps"), 1.0);
}
TEST_F(Balance, KeepsItsPhasesToTheTick) {
  // 16 ms, 24 ms and 145 ms at 1500 Hz are 24, 36 and 218 periods.
  run.run_to(8250 + 23);
  EXPECT_EQ(run.active(), "step.right_foot.dual");
  run.tick();
  EXPECT_EQ(run.active(), "step.right_foot.unload");
  run.run_to(8250 + 24 + 35);
  EXPECT_EQ(run.active(), "step.right_foot.unload");
  run.tick();
  EXPECT_EQ(run.active(), "step.right_foot.lift");
  run.run_to(8250 + 24 + 36 + 217);
  EXPECT_EQ(run.active(), "step.right_foot.lift");
  run.signal("contact.left_foot") = 0.0;
  run.tick();
  EXPECT_EQ(run.active(), "step.right_foot.land");
}
TEST_F(Balance, TouchdownEndsLandingAndTheOtherFootFollows) {
  run.signal("contact.left_foot") = 0.0;
  run.run_to(8250 + 24 + 36 + 218 + 10);
  EXPECT_EQ(run.active(), "step.right_foot.land");
  run.signal("contact.left_foot") = 1.0;
  run.tick();
  EXPECT_EQ(run.active(), "step.right_foot.load");
  run.run_to(run.now + 35);
  EXPECT_EQ(run.active(), "step.left_foot.dual");  // in the tick in which loading ends
  EXPECT_EQ(run.signal("steps"), 2.0);
}
TEST_F(Balance, AMissingTouchdownEndsLandingByTime) {
  run.signal("contact.left_foot") = 0.0;
  const std::int64_t land = 8250 + 24 + 36 + 218;
  run.run_to(land + 337);  // 1.5 x 150 ms = 337.5 periods, rounded up
  EXPECT_EQ(run.active(), "step.right_foot.land");
  run.tick();
  EXPECT_EQ(run.active(), "step.right_foot.load");
}
TEST_F(Balance, ReleasesWithTheWholeWeightOfTheLawJustLeft) {
  run.run_to(8250 + 24);
  const tasks::ActiveControl& control = run.machine.control();
  ASSERT_TRUE(control.has_other);
  EXPECT_TRUE(control.transition_entered);
  EXPECT_EQ(control.other_weight, 1.0);
  EXPECT_EQ(control.other.contact_count, 2);
  EXPECT_EQ(control.primary.contact_count, 1);
  EXPECT_EQ(control.moving_contact_count, 1);
  EXPECT_EQ(control.moving_contacts[0], run.behavior->robot.find_contact("left_foot"));
  const tasks::TaskCommand* height = run.task("height", control.other);
  ASSERT_TRUE(height);
  EXPECT_FALSE(height->fresh);
  EXPECT_EQ(control.other.axes[static_cast<std::size_t>(height->first_axis)].ref, 0.9);
  run.run_to(8250 + 24 + 18);
  EXPECT_FALSE(control.transition_entered);
  EXPECT_NEAR(control.other_weight, 0.5, 1e-12);
  run.run_to(8250 + 24 + 36);
  EXPECT_FALSE(control.has_other);
}
TEST_F(Balance, LoadsTowardTheLawToComeFromNoWeight) {
  run.signal("contact.left_foot") = 0.0;
  run.run_to(8250 + 24 + 36 + 218);
  run.signal("contact.left_foot") = 1.0;
  run.tick();
  ASSERT_EQ(run.active(), "step.right_foot.load");
  const tasks::ActiveControl& control = run.machine.control();
  ASSERT_TRUE(control.has_other);
  EXPECT_EQ(control.other_weight, 0.0);
  EXPECT_EQ(control.primary.contact_count, 1);
  EXPECT_EQ(control.other.contact_count, 2);
  EXPECT_EQ(run.task("attitude", control.other)->axis_count, 3);
  EXPECT_EQ(run.task("attitude", control.primary)->axis_count, 2);
  run.run_to(run.now + 17);  // 18 of 36 periods
  EXPECT_NEAR(control.other_weight, 0.5, 1e-12);
  run.run_to(run.now + 16);
  EXPECT_GT(control.other_weight, 0.99);
  EXPECT_LT(control.other_weight, 1.0);
}
TEST_F(Balance, ATaskThatWasInForceIsKeptAnotherIsFresh) {
  run.run_to(8250 + 24);
  EXPECT_TRUE(run.task("swing")->fresh);
  EXPECT_FALSE(run.task("height")->fresh);
  EXPECT_FALSE(run.task("attitude")->fresh);
  run.tick();
  EXPECT_FALSE(run.task("swing")->fresh);
}
TEST_F(Balance, TheSwingFootIsHeldThenLiftedFromWhereItWasHeld) {
  const int left = run.behavior->robot.find_contact("left_foot");
  run.carry_point(left, 1, 0.1);
  run.carry_point(left, 2, 0.01);
  run.run_to(8250 + 24);
  run.carry_point(left, 2, 0.02);  // it sags: the reference does not
  run.run_to(8250 + 24 + 36);
  ASSERT_EQ(run.active(), "step.right_foot.lift");
  EXPECT_NEAR(run.axis("swing", 2).ref, 0.01, 1e-12);
  EXPECT_EQ(run.axis("swing", 0).kp, 220.0);
  run.run_to(8250 + 24 + 36 + 217);
  EXPECT_NEAR(run.axis("swing", 2).ref, 0.07, 1e-5);
  EXPECT_NEAR(run.axis("swing", 1).ref, 0.1, 1e-15);
}
TEST_F(Balance, NothingIsAllocatedThroughEveryState) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "sanitizers allocate themselves";
  std::vector<std::string> seen;
  const AllocationGuard guard;
  for (int k = 0; k < 3000; ++k) {
    const bool up = k % 700 > 100 && k % 700 < 350;
    run.signals[run.behavior->layout.contact[0]] = up && (k / 700) % 2 == 1 ? 0.0 : 1.0;
    run.signals[run.behavior->layout.contact[1]] = up && (k / 700) % 2 == 0 ? 0.0 : 1.0;
    if (k == 2900) run.machine.enter_safe();
    run.tick();
    for (const auto& request : run.machine.plan_requests()) {
      run.machine.deliver({request.planner, request.sequence, true, {0.1, 0.1, 0.0}, {}, {}, 0.0});
    }
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(run.active(), "limp");
}
TEST_F(Balance, AFaultWithThatReactionEntersTheSafeState) {
  run.machine.raise_fault(core::Fault::imu_stale, core::Reaction::keep_going);
  run.tick();
  EXPECT_EQ(run.active(), "step.right_foot.dual");
  run.machine.raise_fault(core::Fault::fall, core::Reaction::safe_state);
  run.tick();
  EXPECT_EQ(run.active(), "limp");
  EXPECT_EQ(run.machine.control().primary.contact_count, 0);
  EXPECT_EQ(run.machine.control().primary.task_count, 1);
  EXPECT_EQ(run.axis("rest", 0).kd, 5.0);
  EXPECT_EQ(run.task("rest")->priority, 1);
}
TEST_F(Balance, GainsAreLive) {
  run.parameter("gains.dual.height.kp") = 300.0;
  run.tick();
  EXPECT_EQ(run.axis("height", 0).kp, 300.0);
}

TEST(Machine, AKeptReferenceMovesOnWithoutAJump) {
  Runner run(hume(R"(
gains: {g: {h: {kp: 1}}}
stacks: {s: {gains: g, tasks: {h: {type: com_position, axes: [z], reference: {trajectory: hold}}}}}
machine:
  stack: s
  states:
    a: {after: 50 ms, to: b, tasks: {h: {reference: {trajectory: polynomial, order: 3, to: 1 m, over: 100 ms}}}}
    b: {tasks: {h: {reference: {trajectory: polynomial, order: 5, to: 0 m, over: 100 ms}}}}
)"));
  run.start();
  run.tick();
  double before = run.axis("h", 0).ref, before_vel = run.axis("h", 0).ref_vel;
  for (int k = 1; k < 300; ++k) {
    run.tick();
    const auto& axis = run.axis("h", 0);
    // The cubic's largest speed is 1.5 m / 0.1 s; the quintic back starts at 15 m/s: below 40 m/s.
    EXPECT_LT(std::abs(axis.ref - before), 40.0 / 1500.0) << k;
    EXPECT_LT(std::abs(axis.ref_vel - before_vel), 2.0) << k;
    before = axis.ref;
    before_vel = axis.ref_vel;
  }
  EXPECT_NEAR(before, 0.0, 1e-12);
}
TEST(Machine, ATrajectoryGoesOnWhileAnotherRegionChanges) {
  Runner run(hume(R"(
machine:
  type: parallel
  states:
    move: {tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: minimum_jerk, to: 1 m, over: 100 ms}}}}
    tick:
      states:
        a: {after: 10 ms, to: b}
        b: {after: 10 ms, to: a, tasks: {r: {type: joint_damping, gains: {kd: 1}}}}
)"));
  run.start();
  run.run_to(75);  // 50 ms, half way
  EXPECT_NEAR(run.axis("h", 0).ref, 0.5, 1e-12);
}
TEST(Machine, AStateEnteredAgainStartsItsTrajectoryAnew) {
  Runner run(hume(R"(
events: {again: x}
machine:
  states:
    a:
      transitions: [{on: again, to: a}]
      tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: polynomial, order: 3, to: "= entry + 1 m", over: 10 ms}}}
)"));
  run.start();
  run.run_to(20);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 1.0);
  run.machine.raise(run.behavior->find_event("again"));
  run.run_to(40);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 2.0);
}
TEST(Machine, RetargetFollowsAChangingGoalWithinTheTimeLeft) {
  Runner run(hume(R"(
parameters: {to: {value: 1 m, range: [0 m, 9 m], live: true}}
machine:
  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: polynomial, order: 3, to: $to, over: 100 ms, retarget: true}}}
)"));
  run.start();
  run.run_to(60);
  run.parameter("to") = 1.5;
  const double before = run.axis("h", 0).ref, speed = run.axis("h", 0).ref_vel;
  run.tick();
  // One period on: the cubic's speed goes on, its largest acceleration is 6 x 2 m / (60 ms)².
  EXPECT_NEAR(run.axis("h", 0).ref, before + speed / 1500.0,
              6 * 2 / 0.0036 / (2 * 1500.0 * 1500.0));
  run.run_to(150);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 1.5);
}
TEST(Machine, RetargetEndsAtThePartOfTheTimeThatIsGiven) {
  Runner run(hume(R"(
parameters: {to: {value: 1 m, range: [0 m, 9 m], live: true}}
machine:
  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: polynomial, order: 3, to: $to, over: 100 ms, retarget: 50 %}}}
)"));
  run.start();
  run.run_to(80);  // 80 of 150 ticks: past the half
  run.parameter("to") = 1.5;
  run.run_to(160);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 1.0);
}
TEST(Machine, WithoutRetargetTheGoalIsReadAtEntry) {
  Runner run(hume(R"(
parameters: {to: {value: 1 m, range: [0 m, 9 m], live: true}}
machine:
  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: polynomial, order: 3, to: $to, over: 100 ms}}}
)"));
  run.start();
  run.run_to(60);
  run.parameter("to") = 1.5;
  run.run_to(150);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 1.0);
}
TEST(Machine, TheEndVelocityIsKeptOn) {
  Runner run(hume(R"(
machine:
  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: polynomial, order: 3, to: 1 m, over: 100 ms, end_velocity: -0.3 m/s}}}
)"));
  run.start();
  run.run_to(300);  // 200 ms: 100 ms after its end
  EXPECT_NEAR(run.axis("h", 0).ref, 0.97, 1e-12);
  EXPECT_EQ(run.axis("h", 0).ref_vel, -0.3);
}
TEST(Machine, AReferenceThatIsNotFiniteKeepsTheLastAndRaisesAnError) {
  Runner run(hume(R"(
parameters: {d: {value: 1, range: [0, 1], live: true}}
machine:
  transitions: [{on: error.execution, to: caught}]
  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: "= 2 m/$d"}}
  states: {a: {}, caught: {}}
)"));
  run.start();
  run.tick();
  EXPECT_EQ(run.axis("h", 0).ref, 2.0);
  run.parameter("d") = 0.0;
  run.tick();
  EXPECT_EQ(run.axis("h", 0).ref, 2.0);
  run.tick();
  EXPECT_EQ(run.active(), "caught");
}
TEST(Machine, TheInnermostStackHoldsAndOverlaysGoOverItOuterBeforeInner) {
  Runner run(hume(R"(
gains: {g: {h: {kp: 1}}}
stacks:
  one: {gains: g, contacts: [right_foot], tasks: {h: {type: com_position, axes: [z], reference: 1 m}}}
  two: {gains: g, contacts: [left_foot], tasks: {h: {type: com_position, axes: [z], reference: 2 m}}}
machine:
  stack: one
  states:
    a: {after: 10 ms, to: b, contacts: [right_foot, left_foot]}
    p: {tasks: {h: {reference: 3 m}}, states: {b: {stack: two, after: 10 ms, to: c}, c: {tasks: {h: {reference: 4 m}}}}}
)"));
  run.start();
  run.tick();
  EXPECT_EQ(run.machine.control().primary.contact_count, 2);
  EXPECT_EQ(run.axis("h", 0).ref, 1.0);
  run.run_to(15);
  EXPECT_EQ(run.machine.control().primary.contacts[0],
            run.behavior->robot.find_contact("left_foot"));
  EXPECT_EQ(run.axis("h", 0).ref, 3.0);
  run.run_to(30);
  EXPECT_EQ(run.machine.control().primary.contacts[0],
            run.behavior->robot.find_contact("right_foot"));
  EXPECT_EQ(run.axis("h", 0).ref, 4.0);
}
TEST(Machine, ContactEdgesAreEvents) {
  Runner run(hume(R"(
machine:
  states:
    a: {transitions: [{on: contact.left_foot.liftoff, to: b}]}
    b: {transitions: [{on: contact.left_foot.touchdown, to: c}]}
    c: {}
)"));
  run.signal("contact.left_foot") = 1.0;
  run.start();
  run.tick();
  EXPECT_EQ(run.active(), "a");
  run.signal("contact.left_foot") = 0.0;
  run.tick();
  EXPECT_EQ(run.active(), "b");
  run.signal("contact.left_foot") = 1.0;
  run.tick();
  EXPECT_EQ(run.active(), "c");
}
TEST(Machine, AnEditFromOutsideIsAnEvent) {
  Runner run(hume(R"(
parameters: {k: {value: 1, range: [0, 9], live: true}}
machine: {states: {a: {transitions: [{on: parameter.changed.k, to: b}]}, b: {}}}
)"));
  run.start();
  run.tick();
  EXPECT_EQ(run.active(), "a");
  run.parameter("k") = 2.0;
  run.tick();
  EXPECT_EQ(run.active(), "b");
}
TEST(Machine, InternalForcesAreGivenAtEachContact) {
  Runner run(
      hume("machine: {contacts: [right_foot, left_foot], internal: {tension: {between: "
           "[right_foot, left_foot], reference: 100 N, feedback: 1.5, convention: sum}}}"));
  run.start();
  run.tick();
  const tasks::ControlSet& set = run.machine.control().primary;
  ASSERT_EQ(set.internal_count, 1);
  EXPECT_EQ(set.internals[0].reference, 50.0);
  EXPECT_EQ(set.internals[0].feedback, 1.5);
}
TEST(Machine, TheFrozenFormIsPassedOn) {
  Runner run(hume(
      "machine:\n  contacts: [right_foot, left_foot]\n  states:\n    a: {after: 10 ms, to: b}\n"
      "    b: {contacts: [right_foot], contact_transition: {releases: left_foot, over: 20 ms, "
      "form: frozen}}\n"));
  run.start();
  run.run_to(15);
  EXPECT_EQ(run.machine.control().form, tasks::TransitionForm::frozen);
  EXPECT_EQ(run.machine.control().other.contact_count, 2);
}

}  // namespace
}  // namespace footfall::tests
