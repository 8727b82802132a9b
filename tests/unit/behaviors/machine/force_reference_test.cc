// References of internal forces at run time (docs/behaviors.md 3.6): values, trajectories, statics.
#include <gtest/gtest.h>

#include <cmath>

#include "behaviors/machine/machine.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

constexpr double kPeriod = 1.0 / 1500.0;

// Two states with a tension each; the second is entered after 300 ticks.
std::string text(const std::string& first, const std::string& second) {
  const std::string head = "{internal: {t: {between: [right_foot, left_foot], reference: ";
  return "behavior: 1\nrobot: hume\nparameters: {f: {value: 40 N}}\nmachine:\n"
         "  contacts: [right_foot, left_foot]\n  states:\n    a: " +
         head + first + "}}, after: 200 ms, to: b}\n    b: " + head + second + "}}}\n";
}

class ForceReference : public testing::Test {
 protected:
  void begin(const std::string& first, const std::string& second) {
    run_ = std::make_unique<Runner>(load(text(first, second)), Body::standing);
    run_->start();
    run_->tick();
  }
  const tasks::InternalCommand& force() const {
    return run_->machine.control().primary.internals[0];
  }
  std::unique_ptr<Runner> run_;
};

TEST_F(ForceReference, ATrajectoryBeginsAtZeroAndTheNextOneWhereItEnds) {
  begin("{trajectory: cosine, to: $f, over: 100 ms}",
        "{trajectory: cosine, to: \"= entry + 10 N\", over: 100 ms}");
  EXPECT_NEAR(force().reference, 0.0, 1e-12);
  const AllocationGuard guard;
  run_->run_to(75);  // half of the way
  const double half = force().reference;
  run_->run_to(200);
  const double end = force().reference;
  run_->run_to(300 + 75);
  const double next = force().reference;
  run_->run_to(300 + 200);
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_NEAR(half, 20.0, 20.0 * std::numbers::pi * kPeriod / 0.1);  // within a tick's change
  EXPECT_NEAR(end, 40.0, 1e-12);
  EXPECT_NEAR(next, 45.0, 5.0 * std::numbers::pi * kPeriod / 0.1);
  EXPECT_NEAR(force().reference, 50.0, 1e-12);
}

TEST_F(ForceReference, TheSameTrajectoryGoesOnWhereOnlyOtherKeysChange) {
  const std::string head =
      "behavior: 1\nrobot: hume\nmachine:\n  contacts: [right_foot, left_foot]\n";
  run_ = std::make_unique<Runner>(
      load(head + "  internal: {t: {between: [right_foot, left_foot], reference: {trajectory: "
                  "cosine, to: 30 N, "
                  "over: 400 ms}}}\n  states:\n    a: {after: 200 ms, to: b}\n"
                  "    b: {internal: {t: {feedback: 2}}}\n"),
      Body::standing);
  run_->start();
  run_->tick();
  run_->run_to(450);
  EXPECT_EQ(force().feedback, 2.0);
  EXPECT_NEAR(force().reference, 15.0 * (1.0 - std::cos(std::numbers::pi * 0.75)), 0.5);
}

// The force stays what it is where the convention changes: 100 N of both feet are 50 N at each.
TEST_F(ForceReference, AnotherConventionIsNoOtherForce) {
  begin("100 N, convention: sum", "{trajectory: cosine, to: 50 N, over: 100 ms}");
  EXPECT_DOUBLE_EQ(force().reference, 50.0);
  run_->run_to(301);
  EXPECT_NEAR(force().reference, 50.0, 1e-12);
  run_->run_to(400);
  EXPECT_NEAR(force().reference, 50.0, 1e-12);
}

TEST_F(ForceReference, StaticsIsAPartOfWhatTheControllerFinds) {
  begin("statics", "{statics: 80 %}");
  EXPECT_EQ(force().statics, 1.0);
  run_->run_to(310);
  EXPECT_DOUBLE_EQ(force().statics, 0.8);
}

TEST_F(ForceReference, KeysOfAForceAreExpressions) {
  begin(
      "\"= $f / 2\", feedback: \"= 1 + t / 1 s\", integral: 3 1/s, integral_limit: 10 N, ramp: 4 "
      "ms, "
      "bandwidth: 30 Hz, convention: sum",
      "$f");
  EXPECT_DOUBLE_EQ(force().reference, 10.0);
  EXPECT_DOUBLE_EQ(force().integral, 3.0);
  EXPECT_DOUBLE_EQ(force().integral_limit, 5.0);  // N at each contact
  EXPECT_DOUBLE_EQ(force().ramp, 4e-3);
  EXPECT_DOUBLE_EQ(force().bandwidth, 30.0);
  const double before = force().feedback;
  run_->run_to(151);
  EXPECT_GT(force().feedback, before + 0.09);
}

}  // namespace
}  // namespace footfall::tests
