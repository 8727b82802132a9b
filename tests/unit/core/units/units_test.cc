// Quantities with units: what is read, what is refused, and that reading is exact.
#include "core/units/units.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace footfall::core {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_quantity(std::string_view text, double value, Dimension dimension) {
  const auto quantity = parse_quantity(text);
  ASSERT_TRUE(quantity.has_value()) << text;
  EXPECT_DOUBLE_EQ(quantity->value, value) << text;
  EXPECT_EQ(quantity->dimension, dimension) << text;
}

TEST(UnitsTest, EveryUnitOfTheLanguageIsRead) {
  expect_quantity("16 ms", 0.016, kTime);
  expect_quantity("667 us", 667e-6, kTime);
  expect_quantity("667 \u00b5s", 667e-6, kTime);
  expect_quantity("20 ns", 20e-9, kTime);
  expect_quantity("2 min", 120, kTime);
  expect_quantity("0.91 m", 0.91, kLength);
  expect_quantity("7 cm", 0.07, kLength);
  expect_quantity("25 mm", 0.025, kLength);
  expect_quantity("40 N", 40, kForce);
  expect_quantity("1.2 kN", 1200, kForce);
  expect_quantity("8 Nm", 8, kTorque);
  expect_quantity("20 kg", 20, kMass);
  expect_quantity("150 g", 0.15, kMass);
  expect_quantity("-25 deg", -25 * kPi / 180, kNone);
  expect_quantity("3.8e-4 rad", 3.8e-4, kNone);
  expect_quantity("2 mrad", 0.002, kNone);
  expect_quantity("1500 Hz", 1500, kRate);
  expect_quantity("1.5 kHz", 1500, kRate);
  expect_quantity("70 %", 0.7, kNone);
  expect_quantity("+5 %", 0.05, kNone);
  expect_quantity("15 1/s", 15, kRate);
  expect_quantity("220 1/s^2", 220, kRateSquared);
  expect_quantity("20 1/s^3", 20, Dimension{0, 0, -3});
  expect_quantity("0.3 m/s", 0.3, kVelocity);
  expect_quantity("9.81 m/s^2", 9.81, kAcceleration);
  expect_quantity("0.25 deg/s", 0.25 * kPi / 180, kRate);
  expect_quantity("3 rad/s^2", 3, kRateSquared);
  expect_quantity("0.136 kg m^2", 0.136, kInertia);
  expect_quantity("440 Nm/rad", 440, kTorque);
  expect_quantity("4 N s", 4, kImpulse);
  expect_quantity("4 Ns", 4, kImpulse);
  expect_quantity("250 N/m", 250, Dimension{0, 1, -2});
  expect_quantity("3 J", 3, kTorque);
  expect_quantity("90 W", 90, Dimension{2, 1, -3});
}

TEST(UnitsTest, ABlankAStarAndNothingMeanTheSameProduct) {
  for (const char* text : {"8 Nm", "8 N m", "8 N*m", "8 N * m", "8  N  m", "8Nm", " 8 Nm "}) {
    expect_quantity(text, 8, kTorque);
  }
  expect_quantity("16ms", 0.016, kTime);
  // A slash divides by the next factor only.
  expect_quantity("2 kg m/s^2", 2, kForce);
  expect_quantity("2 m/s/s", 2, kAcceleration);
  expect_quantity("2 m s^-1", 2, kVelocity);
}

TEST(UnitsTest, BareNumbersAreRememberedAsBare) {
  EXPECT_TRUE(parse_quantity("1e-3")->bare);
  EXPECT_TRUE(parse_quantity("5")->bare);
  EXPECT_FALSE(parse_quantity("5 rad")->bare);
  expect_quantity(".5 s", 0.5, kTime);
  expect_quantity("-.5e+2", -50, kNone);
}

TEST(UnitsTest, APrefixDoesNotCostTheLastBit) {
  // A phase of 16 ms must be the same number as 0.016, or a count of ticks may be one off.
  for (int i = 1; i < 5000; ++i) {
    const std::string thousandths = std::to_string(i);
    std::string padded = std::string(thousandths.size() < 4 ? 4 - thousandths.size() : 0, '0');
    padded += thousandths;
    const std::string seconds =
        padded.substr(0, padded.size() - 3) + "." + padded.substr(padded.size() - 3);
    EXPECT_EQ(parse_quantity(thousandths + " ms")->value, parse_quantity(seconds + " s")->value)
        << thousandths;
  }
}

TEST(UnitsTest, WhatIsNoFiniteDecimalQuantityIsRefused) {
  for (const char* text : {"",
                           " ",
                           "inf",
                           "-inf",
                           "nan",
                           ".inf",
                           ".nan",
                           "0x1F",
                           "1_000",
                           "1,5",
                           "1e400",
                           "1e-400",
                           "e5",
                           ".",
                           "+",
                           "--5",
                           "+-5",
                           "5 5",
                           "5 m m m m m m m m m m m m m m",
                           "16 mss",
                           "16 ms?",
                           "16 parsec",
                           "5 N/",
                           "5 /s",
                           "220/s",
                           "5 m^",
                           "5 m^x",
                           "5 m^12",
                           "5 m**2",
                           "5 1",
                           "5 1/",
                           "true",
                           "5;",
                           "5 (m)",
                           "5 m ^2",
                           "\xff",
                           "5 \xc2"}) {
    EXPECT_FALSE(parse_quantity(text).has_value()) << "'" << text << "'";
  }
}

TEST(UnitsTest, AUnitAloneGivesItsFactor) {
  EXPECT_DOUBLE_EQ(parse_unit("deg/s")->value, kPi / 180);
  EXPECT_DOUBLE_EQ(parse_unit("1/ms")->value, 1000);
  EXPECT_FALSE(parse_unit("").has_value());
  EXPECT_FALSE(parse_unit("1").has_value());
  EXPECT_FALSE(parse_unit("5 m").has_value());
}

TEST(UnitsTest, DimensionsHaveEverydayNames) {
  EXPECT_EQ(dimension_name(kTime), "a time");
  EXPECT_EQ(dimension_name(kNone), "a plain number");
  EXPECT_EQ(dimension_name(kForce), "a force");
  EXPECT_EQ(dimension_name(kRateSquared), "a value in 1/s^2");
}

TEST(UnitsTest, TheTextOfAUnitReadsBackAsTheSameDimension) {
  for (int m = -3; m <= 3; ++m) {
    for (int kg = -2; kg <= 2; ++kg) {
      for (int s = -4; s <= 4; ++s) {
        const Dimension dimension{static_cast<std::int8_t>(m), static_cast<std::int8_t>(kg),
                                  static_cast<std::int8_t>(s)};
        const std::string text = unit_text(dimension);
        if (dimension == kNone) {
          EXPECT_EQ(text, "");
          continue;
        }
        const auto unit = parse_unit(text);
        ASSERT_TRUE(unit.has_value()) << text;
        EXPECT_EQ(unit->dimension, dimension) << text;
        EXPECT_EQ(unit->value, 1.0) << text;
      }
    }
  }
  EXPECT_EQ(unit_text(kAcceleration), "m/s^2");
  EXPECT_EQ(unit_text(kTorque), "Nm");
  EXPECT_EQ(unit_text(kRate), "1/s");
  EXPECT_EQ(unit_text(kRate / kTorque), "rad/s/Nm");  // of a cascaded torque loop
  EXPECT_EQ(unit_text(kRateSquared / kTorque), "rad/s^2/Nm");
}

}  // namespace
}  // namespace footfall::core
