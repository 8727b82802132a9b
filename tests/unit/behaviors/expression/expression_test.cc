#include "behaviors/expression/expression.h"

#include <gtest/gtest.h>

#include <cmath>

#include "behaviors/expression/statistics.h"

namespace footfall::tests {
namespace {

using behaviors::compile_expression;
using behaviors::EvaluationContext;
using behaviors::ExpressionError;
using behaviors::ExpressionPool;
using behaviors::ExpressionScope;
using behaviors::ParameterInfo;
using behaviors::Statistic;
using core::Dimension;

// Two signals, three parameters, and a state that has been active for 30 ticks of 1 ms.
class Expression : public testing::Test {
 protected:
  Expression() {
    height_ = signals_.add("com.pos.z", core::kLength, "");
    contact_ = signals_.add("contact.left", core::kNone, "");
    signals_[height_] = 0.9;
    signals_[contact_] = 1.0;
    add("lift", 0, 1, core::kTime, false);
    add("goal", 1, 2, core::kNone, true);
    add("scale", 3, 1, core::kNone, true);
    scope_.signals = &signals_;
    scope_.parameters = &parameters_;
    scope_.state = 1;
    scope_.find_state = [](std::string_view name, std::string& why) {
      if (name == "lift") return 1;
      why = "unknown state";
      return -1;
    };
    context_.signals = signals_.values();
    context_.parameters = values_;
    context_.entry_ticks = entry_ticks_;
    context_.active = active_;
    context_.tick = 130;
    context_.period = 1e-3;
  }
  void add(const char* name, int slot, int size, Dimension dimension, bool bare) {
    ParameterInfo info;
    info.name = name;
    info.slot = slot;
    info.size = size;
    info.dimension = dimension;
    info.bare = bare;
    parameters_.push_back(info);
  }
  double value(const std::string& text, std::optional<Dimension> expected = std::nullopt) {
    ExpressionError error;
    const int index = compile_expression(text, scope_, expected, pool_, error);
    EXPECT_GE(index, 0) << text << ": " << error.text;
    return index < 0 ? std::nan("") : evaluate(pool_, index, context_);
  }
  // `offset: text` of the error.
  std::string error_of(const std::string& text, std::optional<Dimension> expected = std::nullopt) {
    ExpressionError error;
    EXPECT_EQ(compile_expression(text, scope_, expected, pool_, error), -1) << text;
    return std::to_string(error.offset) + ": " + error.text;
  }

  core::SignalTable signals_;
  std::vector<ParameterInfo> parameters_;
  double values_[4] = {0.145, 2.0, -1.0, 3.0};
  std::int64_t entry_ticks_[2] = {0, 100};
  std::uint8_t active_[2] = {1, 1};
  int height_ = 0, contact_ = 0;
  ExpressionScope scope_;
  ExpressionPool pool_;
  EvaluationContext context_;
};

TEST_F(Expression, MultiplicationBindsStrongerThanAddition) { EXPECT_EQ(value("1 + 2*3"), 7.0); }
TEST_F(Expression, SubtractionAndDivisionGoFromLeftToRight) {
  EXPECT_EQ(value("10 - 4 - 3"), 3.0);
  EXPECT_EQ(value("16 / 4 / 2"), 2.0);
}
TEST_F(Expression, PowerGoesFromRightToLeftAndBindsStrongerThanMinus) {
  EXPECT_EQ(value("2^3^2"), 512.0);
  EXPECT_EQ(value("-2^2"), -4.0);
  EXPECT_EQ(value("2^-1"), 0.5);
}
TEST_F(Expression, NumbersTakeTheLongestUnitThatFollows) {
  EXPECT_DOUBLE_EQ(value("6 cm", core::kLength), 0.06);
  EXPECT_DOUBLE_EQ(value("0.25 m/s", core::kVelocity), 0.25);
  EXPECT_DOUBLE_EQ(value("220 1/s^2", core::kRateSquared), 220.0);
  EXPECT_DOUBLE_EQ(value("2 m / 4 s", core::kVelocity), 0.5);
  EXPECT_DOUBLE_EQ(value("70 %"), 0.7);
  EXPECT_DOUBLE_EQ(value("90 deg"), M_PI / 2);
}
TEST_F(Expression, ParametersAreReadByNameAndComponent) {
  EXPECT_DOUBLE_EQ(value("0.7*$lift", core::kTime), 0.7 * 0.145);
  EXPECT_EQ(value("$goal.x"), 2.0);
  EXPECT_EQ(value("$goal.y"), -1.0);
}
TEST_F(Expression, ParametersWithoutUnitAdoptTheDimensionNeeded) {
  EXPECT_DOUBLE_EQ(value("com.pos.z - $goal.x", core::kLength), -1.1);
  EXPECT_EQ(value("$goal.x", core::kLength), 2.0);
}
TEST_F(Expression, TheTimeInTheStateCountsFromItsEntry) {
  EXPECT_DOUBLE_EQ(value("t", core::kTime), 0.030);
  EXPECT_DOUBLE_EQ(value("time", core::kTime), 0.130);
}
TEST_F(Expression, LogicAndComparisonsGiveOneOrZero) {
  EXPECT_EQ(value("com.pos.z > 80 cm and contact.left"), 1.0);
  EXPECT_EQ(value("not contact.left or t >= 31 ms"), 0.0);
  EXPECT_EQ(value("1 != 2"), 1.0);
  EXPECT_EQ(value("in(lift)"), 1.0);
}
TEST_F(Expression, ChoiceTakesTheBranchOfItsCondition) {
  EXPECT_EQ(value("contact.left ? 2 m : 3 m", core::kLength), 2.0);
  EXPECT_EQ(value("not contact.left ? 1 : contact.left ? 2 : 3"), 2.0);
}
TEST_F(Expression, FunctionsHaveTheirUsualMeaning) {
  EXPECT_DOUBLE_EQ(value("sqrt(9 m^2)", core::kLength), 3.0);
  EXPECT_DOUBLE_EQ(value("hypot(3 cm, 4 cm)", core::kLength), 0.05);
  EXPECT_DOUBLE_EQ(value("atan2(1 m, 1 m)"), M_PI / 4);
  EXPECT_DOUBLE_EQ(value("clamp(5, 0, 2) + min(3, 1, 2) + max(1, 4) + abs(-1)"), 8.0);
  EXPECT_DOUBLE_EQ(value("log(exp(1)) + sin(0) + cos(0)"), 2.0);
}
TEST_F(Expression, DivisionByZeroIsNotFinite) {
  EXPECT_FALSE(std::isfinite(value("1/0")));
  EXPECT_FALSE(std::isfinite(value("log(-1)")));
  EXPECT_FALSE(std::isfinite(value("1/0 > 2")));
}
TEST_F(Expression, WhatDoesNotCountDoesNotHaveToBeFinite) {
  EXPECT_EQ(value("contact.left ? 1 : 1/0"), 1.0);
  EXPECT_EQ(value("contact.left or 1/0 > 1"), 1.0);
  EXPECT_EQ(value("not contact.left and 1/0 > 1"), 0.0);
}
TEST_F(Expression, EntryIsWhatTheReferenceStartedFrom) {
  const std::vector<std::string> axes = {"x", "z"};
  const double entry[2] = {1.0, 0.25};
  scope_.entry_axes = &axes;
  scope_.entry_axis = 1;
  scope_.entry_dimension = core::kLength;
  context_.entry = entry;
  EXPECT_DOUBLE_EQ(value("entry + 6 cm", core::kLength), 0.31);
  EXPECT_DOUBLE_EQ(value("entry.x", core::kLength), 1.0);
  EXPECT_EQ(error_of("1 m + entry.y", core::kLength), "6: the task has no axis 'y'");
}
TEST_F(Expression, AddingATimeToALengthIsAnErrorAtTheTime) {
  EXPECT_EQ(error_of("com.pos.z + $lift"), "12: cannot add a length and a time");
}
TEST_F(Expression, AWrongDimensionOfTheWholeIsAnError) {
  EXPECT_EQ(error_of("100 N", core::kTime), "0: expected a time, got a force");
}
TEST_F(Expression, AConditionIsAPlainNumber) {
  EXPECT_EQ(error_of("contact.left and com.pos.z"),
            "17: 'and' expects a plain number, got a length");
}
TEST_F(Expression, UnknownNamesComeWithASuggestion) {
  EXPECT_EQ(error_of("2*com.pos.y2"), "2: unknown signal 'com.pos.y2' (did you mean 'com.pos.z'?)");
  EXPECT_EQ(error_of("$lft"), "0: unknown parameter '$lft' (did you mean 'lift'?)");
  EXPECT_EQ(error_of("1 + sqr(2)"), "4: unknown function 'sqr' (did you mean 'sqrt'?)");
  EXPECT_EQ(error_of("scale + 1"), "0: unknown signal 'scale': a parameter is written '$scale'");
}
TEST_F(Expression, ComparisonsDoNotChain) {
  EXPECT_EQ(error_of("1 < 2 < 3"), "6: comparisons do not chain: write 'a < b and b < c'");
}
TEST_F(Expression, SyntaxErrorsSayWhatWasExpected) {
  EXPECT_EQ(error_of("(1 + 2"), "6: expected ')', got end of expression");
  EXPECT_EQ(error_of("1 + "), "4: expected a value, got end of expression");
  EXPECT_EQ(error_of("1 2"), "2: expected an operator, got a number");
  EXPECT_EQ(error_of("1 # 2"), "2: unexpected '#' in an expression");
  EXPECT_EQ(error_of("clamp(1, 2)"), "0: clamp() expects 3 arguments");
}
TEST_F(Expression, SignsOfOtherLanguagesAreNamedWithTheirWordHere) {
  EXPECT_EQ(error_of("contact.left = 1"), "13: unexpected '=' in an expression: equal is '=='");
  EXPECT_EQ(error_of("1 && 2"), "2: unexpected '&' in an expression: write 'and'");
  EXPECT_EQ(error_of("!contact.left"), "0: unexpected '!' in an expression: write 'not'");
  EXPECT_EQ(error_of("1/s"),
            "2: unknown signal 's': a unit stands right behind its number, as in '2 1/s'");
  EXPECT_EQ(error_of("max(1)"), "0: max() expects 2 arguments or more");
}
TEST_F(Expression, AVectorParameterNeedsAComponent) {
  EXPECT_EQ(error_of("$goal + 1"), "0: parameter 'goal' has 2 values: write $goal.x");
  EXPECT_EQ(error_of("$goal.z"), "0: parameter 'goal' has no component 'z'");
}
TEST_F(Expression, DeepNestingIsRefusedNotFatal) {
  EXPECT_NE(error_of(std::string(5000, '(') + "1").find("nested too deeply"), std::string::npos);
  EXPECT_NE(error_of(std::string(5000, '-') + "1").find("nested too deeply"), std::string::npos);
  std::string right = "1";
  for (int k = 0; k < 40; ++k) right = "1+(" + right + ")";
  EXPECT_NE(error_of(right).find("nested too deeply"), std::string::npos);
}
TEST_F(Expression, ALongFlatSumNeedsTwoPlacesOnly) {
  std::string sum = "1";
  for (int k = 0; k < 500; ++k) sum += " + 1";
  EXPECT_EQ(value(sum), 501.0);
}
TEST_F(Expression, AProductCountsOnceInTheSumThatFollows) {
  EXPECT_EQ(value("($scale + 1)*2 + 5 + 7"), 20.0);
  EXPECT_EQ(value("100 - ($scale + 1)*2 - 5"), 87.0);
  EXPECT_EQ(value("($scale + 1)*2 - $scale - 1"), 4.0);
  EXPECT_EQ(value("($scale + 1)*($scale + 2) - ($scale - 1)*($scale - 2) + ($scale + 3)*2"), 30.0);
  EXPECT_EQ(value("10 + (contact.left ? $scale + 4 : ($scale + 1)*2)"), 17.0);
}
TEST_F(Expression, AnExpressionOfThousandsOfTermsIsRefused) {
  std::string sum = "t";
  for (int k = 0; k < 3000; ++k) sum += " + t";
  EXPECT_EQ(error_of(sum), "0: expression of more than 4096 values and operations");
}
TEST_F(Expression, AQuantityIsTheSameNumberInsideAndOutsideOfExpressions) {
  for (const char* text : {"70 %", "3 ms", "145 ms", "6 cm", "8.3 deg", "1.1 mm", "0.7 1/s^2"}) {
    EXPECT_EQ(value(text), core::parse_quantity(text)->value) << text;
  }
}
TEST_F(Expression, UnitsEndWhereTheNextWordOrOperatorBegins) {
  EXPECT_EQ(value("3 m*2", core::kLength), 6.0);
  EXPECT_EQ(value("t < 2 s and 1 > 0"), 1.0);
  EXPECT_EQ(value("2 min", core::kTime), 120.0);
  EXPECT_EQ(value("5 N m", core::kTorque), 5.0);
  EXPECT_EQ(value("2 m*1 s", core::kLength * core::kTime), 2.0);
}
TEST_F(Expression, ASingleChoiceOfConditionsKeepsItsOtherBranchUnread) {
  EXPECT_EQ(value("contact.left ? (com.pos.z > 0.8 ? 1 : 2) + 0 : (1/0)*t/1 s"), 1.0);
  EXPECT_EQ(value("1 + (not contact.left ? 7 : (t + 70 ms)*10/1 s)"), 2.0);
  EXPECT_FALSE(std::isfinite(value("1/0 > 1 ? com.pos.z + 1 : com.pos.z + 2")));
}
TEST_F(Expression, UnitsToUnheardOfPowersAreRefused) {
  EXPECT_EQ(error_of("((2 m)^9)^9"), "10: no quantity has a unit to the power of more than 12");
}
TEST_F(Expression, StatisticsOverARunAreKnownOnlyWhereTheyHaveAMeaning) {
  EXPECT_EQ(error_of("rms(com.pos.z)"), "0: unknown function 'rms'");
  scope_.find_statistic = [&](const Statistic& statistic, bool magnitude, int signal) {
    return statistic.name == "rms" && !magnitude && signal == height_ ? contact_ : -1;
  };
  EXPECT_EQ(value("rms(com.pos.z) < 2 m"), 1.0);
  EXPECT_EQ(error_of("rms(com.pos.z) < 2 s"), "17: cannot compare a length and a time");
  EXPECT_EQ(value("max(com.pos.z, 2 m)", core::kLength), 2.0);
  scope_.find_statistic = [&](const Statistic& statistic, bool magnitude, int signal) {
    return statistic.name == "max" && magnitude && signal == height_ ? contact_ : -1;
  };
  EXPECT_EQ(value("max(abs(com.pos.z)) < 2 m"), 1.0);
  EXPECT_EQ(error_of("rms(abs(com.pos.z))"), "0: no rms() of this signal");
  EXPECT_EQ(value("min(com.pos.z, 5 cm)", core::kLength), 0.05);
}
TEST_F(Expression, OnlyExpressionsWithoutNamesAreConstant) {
  ExpressionError error;
  EXPECT_TRUE(pool_[compile_expression("2*3 cm", scope_, {}, pool_, error)].constant);
  EXPECT_FALSE(pool_[compile_expression("t", scope_, {}, pool_, error)].constant);
}

}  // namespace
}  // namespace footfall::tests
