// References with an origin that moves: `frame: stance` while the feet that hold change.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(MachineFrame, FromTheStanceFootAKeptReferenceStaysWhereItIsInTheWorld) {
  Runner run(
      load("behavior: 1\nrobot: hume\nmachine:\n"
           "  tasks: {h: {type: com_position, frame: stance, axes: [z], gains: {kp: 1}, reference: "
           "{trajectory: hold}}}\n  states:\n    a: {contacts: [right_foot], after: 10 ms, to: b}\n"
           "    b: {contacts: [left_foot], tasks: {h: {reference: {trajectory: polynomial, order: "
           "3, to: "
           "0.95 m, over: 100 ms}}}}\n"),
      Body::standing);
  run.state.q[4] -= 0.4;  // the left foot is on a step
  run.model->update(run.state);
  run.carry_com(2, 1.0);
  const double above_right = 1.0 - run.model->point_position(0)[2];
  const double above_left = 1.0 - run.model->point_position(1)[2];
  ASSERT_GT(std::abs(above_right - above_left), 0.02);
  run.start();
  run.tick();
  EXPECT_NEAR(run.axis("h", 0).ref, above_right, 1e-12);
  run.run_to(15);
  ASSERT_EQ(run.active(), "b");
  EXPECT_NEAR(run.axis("h", 0).ref, above_left, 1e-12);
  run.run_to(200);
  EXPECT_DOUBLE_EQ(run.axis("h", 0).ref, 0.95);
}

// The outer task goes on while an inner state drops a foot: its origin moves from between the feet
// to the right one, its reference stays where it is. Whether it is begun anew or goes on.
TEST(MachineFrame, FromTheStanceFeetWhatGoesOnStaysWhereItIsInTheWorld) {
  for (const char* reference :
       {"{trajectory: hold}", "entry", "{trajectory: cosine, to: 0.05 m, over: 100 ms}",
        "{trajectory: minimum_jerk, to: 0.05 m, over: 100 ms}",
        "{trajectory: ellipse, radius: 2 cm, period: 100 ms}",
        "{trajectory: waypoints, over: 100 ms, points: [{at: 50 ms, to: 0.02 m}, {at: 100 ms, to: "
        "0.05 m}]}"}) {
    for (const char* inner : {"", ", tasks: {y: {gains: {kp: 2}}}"}) {
      Runner run(
          load("behavior: 1\nrobot: hume\nmachine:\n"
               "  tasks: {y: {type: com_position, frame: stance, axes: [y], gains: {kp: 1}, "
               "reference: " +
               std::string(reference) +
               "}}\n  states:\n    a: {contacts: [right_foot, left_foot], after: 20 ms, to: "
               "b}\n    b: {contacts: [right_foot]" +
               inner + ", after: 20 ms, to: c}\n    c: {contacts: [right_foot, left_foot]}\n"),
          Body::standing);
      const double between =
          0.5 * (run.model->point_position(0)[1] + run.model->point_position(1)[1]);
      const double right = run.model->point_position(0)[1];
      ASSERT_GT(std::abs(between - right), 0.1);
      run.start();
      run.run_to(29);
      double before = run.axis("y", 0).ref + between;
      double rate = 0.0;
      for (int tick = 30; tick < 150; ++tick) {
        run.run_to(tick);
        const bool both = run.active() != "b";
        const double now = run.axis("y", 0).ref + (both ? between : right);
        rate = std::max(rate, std::abs(now - before));
        before = now;
      }
      // The fastest of them moves 2 cm by 2 pi in 100 ms: 0.84 mm in a tick.
      EXPECT_LT(rate, 2e-3) << reference << inner;
      if (std::string(reference).find("to: 0.05 m") != std::string::npos) {
        run.run_to(170);
        EXPECT_NEAR(run.axis("y", 0).ref, 0.05, 1e-12) << reference;
      }
    }
  }
}

// A value is no reference that is held: it counts from the origin of its tick.
TEST(MachineFrame, AValueFromTheStanceFeetCountsFromTheOnesThatHold) {
  Runner run(
      load("behavior: 1\nrobot: hume\nmachine:\n"
           "  tasks: {y: {type: com_position, frame: stance, axes: [y], gains: {kp: 1}, "
           "reference: 3 cm}}\n  states:\n    a: {contacts: [right_foot, left_foot], after: 20 "
           "ms, to: b}\n    b: {contacts: [right_foot]}\n"),
      Body::standing);
  run.start();
  for (const int tick : {20, 40}) {
    run.run_to(tick);
    EXPECT_EQ(run.axis("y", 0).ref, 0.03);
  }
}

}  // namespace
}  // namespace footfall::tests
