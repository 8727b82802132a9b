// What a step is: 60 ms without ground contact, a rise of 2 cm, and then the robot stands without
// the feet that stood before.
#include "lab/figures/step_counter.h"

#include <gtest/gtest.h>

#include <cmath>

namespace footfall::lab {
namespace {

constexpr double kPeriod = 1e-3;  // s

class Steps : public testing::Test {
 protected:
  // Both feet's contact and height for a number of milliseconds; counts the steps reported. Heights
  // change after the first of them: a foot lets go before it rises.
  void hold(bool right, bool left, int ms, double right_z = 0.0, double left_z = 0.0) {
    const std::array<bool, 2> contact = {right, left};
    for (int k = 0; k < ms; ++k) {
      if (k > 0 || right) height[0] = right_z;
      if (k > 0 || left) height[1] = left_z;
      const StepEvent event = counter.observe(kPeriod * tick++, contact.data(), height.data());
      if (event.foot >= 0) last = event;
      events += event.foot >= 0 ? 1 : 0;
    }
  }
  // The left foot swings: on the ground, at its height, back on the ground.
  void swing_left(int ms, double rise) {
    hold(true, true, 10);
    hold(true, false, ms, 0.0, rise);
    hold(true, true, 10);
  }
  StepCounter counter{2, kPeriod};
  std::array<double, 2> height{};
  StepEvent last;
  int events = 0, tick = 0;
};

TEST_F(Steps, ASwungFootThatBecomesTheStanceFootIsAStep) {
  swing_left(200, 0.05);
  EXPECT_EQ(counter.steps(), 0);  // both stand: not the stance foot yet
  hold(false, true, 1);
  EXPECT_EQ(counter.steps(), 1);
  EXPECT_EQ(last.foot, 1);
  EXPECT_NEAR(last.flight_time, 0.2, 1e-12);
  EXPECT_EQ(last.clearance, 0.05);
  hold(false, true, 300, 0.03);
  EXPECT_EQ(counter.steps(), 1);  // the same step is counted once
  EXPECT_EQ(events, 1);
}

TEST_F(Steps, ASwingBelowSixtyMillisecondsIsNone) {
  swing_left(59, 0.05);
  hold(false, true, 10);
  EXPECT_EQ(counter.steps(), 0);
}

TEST_F(Steps, ASwingOfSixtyMillisecondsIsOne) {
  swing_left(60, 0.05);
  hold(false, true, 10);
  EXPECT_EQ(counter.steps(), 1);
}

TEST_F(Steps, ARiseBelowTwoCentimetresIsNone) {
  swing_left(200, 0.0199);
  hold(false, true, 10);
  EXPECT_EQ(counter.steps(), 0);
}

TEST_F(Steps, ARiseOfTwoCentimetresIsOne) {
  swing_left(200, 0.02);
  hold(false, true, 10);
  EXPECT_EQ(counter.steps(), 1);
}

TEST_F(Steps, TheRiseCountsFromWhereTheFootLeftTheGround) {
  hold(true, true, 10, 0.0, 0.1);  // on a platform
  hold(true, false, 1, 0.0, 0.1);
  hold(true, false, 200, 0.0, 0.115);
  hold(true, true, 10, 0.0, 0.1);
  hold(false, true, 10, 0.0, 0.1);
  EXPECT_EQ(counter.steps(), 0);
}

TEST_F(Steps, ABounceAfterTouchdownKeepsTheStep) {
  swing_left(200, 0.05);
  hold(true, false, 5, 0.0, 0.001);
  hold(true, true, 5);
  hold(false, true, 1);
  EXPECT_EQ(counter.steps(), 1);
  EXPECT_NEAR(last.flight_time, 0.2, 1e-12);  // of the swing, not of the bounce
  EXPECT_EQ(last.clearance, 0.05);
}

TEST_F(Steps, ABounceAsLongAsASwingForgetsTheStep) {
  swing_left(200, 0.05);
  hold(true, false, 80, 0.0, 0.001);  // in the air again, too low for a step
  hold(true, true, 5);
  hold(false, true, 10);
  EXPECT_EQ(counter.steps(), 0);
}

TEST_F(Steps, ATouchdownAtTheVeryLiftOffOfTheOtherFootCounts) {
  hold(true, true, 10);
  hold(true, false, 200, 0.0, 0.05);
  hold(false, true, 1);  // never both on the ground
  EXPECT_EQ(counter.steps(), 1);
}

TEST_F(Steps, AHopOnBothFeetIsNoStep) {
  hold(true, true, 10);
  hold(false, false, 200, 0.05, 0.05);
  hold(true, true, 50);
  EXPECT_EQ(counter.steps(), 0);
}

TEST_F(Steps, AHopOnTheSameFootTwiceIsAStepEachTime) {
  swing_left(200, 0.05);
  hold(false, true, 10);
  hold(true, true, 1);  // the right foot only tapped: it did not swing
  EXPECT_EQ(counter.steps(), 1);
  hold(true, false, 200, 0.0, 0.05);
  hold(true, true, 1);
  hold(false, true, 10);
  EXPECT_EQ(counter.steps(), 2);
}

TEST_F(Steps, AlternatingStepsCountEach) {
  for (int k = 0; k < 10; ++k) {
    hold(true, true, 16);
    hold(true, false, 300, 0.0, 0.05);
    hold(true, true, 16);
    hold(false, true, 300, 0.04);
  }
  // The left foot ten times; the right one nine, its last landing has not become the stance yet.
  EXPECT_EQ(counter.steps(), 19);
  EXPECT_EQ(counter.worst_clearance(), 0.04);
}

TEST_F(Steps, TouchdownsAreReportedInTheirOwnTick) {
  hold(true, true, 10);
  hold(true, false, 200, 0.0, 0.05);
  EXPECT_FALSE(counter.touched_down(1));
  hold(true, true, 1);
  EXPECT_TRUE(counter.touched_down(1));
  EXPECT_FALSE(counter.touched_down(0));
  hold(true, true, 1);
  EXPECT_FALSE(counter.touched_down(1));
}

// The contacts of four feet, for a number of milliseconds; feet in the air are 5 cm high.
void hold_four(StepCounter& counter, int& tick, std::array<bool, 4> contact, int ms) {
  std::array<double, 4> height{};
  for (int k = 0; k < ms; ++k) {
    for (std::size_t f = 0; f < 4; ++f) height[f] = contact[f] || k == 0 ? 0.0 : 0.05;
    counter.observe(kPeriod * tick++, contact.data(), height.data());
  }
}

TEST(StepsOfFourFeet, APairThatTakesOverFromTheOtherPairIsOneStep) {
  StepCounter counter(4, kPeriod);
  int tick = 0;
  hold_four(counter, tick, {true, true, true, true}, 10);
  hold_four(counter, tick, {true, false, false, true}, 200);
  hold_four(counter, tick, {true, true, false, true}, 3);  // one foot of the pair comes down first
  hold_four(counter, tick, {true, true, true, true}, 10);
  EXPECT_EQ(counter.steps(), 0);
  hold_four(counter, tick, {false, true, true, true}, 3);
  EXPECT_EQ(counter.steps(), 0);  // one foot that stood still does
  hold_four(counter, tick, {false, true, true, false}, 200);
  EXPECT_EQ(counter.steps(), 1);
}

TEST(StepsOfFourFeet, APairThatComesDownInOneTickIsOneStep) {
  StepCounter counter(4, kPeriod);
  int tick = 0;
  hold_four(counter, tick, {true, true, true, true}, 10);
  hold_four(counter, tick, {true, false, false, true}, 200);
  hold_four(counter, tick, {true, true, true, true}, 10);
  hold_four(counter, tick, {false, true, true, false}, 200);
  EXPECT_EQ(counter.steps(), 1);
}

TEST(StepsOfFourFeet, AFootThatIsLiftedAndPutBackIsNone) {
  StepCounter counter(4, kPeriod);
  int tick = 0;
  for (int k = 0; k < 3; ++k) {
    hold_four(counter, tick, {true, true, true, true}, 100);
    hold_four(counter, tick, {true, false, true, true}, 200);
  }
  EXPECT_EQ(counter.steps(), 0);
}

}  // namespace
}  // namespace footfall::lab
