// Gains of torque loops back into their files: globs and joints without entry stay where they can.
#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

#include "tests/unit/behaviors/save/save_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::NamedValue;

class SaveTorqueLoops : public SaveTest {};

std::string with_tables(const std::string& tables) {
  return "behavior: 1\nrobot: hume\ntorque_loop:\n  ranges: {p: [0, 100], i: [0, 50], d: [0, "
         "80]}\n" +
         tables + "machine: {torque_loop: {right_leg: t, left_leg: t}}\n";
}

TEST_F(SaveTorqueLoops, AJointThatIsEditedGetsItsOwnEntryWhereAGlobServesOthersToo) {
  EXPECT_EQ(saved(with_tables("  t: {p: {\"*hip\": 43 rad/s/Nm, right_knee: 22}}  # Table I\n"),
                  {{"torque_loop.t.p.left_hip", {40.5}}, {"torque_loop.t.p.right_knee", {21.0}}}),
            with_tables("  t: {p: {\"*hip\": 43 rad/s/Nm, right_knee: 21, left_hip: 40.5 rad/s/Nm}}"
                        "  # Table I\n"));
}

TEST_F(SaveTorqueLoops, AGlobWhoseJointsAreAllEditedAlikeChangesItself) {
  EXPECT_EQ(saved(with_tables("  t:\n    p: {\"*hip\": 43, \"*knee\": 22}\n"),
                  {{"torque_loop.t.p.left_hip", {40.5}}, {"torque_loop.t.p.right_hip", {40.5}}}),
            with_tables("  t:\n    p: {\"*hip\": 40.5, \"*knee\": 22}\n"));
}

TEST_F(SaveTorqueLoops, AJointWithoutEntryGetsOneWhenItIsEdited) {
  EXPECT_EQ(saved(with_tables("  t: {type: direct, d: {right_hip: 30}}\n"),
                  {{"torque_loop.t.d.left_knee", {41.0}}}),
            with_tables("  t: {type: direct, d: {right_hip: 30, left_knee: 41}}\n"));
}

TEST_F(SaveTorqueLoops, OneNumberBecomesAMapByJointOnlyIfJointsDiffer) {
  const std::string text = with_tables("  t: {type: direct, d: 30 Nm s/rad}\n");
  EXPECT_EQ(saved(text, {{"torque_loop.t.d", std::vector<double>(6, 31.0)}}),
            with_tables("  t: {type: direct, d: 31 Nm s/rad}\n"));
  EXPECT_EQ(saved(text, {{"torque_loop.t.d.right_knee", {31.0}}}),
            with_tables("  t: {type: direct, d: {\"*\": 30 Nm s/rad, right_knee: 31 Nm s/rad}}\n"));
}

TEST_F(SaveTorqueLoops, WhatLiveDoorsRefuseIsNotSaved) {
  put("b.yaml", with_tables("  t: {p: 43, velocity_p: 5}\n"));
  EXPECT_EQ(refusal("b.yaml", {{"torque_loop.t.p.right_hip", {101.0}}}),
            "b.yaml:5:10: torque_loop.t.p: 101 is outside its range, 0 to 100 rad/s/Nm\n");
  EXPECT_EQ(refusal("b.yaml", {{"torque_loop.t.velocity_p.right_hip", {-1.0}}}),
            "b.yaml:5:26: torque_loop.t.velocity_p: a gain cannot be negative\n");
}

TEST_F(SaveTorqueLoops, AnOverlayHoldsOnlyTheJointsThatDiffer) {
  put("b.yaml", with_tables("  t: {p: {\"*hip\": 43, right_knee: 22}}\n"));
  const auto made = plan("b.yaml", {{"torque_loop.t.p.left_hip", {40.5}}}, "over.yaml");
  ASSERT_FALSE(made.refused()) << made.refusals.front();
  ASSERT_TRUE(behaviors::write_saved(made).empty());
  EXPECT_EQ(get("over.yaml"),
            "behavior: 1\nbase: b.yaml\ntorque_loop:\n  t:\n    p: {left_hip: 40.5}\n");
}

std::vector<std::uint64_t> bits_of(const std::vector<double>& values) {
  std::vector<std::uint64_t> bits;
  for (const double value : values) bits.push_back(std::bit_cast<std::uint64_t>(value));
  return bits;
}

TEST_F(SaveTorqueLoops, RandomEditsReadBackBitForBitAndLeaveTheOtherValues) {
  const std::string text = with_tables(
      "  t:\n    p: {\"*hip\": 43 rad/s/Nm, right_knee: 22, \"*abduction\": 2.84}  # Table I\n"
      "    i:\n      \"*\": 0.15\n      left_hip: 3\n    velocity_p: 5 Nm s/rad\n"
      "  u: {type: direct, d: {left_hip: 30}, p: 20, i: 1 1/s}\n");
  std::mt19937_64 random(42);
  put("b.yaml", text);
  for (int round = 0; round < 200; ++round) {
    if (round % 20 == 0) put("b.yaml", text);
    core::Diagnostics diagnostics;
    const auto before = behaviors::load_behavior(file("b.yaml"), options_for_tests(), diagnostics);
    ASSERT_TRUE(before) << diagnostics.to_string();
    std::vector<NamedValue> edits;
    std::vector<double> expected = before->values;
    for (const auto& info : before->parameters) {
      if (random() % 2 == 0) continue;
      const double most = info.has_range() ? info.max : 10.0;
      const double shared = std::uniform_real_distribution(0.0, most)(random);
      NamedValue value{info.name, {}};
      for (int k = 0; k < info.size; ++k) {
        double& number = expected[static_cast<std::size_t>(info.slot + k)];
        const auto kind = random() % 4;
        if (kind == 0) number = shared;
        if (kind == 1) number = std::uniform_real_distribution(0.0, most)(random);
        if (kind == 2) number = std::round(10.0 * shared) / 10.0;
        value.values.push_back(number);
      }
      edits.push_back(std::move(value));
    }
    const auto made = plan("b.yaml", edits);
    ASSERT_FALSE(made.refused()) << round << ": " << made.refusals.front() << "\n" << get("b.yaml");
    ASSERT_TRUE(behaviors::write_saved(made).empty());
    const auto after = behaviors::load_behavior(file("b.yaml"), options_for_tests(), diagnostics);
    ASSERT_TRUE(after) << diagnostics.to_string();
    ASSERT_EQ(bits_of(after->values), bits_of(expected)) << round << "\n" << get("b.yaml");
  }
}

}  // namespace
}  // namespace footfall::tests
