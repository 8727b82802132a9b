// Pushes and vectors from the command line.
#include "sim/world/push.h"

#include <gtest/gtest.h>

#include <numbers>

namespace footfall::sim {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(DisturbanceTest, APushAtATime) {
  std::string error;
  for (const char* text : {"40,0.1,90,3", "40 N, 100 ms, 90 deg, 3 s", "0.04 kN,1e-1,0.5 deg,3"}) {
    const auto push = parse_push(text, error);
    ASSERT_TRUE(push.has_value()) << error;
    EXPECT_DOUBLE_EQ(push->force, 40);
    EXPECT_DOUBLE_EQ(push->duration, 0.1);
    EXPECT_EQ(push->body, "torso");
    ASSERT_TRUE(std::holds_alternative<AtTime>(push->at));
    EXPECT_EQ(std::get<AtTime>(push->at).seconds, 3);
  }
  EXPECT_DOUBLE_EQ(parse_push("40,0.1,90,3", error)->direction, kPi / 2);
  EXPECT_DOUBLE_EQ(parse_push("40,0.1,-22.5,3", error)->direction, -kPi / 8);
  EXPECT_DOUBLE_EQ(parse_push("40,0.1,1 rad,3", error)->direction, 1.0);
  EXPECT_EQ(parse_push("40,0.1,90,3", error, "trunk")->body, "trunk");
}

TEST(DisturbanceTest, APushInAStep) {
  std::string error;
  const auto at = [&error](const std::string& text) {
    const auto push = parse_push("40,0.1,90," + text, error);
    EXPECT_TRUE(push.has_value()) << error;
    return push ? std::get<AtStep>(push->at) : AtStep{};
  };
  EXPECT_EQ(at("step 17 phase 0.25").step, 17);
  EXPECT_EQ(at("step 17 phase 0.25").phase, 0.25);
  EXPECT_EQ(at(" step  8  phase  50 % ").phase, 0.5);
  EXPECT_EQ(at("step 8").phase, 0.0);
}

TEST(DisturbanceTest, AWrongPushSaysWhatWasExpected) {
  const auto problem = [](std::string_view text) {
    std::string error;
    EXPECT_FALSE(parse_push(text, error).has_value()) << text;
    return error;
  };
  const std::string form = " (FORCE_N,DURATION_S,DIRECTION_DEG,AT)";
  EXPECT_EQ(problem("40,0.1,90"),
            "expected four values with commas between, got '40,0.1,90'" + form);
  EXPECT_EQ(problem("40 m,0.1,90,3"), "expected a force in N, not below zero, got '40 m'" + form);
  EXPECT_EQ(problem("40,0,90,3"), "expected a duration in s, above zero, got '0'" + form);
  EXPECT_EQ(problem("40,0.1,left,3"), "expected a direction in degrees, got 'left'" + form);
  for (const char* at :
       {"-1", "soon", "step", "step 0", "step x", "step 8 phase", "step 8 phase 1",
        "step 8 phase -1", "step 8phase 0.5", "step 8 0.5", "inf", "", "step 99999999999"}) {
    EXPECT_EQ(problem(std::string("40,0.1,90,") + at),
              "expected a time in s, 'step N' or 'step N phase P' (0 <= P < 1), got '" +
                  std::string(at) + "'" + form);
  }
}

TEST(DisturbanceTest, VectorsOfTwoHaveADimension) {
  std::string error;
  EXPECT_EQ(parse_vector2("1, -0.5", core::kLength, error), (std::array<double, 2>{1, -0.5}));
  EXPECT_EQ(parse_vector2("30 cm,0", core::kLength, error), (std::array<double, 2>{0.3, 0}));
  for (const char* text : {"1", "1,2,3", "1 s,2", "a,b", ""}) {
    EXPECT_FALSE(parse_vector2(text, core::kLength, error).has_value());
    EXPECT_EQ(error, "expected 'x,y', each a length, got '" + std::string(text) + "'");
  }
}

}  // namespace
}  // namespace footfall::sim
