// References that move while their velocity counts as 0: told, with the time by which the axis
// lags; trajectories, constants, parameters and feet that hold are not.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;

std::string yaw(const std::string& reference) {
  return standing(
      "[right_foot, left_foot]",
      height() + "      attitude: {type: body_orientation, reference: {roll: 0, pitch: 0, yaw: " +
          reference + "}, gains: {kp: 200, kd: 15}}\n" + rest());
}

TEST(FeedForward, AReferenceThatMovesWithTimeIsToldAtItsExpression) {
  for (const std::string clock : {"time", "t"}) {
    const std::string text = yaw("\"= 8 deg*sin(3.14 1/s*" + clock + ")\"");
    EXPECT_THAT(physics(text),
                HasSubstr(place_of(text, "{roll: 0") +
                          "warning: the reference of task 'attitude' moves with '" + clock +
                          "', and its velocity and acceleration count as 0: the axis lags by kd/kp "
                          "= 75 ms of its speed; a `trajectory` has them"));
  }
}

TEST(FeedForward, AMeasuredSignalMovesAndAFootThatHoldsDoesNot) {
  EXPECT_THAT(physics(yaw("\"= base.rpy.yaw\"")), HasSubstr("moves with 'base.rpy.yaw'"));
  EXPECT_EQ(physics(yaw("\"= atan2(point.left_foot.x, point.right_foot.x)\"")), "");
}

TEST(FeedForward, AConstantTheEntryAndATrajectoryAreNotTold) {
  for (const char* reference :
       {"3 deg", "entry", "\"= entry + 2 deg\"", "\"= contact.left_foot ? 1 deg : 0 deg\""}) {
    EXPECT_EQ(physics(yaw(reference)), "") << reference;
  }
  EXPECT_EQ(physics(standing("[right_foot, left_foot]",
                             "      height: {type: com_position, axes: [z], gains: {kp: 1}, "
                             "reference: {trajectory: minimum_jerk, to: \"= entry - 1 cm\", over: "
                             "1 s}}\n" +
                                 attitude("[yaw, pitch, roll]") + rest())),
            "");
}

}  // namespace
}  // namespace footfall::tests
