// References at run time, sentence by sentence of docs/behaviors.md 8.9 and 3.4: what starts
// where, what is kept, what is read when; ellipses, waypoints and surfaces.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "behaviors/machine/machine.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using tasks::TaskType;

constexpr double kPeriod = 1.0 / 1500.0;

// One height task of Hume under a root with this reference.
std::string height(const std::string& reference, const std::string& more = "",
                   const std::string& head = "") {
  return "behavior: 1\nrobot: hume\n" + head +
         "machine:\n  contacts: [right_foot, left_foot]\n"
         "  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: " +
         reference + "}}\n" + more;
}

// Velocity and acceleration are the derivatives of the position, tick by tick: central differences
// of one period miss period²/6 of the third derivative, of which `third` is a bound.
void expect_feed_forward(Runner& run, const std::string& task, int axis, int ticks, double third) {
  tasks::AxisCommand before = run.axis(task, axis);
  run.tick();
  tasks::AxisCommand now = run.axis(task, axis);
  const double tolerance = third * kPeriod * kPeriod / 6.0 + 1e-9;
  for (int k = 0; k < ticks; ++k) {
    run.tick();
    const tasks::AxisCommand after = run.axis(task, axis);
    EXPECT_NEAR(now.ref_vel, (after.ref - before.ref) / (2 * kPeriod), tolerance) << k;
    EXPECT_NEAR(now.ref_acc, (after.ref_vel - before.ref_vel) / (2 * kPeriod), third * kPeriod)
        << k;
    before = now;
    now = after;
  }
}

TEST(MachineReference, AnEllipseGrowsFromTheValueAtEntryAboutIt) {
  Runner run(load(height("{trajectory: ellipse, radius: 4 cm, period: 400 ms, ramp: 200 ms}")),
             Body::standing);
  run.carry_com(2, 0.9);
  run.start();
  run.tick();
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 0.9);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref_vel, 0.0);
  // Third derivative: at most radius (2 pi/T)³ plus what the ramp adds (60/ramp³, 10/ramp² ...).
  expect_feed_forward(run, "h", 0, 700, 2000.0);
  run.run_to(1200);  // two periods: at its far point
  EXPECT_NEAR(run.axis("h", 0).ref, 0.94, 1e-12);
  run.run_to(1500);  // half a period later: the opposite one
  EXPECT_NEAR(run.axis("h", 0).ref, 0.86, 1e-12);
}

TEST(MachineReference, TheSecondAxisOfAnEllipseIsAQuarterBehind) {
  const std::string text =
      "behavior: 1\nrobot: hume\nmachine:\n  tasks: {c: {type: com_position, axes: [x, z], gains: "
      "{kp: 1}, reference: {trajectory: ellipse, radius: {x: 3 cm, z: 2 cm}, period: 1 s, ramp: "
      "100 ms";
  for (const double direction : {1.0, -1.0}) {
    Runner run(load(text + (direction > 0 ? "}}}\n" : ", direction: negative}}}\n")));
    run.start();
    run.run_to(1500 + 200);
    const double angle = direction * 2.0 * std::numbers::pi * 1700.0 / 1500.0;
    EXPECT_NEAR(run.axis("c", 0).ref, 0.03 * std::cos(angle), 1e-12);
    EXPECT_NEAR(run.axis("c", 1).ref, 0.02 * std::sin(angle), 1e-12);
  }
}

TEST(MachineReference, AnEllipseThatChangesItsPeriodDoesNotJump) {
  Runner run(load(height("{trajectory: ellipse, radius: 4 cm, period: $p, ramp: 100 ms}", "",
                         "parameters: {p: {value: 1 s, range: [0.1 s, 2 s], live: true}}\n")));
  run.start();
  run.run_to(2000);
  const double before = run.axis("h", 0).ref;
  run.parameter("p") = 0.5;
  run.tick();
  EXPECT_NEAR(run.axis("h", 0).ref, before, 0.04 * 4.0 * std::numbers::pi * kPeriod);
}

TEST(MachineReference, TheCentreOfAnEllipseMayMove) {
  Runner run(
      load(height("{trajectory: ellipse, radius: 4 cm, period: 1 s, to: 1 m, over: 2 s, "
                  "phase: 90 deg}")));
  run.start();
  run.run_to(6000);  // four periods: cos(90 deg) = 0
  EXPECT_NEAR(run.axis("h", 0).ref, 1.0, 1e-12);
}

TEST(MachineReference, WaypointsArePassedInTimeAndSmoothly) {
  Runner run(load(height("{trajectory: waypoints, over: 300 ms, end_velocity: 0.1 m/s, points: "
                         "[{at: 100 ms, to: 0.95 m}, {at: 70 %, to: 0.92 m}, {to: 0.9 m}]}")),
             Body::standing);
  run.carry_com(2, 0.9);
  run.start();
  run.tick();
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 0.9);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref_vel, 0.0);
  run.run_to(150);
  EXPECT_NEAR(run.axis("h", 0).ref, 0.95, 1e-12);
  run.run_to(315);
  EXPECT_NEAR(run.axis("h", 0).ref, 0.92, 1e-12);
  run.run_to(450);
  EXPECT_NEAR(run.axis("h", 0).ref, 0.9, 1e-12);
  EXPECT_NEAR(run.axis("h", 0).ref_vel, 0.1, 1e-12);
  run.run_to(600);
  EXPECT_NEAR(run.axis("h", 0).ref, 0.91, 1e-12);
  Runner smooth(
      load(height("{trajectory: waypoints, points: [{over: 100 ms, to: 0.95 m}, "
                  "{over: 100 ms, to: 0.92 m}, {over: 100 ms, to: 0.9 m}]}")));
  smooth.start();
  smooth.tick();
  // A quintic of 0.95 m in 0.1 s: third derivative up to 60 d/T³ (1 + the neighbours' share) < 2e5.
  expect_feed_forward(smooth, "h", 0, 440, 2e5);
}

TEST(MachineReference, AnAxisThatAPointDoesNotNameGoesOnToItsNext) {
  Runner run(
      load("behavior: 1\nrobot: hume\nmachine:\n  tasks: {c: {type: com_position, axes: [x, y, z], "
           "gains: "
           "{kp: 1}, reference: {trajectory: waypoints, points: [{at: 50 ms, to: {z: 6 cm}}, "
           "{at: 100 ms, to: {x: 20 cm, z: 0 m}}]}}}\n"));
  run.start();
  run.run_to(75);
  EXPECT_NEAR(run.axis("c", 0).ref, 0.1, 1e-12);  // half way of a symmetric quintic
  EXPECT_EQ(run.axis("c", 1).ref, 0.0);
  EXPECT_NEAR(run.axis("c", 2).ref, 0.06, 1e-12);
}

TEST(MachineReference, NewTrajectoriesTakeOverPlaceAndSpeed) {
  const char* shapes[] = {
      "{trajectory: ellipse, radius: 2 cm, period: 1 s, ramp: 200 ms}",
      "{trajectory: waypoints, points: [{at: 100 ms, to: 1 m}, {at: 300 ms, to: 0.5 m}]}",
      "{trajectory: surface, to: 0.9 m, over: 300 ms}"};
  for (const char* shape : shapes) {
    Runner run(
        load("behavior: 1\nrobot: hume\nmachine:\n  tasks: {h: {type: com_position, axes: "
             "[z], gains: {kp: 1}, reference: {trajectory: hold}}}\n  states:\n"
             "    a: {after: 50 ms, to: b, tasks: {h: {reference: {trajectory: polynomial, "
             "order: 5, to: 1 m, over: 100 ms}}}}\n    b: {tasks: {h: {reference: " +
             std::string(shape) + "}}}\n"));
    run.start();
    run.run_to(74);
    const tasks::AxisCommand before = run.axis("h", 0);
    run.tick();
    ASSERT_EQ(run.active(), "b");
    // The reference in the tick of the change is the last one's: one period on in speed.
    EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, before.ref) << shape;
    EXPECT_NEAR(run.axis("h", 0).ref_vel, before.ref_vel, 1e-9) << shape;
  }
}

TEST(MachineReference, TheSurfaceLiesBelowTheCentreOfMass) {
  Runner run(load(height("{trajectory: surface, to: 0.92 m, over: 100 ms}")), Body::standing);
  const model::HeightSurface surface = {{{0.1, 0.5, 0.07}}};
  run.machine.set_surface(surface);
  run.state.v_WB[0] = 0.5;
  run.carry_com(2, 0.9);
  run.carry_com(0, 0.0);
  run.start();
  double before = 0.0, now = 0.0, velocity = 0.0, measured_velocity = 0.0;
  for (int k = 0; k < 1500; ++k) {  // 0.5 m/s for 1 s: up the ramp
    const double x = 0.5 * k * kPeriod;
    run.carry_com(0, x);
    run.tick();
    const tasks::AxisCommand& axis = run.axis("h", 0);
    if (k == 0) {
      EXPECT_NEAR(axis.ref, 0.9, 1e-12);
    }
    if (k >= 150) {
      const auto ground = surface.at(x);
      EXPECT_NEAR(axis.ref, ground.height + 0.92, 1e-12);
      EXPECT_NEAR(axis.slope, ground.slope, 1e-12);
      EXPECT_NEAR(axis.ref_vel, 0.0, 1e-12);  // the row itself is that of z - f' x
      EXPECT_NEAR(axis.ref_acc, ground.curvature * 0.25, 1e-12);
    }
    // The reference's own rate: what the offset does plus the slope times the speed.
    if (k > 1) {
      EXPECT_NEAR(velocity, (axis.ref - before) / (2 * kPeriod), 1e-4);
    }
    measured_velocity = axis.slope * 0.5;
    velocity = axis.ref_vel + measured_velocity;
    before = now;
    now = axis.ref;
  }
}

TEST(MachineReference, WhatIsNotMentionedStaysWhileOtherKeysOfTheTaskChange) {
  Runner run(
      load("behavior: 1\nrobot: hume\nmachine:\n"
           "  tasks: {h: {type: com_position, axes: [z], gains: {kp: 1}, reference: {trajectory: "
           "minimum_jerk, to: 1 m, over: 200 ms}}}\n"
           "  states:\n    a: {after: 50 ms, to: b}\n"
           "    b: {tasks: {h: {priority: 2, weight: 3, gains: {kd: 7}}}}\n"));
  run.start();
  run.run_to(150);
  EXPECT_EQ(run.active(), "b");
  EXPECT_EQ(run.axis("h", 0).kd, 7.0);
  EXPECT_EQ(run.axis("h", 0).kp, 1.0);
  EXPECT_EQ(run.axis("h", 0).weight, 3.0);
  EXPECT_NEAR(run.axis("h", 0).ref, 0.5, 1e-12);  // half of 200 ms, not of what was left
}

TEST(MachineReference, AnotherTypeOrPointStartsFromWhatIsMeasured) {
  Runner run(
      load(
          "behavior: 1\nrobot: hume\nmachine:\n  states:\n"
          "    a: {after: 10 ms, to: b, tasks: {p: {type: point_position, point: left_foot, axes: "
          "[z], "
          "gains: {kp: 1}, reference: 3 m}}}\n"
          "    b: {after: 10 ms, to: c, tasks: {p: {type: point_position, point: right_foot, axes: "
          "[z], "
          "gains: {kp: 1}, reference: {trajectory: hold}}}}\n"
          "    c: {tasks: {p: {type: point_position, point: right_foot, axes: [x, z], gains: {kp: "
          "1}, "
          "reference: {trajectory: hold}}}}\n"),
      Body::standing);
  run.carry_point(0, 2, 0.25);
  run.start();
  run.run_to(15);
  EXPECT_TRUE(run.task("p")->fresh);
  EXPECT_NEAR(run.axis("p", 0).ref, 0.25, 1e-12);
  run.carry_point(0, 2, 0.5);
  run.carry_point(0, 0, 0.75);
  run.run_to(30);
  EXPECT_FALSE(run.task("p")->fresh);
  EXPECT_TRUE(run.axis("p", 0).fresh);   // x is new: measured, integral 0
  EXPECT_FALSE(run.axis("p", 1).fresh);  // z goes on
  EXPECT_NEAR(run.axis("p", 0).ref, 0.75, 1e-12);
  EXPECT_NEAR(run.axis("p", 1).ref, 0.25, 1e-12);
  run.tick();
  EXPECT_FALSE(run.axis("p", 0).fresh);
}

TEST(MachineReference, EntryIsWhereTheReferenceStarted) {
  Runner run(load(height("\"= entry + 0.1*entry.z\"")), Body::standing);
  run.carry_com(2, 0.5);
  run.start();
  run.tick();
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 0.55);
  run.carry_com(2, 0.9);
  run.tick();
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 0.55);
}

TEST(MachineReference, OverIsReadAtEntryAndAValueAtEveryTick) {
  const std::string parameters =
      "parameters: {d: {value: 100 ms, range: [10 ms, 1 s], live: true}}\n";
  Runner run(load(height("{trajectory: minimum_jerk, to: 1 m, over: $d}", "", parameters)));
  run.start();
  run.tick();
  run.parameter("d") = 1.0;
  run.run_to(150);
  EXPECT_NEAR(run.axis("h", 0).ref, 1.0, 1e-12);
  Runner value(load(height("\"= $d*1 m/s\"", "", parameters)));
  value.start();
  value.tick();
  value.parameter("d") = 0.5;
  value.tick();
  EXPECT_DOUBLE_EQ(value.axis("h", 0).ref, 0.5);
}

TEST(MachineReference, GainsThatAreExpressionsAreReadAtEveryTick) {
  Runner run(
      load("behavior: 1\nrobot: hume\nparameters: {k: {value: 100, range: [-9, 300], live: true}}\n"
           "machine:\n  transitions: [{on: error.execution, to: caught}]\n"
           "  tasks: {h: {type: com_position, axes: [x, z], gains: {kp: [$k, 5], kd: \"= "
           "2*sqrt($k)\"}, reference: 0}}\n  states: {a: {}, caught: {}}\n"));
  run.start();
  run.tick();
  EXPECT_EQ(run.axis("h", 0).kp, 100.0);
  EXPECT_EQ(run.axis("h", 1).kp, 5.0);
  EXPECT_EQ(run.axis("h", 1).kd, 20.0);
  run.parameter("k") = 144.0;
  run.tick();
  EXPECT_EQ(run.axis("h", 0).kd, 24.0);
  run.parameter("k") = -4.0;  // below 0, and without a root: the last ones stay, once an error
  run.tick();
  EXPECT_EQ(run.axis("h", 0).kp, 144.0);
  EXPECT_EQ(run.axis("h", 0).kd, 24.0);
  run.tick();
  EXPECT_EQ(run.active(), "caught");
}

TEST(MachineReference, SeveralFeetMayBeReleasedAtOnce) {
  Runner run(
      load("behavior: 1\nrobot: hume\nmachine:\n  states:\n"
           "    a: {contacts: [right_foot, left_foot], after: 10 ms, to: b}\n"
           "    b: {contacts: [], contact_transition: {releases: [right_foot, left_foot], "
           "over: 20 ms}}\n"));
  run.start();
  run.run_to(15);
  EXPECT_EQ(run.machine.control().moving_contact_count, 2);
  EXPECT_EQ(run.machine.control().other.contact_count, 2);
}

TEST(MachineReference, ReferencesOfEveryShapeAllocateNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "sanitizers allocate themselves";
  Runner run(load(
      "behavior: 1\nrobot: hume\nmachine:\n"
      "  tasks: {h: {type: com_position, axes: [z], gains: {kp: \"= 2/(1 s^2)\"}, reference: "
      "{trajectory: hold}}}\n  states:\n"
      "    a: {after: 20 ms, to: b, tasks: {h: {reference: {trajectory: ellipse, radius: 1 cm, "
      "period: 1 s}}}}\n"
      "    b: {after: 20 ms, to: c, tasks: {h: {reference: {trajectory: waypoints, points: [{at: 5 "
      "ms, to: 1 m}, {at: 9 ms, to: 0 m}]}}}}\n"
      "    c: {after: 20 ms, to: a, tasks: {h: {reference: {trajectory: surface}}}}\n"));
  run.start();
  run.tick();
  const AllocationGuard guard;
  run.run_to(500);
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
