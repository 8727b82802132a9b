// Ranges of live parameters, and edits, against the planner: of balance_best, whose time to
// velocity reversal is 200 ms, so that a step of T = transition + lift + land, and what else is
// timed before it, lasts 400 ms at most.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "behaviors/check/physics/check.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

std::unique_ptr<behaviors::Behavior> derived(const std::string& parameters) {
  core::Diagnostics diagnostics;
  auto behavior = behaviors::load_behavior_text("base: balance_best\nparameters:\n" + parameters,
                                                "b.yaml", options_for_tests(), diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.to_string();
  return behavior;
}

std::string findings(const behaviors::Behavior& behavior) {
  core::Diagnostics diagnostics;
  behaviors::check_physics(behavior, diagnostics);
  std::string text;
  for (const auto& item : diagnostics.all()) text += item.text + "\n";
  return text;
}

TEST(LiveRanges, TheGoodPartOfARangeIsNamed) {
  EXPECT_EQ(findings(*derived("  lift_time: {range: [80 ms, 200 ms]}\n")), "");
  const std::string said = findings(*derived("  lift_time: {range: [80 ms, 400 ms]}\n"));
  EXPECT_THAT(said, ContainsRegex("only 80 ms to 2(09.*|10) ms of the range of 'lift_time', 80 ms "
                                  "to 400 ms"));
  EXPECT_THAT(said, HasSubstr("beyond it planner 'foot' diverges"));
  EXPECT_THAT(findings(*derived("  land_time: {range: [80 ms, 400 ms]}\n")),
              ContainsRegex("only 80 ms to 21(4.*|5) ms of the range of 'land_time'"));
}

TEST(LiveRanges, APartInWhichATimeIsNegativeIsNamed) {
  const std::string both =
      findings(*derived("  dual_time: {value: 16 ms, range: [-10 ms, 40 ms], live: true}\n"));
  EXPECT_THAT(both, ContainsRegex("only (-0\\.|0|0\\.).* ms to 40 ms of the range of 'dual_time'"));
  EXPECT_THAT(both, HasSubstr("a time in state 'step.right_foot.dual' is -10 ms"));
  EXPECT_EQ(findings(*derived("  dual_time: {value: 16 ms, range: [4 ms, 40 ms], live: true}\n")),
            "");
}

TEST(LiveRanges, AFootThatStoodIsNotSentIntoTheGround) {
  EXPECT_THAT(findings(*derived("  clearance: {value: -6 cm}\n")),
              HasSubstr("task 'swing' asks for a foot at a height of -0.06 m from where it stood"));
  EXPECT_THAT(findings(*derived("  clearance: {value: 6 cm, range: [-3 cm, 8 cm], live: true}\n")),
              HasSubstr("of the range of 'clearance'"));
  EXPECT_THAT(findings(*derived("  clearance: {value: -1 cm}\n")), HasSubstr("in the ground"));
  EXPECT_EQ(findings(*derived("  clearance: {value: 2 cm}\n")), "");
}

TEST(LiveRanges, AnEditIsJudgedWithTheOthersAtTheirNewValues) {
  const auto behavior = derived("  goal: {value: [0, 0]}\n");
  behaviors::EditedValues edited(*behavior);
  const auto slot = [&](const char* name) {
    const int index = behavior->find_parameter(name);
    return static_cast<std::size_t>(behavior->parameters[static_cast<std::size_t>(index)].slot);
  };
  std::vector<double> values = behavior->values;
  EXPECT_TRUE(edited.errors(values).empty());
  values[slot("lift_time")] = 0.19;
  EXPECT_TRUE(edited.errors(values).empty());
  values[slot("land_time")] = 0.19;  // each alone is good
  ASSERT_EQ(edited.errors(values).size(), 1U);
  EXPECT_THAT(edited.errors(values)[0].text, HasSubstr("planner 'foot' diverges"));
  EXPECT_TRUE(edited.errors(behavior->values).empty());
}

}  // namespace
}  // namespace footfall::tests
