// Numbers as people read, type and step them.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "apps/tune/model/quantity.h"

namespace footfall::apps {
namespace {

TEST(TuneQuantity, AUnitSuitsTheSizeOfItsNumber) {
  EXPECT_EQ(display_unit(core::kTime, 0.145).name, "ms");
  EXPECT_EQ(display_unit(core::kTime, 5.5).name, "s");
  EXPECT_EQ(display_unit(core::kTime, 2e-5).name, "us");
  EXPECT_EQ(display_unit(core::kTime, 0.0).name, "ms");
  EXPECT_EQ(display_unit(core::kLength, 0.03).name, "cm");
  EXPECT_EQ(display_unit(core::kLength, -0.002).name, "mm");
  EXPECT_EQ(display_unit(core::kLength, 0.91).name, "m");
  EXPECT_EQ(display_unit(core::kRateSquared, 220.0).name, "1/s^2");
  EXPECT_EQ(display_unit(core::kNone, 0.7).name, "");
}

TEST(TuneQuantity, ValuesAreShownInTheirUnit) {
  const DisplayUnit ms = display_unit(core::kTime, 0.1);
  EXPECT_EQ(shown_value(0.145, ms), "145 ms");
  EXPECT_EQ(shown_value(-0.0, ms), "0 ms");
  EXPECT_EQ(shown_values(std::array{220.0, 237.0}, {"1/s^2", 1.0}), "[220, 237] 1/s^2");
}

TEST(TuneQuantity, ExactTextsReadBackToTheSameNumbersBitForBit) {
  // Neighbours of round numbers, and numbers that no short text in ms gives.
  for (const double value : {0.145, std::nextafter(0.145, 1.0), 1.0 / 3.0, 1e-7, 0.1 + 0.2,
                             std::numeric_limits<double>::min(), 123456.789, -0.3}) {
    for (const double size : {value, 0.1, 1e-5}) {
      const DisplayUnit unit = display_unit(core::kTime, size);
      const std::string text = exact_values(std::array{value, value}, unit);
      const ReadValues read = read_values(text, core::kTime, 2);
      ASSERT_EQ(read.problem, "") << text;
      EXPECT_EQ(read.values, (std::vector{value, value})) << text;
    }
  }
  EXPECT_EQ(exact_values(std::array{0.145}, display_unit(core::kTime, 0.1)), "145 ms");
}

TEST(TuneQuantity, ValuesAreReadWithUnitsAndListsInAnyForm) {
  EXPECT_EQ(read_values("150ms", core::kTime, 1).values, std::vector{0.15});
  EXPECT_EQ(read_values(" 0.15 ", core::kTime, 1).values, std::vector{0.15});
  EXPECT_EQ(read_values("[1 m, 50 cm]", core::kLength, 2).values, (std::vector{1.0, 0.5}));
  EXPECT_EQ(read_values("[1, 2] cm", core::kLength, 2).values, (std::vector{0.01, 0.02}));
  EXPECT_EQ(read_values("220,237,400", core::kRateSquared, 3).values,
            (std::vector{220.0, 237.0, 400.0}));
  EXPECT_EQ(read_values("3", core::kRateSquared, 3).values, (std::vector{3.0, 3.0, 3.0}));
}

TEST(TuneQuantity, WhatCannotBeAValueIsSaid) {
  EXPECT_EQ(read_values("100 N", core::kTime, 1).problem, "expected a time, got '100 N'");
  EXPECT_EQ(read_values("", core::kTime, 1).problem, "expected a time, got ''");
  EXPECT_EQ(read_values("nan", core::kNone, 1).problem, "expected a plain number, got 'nan'");
  EXPECT_EQ(read_values("1, 2", core::kLength, 3).problem, "expected 3 values, got 2");
  EXPECT_EQ(read_values("[1, 2", core::kLength, 2).problem, "expected ']' at the end of '[1, 2'");
  EXPECT_NE(read_values("[1 cm] cm", core::kLength, 1).problem, "");
  EXPECT_FALSE(read_duration("-1 s"));
  EXPECT_FALSE(read_duration("soon"));
  EXPECT_EQ(read_duration("500ms"), 0.5);
}

TEST(TuneQuantity, StepsAreOneTwoOrFiveTimesAPowerOfTen) {
  EXPECT_DOUBLE_EQ(round_step(6.4), 5.0);
  EXPECT_DOUBLE_EQ(round_step(10.0), 10.0);
  EXPECT_DOUBLE_EQ(round_step(1000.0), 1000.0);
  EXPECT_DOUBLE_EQ(round_step(0.001), 0.001);
  EXPECT_DOUBLE_EQ(round_step(0.0499), 0.02);
  // 145 ms in 80 to 200 ms: a twentieth is 7.25 ms, of the range 6 ms.
  EXPECT_DOUBLE_EQ(default_step(0.145, 0.08, 0.2, 0.1, display_unit(core::kTime, 0.1)), 5.0);
  EXPECT_DOUBLE_EQ(default_step(0.145, 0.14, 0.16, 0.1, display_unit(core::kTime, 0.1)), 1.0);
  // 0 in -0.5 to 0.5 m: 5 cm; in -1000 to 1000 m or without a range no more than the first.
  EXPECT_DOUBLE_EQ(default_step(0.0, -0.5, 0.5, 0.1, {"m", 1.0}), 0.05);
  EXPECT_DOUBLE_EQ(default_step(0.0, -1000.0, 1000.0, 0.1, {"m", 1.0}), 0.1);
  EXPECT_DOUBLE_EQ(default_step(0.0, 0.0, 0.0, 0.1, {"", 1.0}), 0.1);
}

TEST(TuneQuantity, StepsThereAndBackEndWhereTheyBegan) {
  const DisplayUnit ms = display_unit(core::kTime, 0.1);
  double value = 0.145;
  for (int k = 0; k < 40; ++k) value = stepped(value, 5.0, 1.0, ms);
  EXPECT_EQ(value, 0.345);
  for (int k = 0; k < 400; ++k) value = stepped(value, 5.0, -0.1, ms);
  EXPECT_EQ(value, 0.145);
}

}  // namespace
}  // namespace footfall::apps
