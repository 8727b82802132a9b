// Values back into their files: what is expected is written out by hand.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "behaviors/save/values.h"
#include "tests/unit/behaviors/save/save_test_support.h"

namespace footfall::tests {
namespace {

class SaveValues : public SaveTest {};

// A pure statechart with these parameters.
std::string with_parameters(const std::string& parameters) {
  return "behavior: 1\nparameters:\n" + parameters +
         "machine: {states: {a: {after: 1 s, to: a}}}\n";
}

// A robot's behavior with these gains for height (z), attitude (pitch, roll) and rest (joints).
std::string with_gains(const std::string& gains) {
  return "behavior: 1\nrobot: hume\ngains:\n" + gains + R"(stacks:
  both:
    contacts: [right_foot, left_foot]
    gains: g
    tasks:
      height: {type: com_position, axes: [z], priority: 1, reference: entry}
      attitude: {type: body_orientation, axes: [pitch, roll], priority: 1, reference: 0}
      rest: {type: joint_damping, priority: 2}
machine: {stack: both, states: {a: {after: 1 s, to: a}}}
)";
}

TEST_F(SaveValues, OnlyTheNumberChangesAndItsUnitStays) {
  EXPECT_EQ(
      saved(with_parameters("  t: {value:  145 ms , range: [80 ms, 400 ms], live: true}  # ö\n"
                            "  u:   {doc: x, value: \"3cm\"}\n"
                            "  v: 7 %       # short\n"),
            {{"t", {0.16}}, {"u", {0.04}}, {"v", {0.085}}}),
      with_parameters("  t: {value:  160 ms , range: [80 ms, 400 ms], live: true}  # ö\n"
                      "  u:   {doc: x, value: \"4cm\"}\n"
                      "  v: 8.5 %       # short\n"));
}

TEST_F(SaveValues, LineEndsAndAMissingLastOneStay) {
  EXPECT_EQ(saved("behavior: 1\r\nmachine: {states: {a: {after: 1 s, to: a}}}\r\nparameters:\r\n"
                  "  t:\r\n    value: 1 s\r\n    range: [0 s, 9 s]\r\n    live: true\r\n  u: 2 m",
                  {{"t", {1.5}}, {"u", {3.0}}}),
            "behavior: 1\r\nmachine: {states: {a: {after: 1 s, to: a}}}\r\nparameters:\r\n"
            "  t:\r\n    value: 1.5 s\r\n    range: [0 s, 9 s]\r\n    live: true\r\n  u: 3 m");
}

TEST_F(SaveValues, OfAListOnlyWhatDiffersChanges) {
  const std::string text = with_parameters("  goal: {value: [ 0,  -10 cm, 2 m ]}\n");
  EXPECT_EQ(saved(text, {{"goal", {0.0, 0.25, 2.0}}}),
            with_parameters("  goal: {value: [ 0,  25 cm, 2 m ]}\n"));
  EXPECT_EQ(saved(text, {{"goal.z", {3.0}}, {"goal.x", {1.0}}}),
            with_parameters("  goal: {value: [ 1,  -10 cm, 3 m ]}\n"));
  EXPECT_EQ(saved(text, {{"goal", {0.0, -0.1, 2.0}}}), text);
}

TEST_F(SaveValues, AUnitThatCannotSayItGivesWayToSi) {
  // 0.1 rad: 0.1*180/pi deg reads as 0.1 or its neighbour; 0.05 rad has no number of degrees.
  const std::string text = with_parameters("  a: {value: 5 deg}\n");
  double odd = 0.05;
  for (int k = 0; k < 100 && saved(text, {{"a", {odd}}}).find("rad") == std::string::npos; ++k) {
    odd = std::nextafter(odd, 1.0);
  }
  EXPECT_EQ(saved(text, {{"a", {odd}}}),
            with_parameters(fmt::format("  a: {{value: {} rad}}\n", odd)));
}

TEST_F(SaveValues, GainsStandInTheirTable) {
  EXPECT_EQ(saved(with_gains("  ranges: {kp: [0, 800], kd: [0, 120]}\n"
                             "  g:\n    height: {kp: 270, kd: 10}\n"
                             "    attitude:\n      kp: [200, 210]  # pitch, roll\n"
                             "      kd: {roll: 10, pitch: 15}\n    rest: {kd: 2}\n"),
                  {{"gains.g.height.kp", {280.0}},
                   {"gains.g.attitude.kp", {200.0, 215.5}},
                   {"gains.g.attitude.kd", {16.0, 10.0}},
                   {"gains.g.rest.kd", {3.0, 3.0, 3.0, 3.0, 3.0, 3.0}}}),
            with_gains("  ranges: {kp: [0, 800], kd: [0, 120]}\n"
                       "  g:\n    height: {kp: 280, kd: 10}\n"
                       "    attitude:\n      kp: [200, 215.5]  # pitch, roll\n"
                       "      kd: {roll: 10, pitch: 16}\n    rest: {kd: 3}\n"));
}

TEST_F(SaveValues, OneNumberForAllBecomesOneForEach) {
  EXPECT_EQ(saved(with_gains("  g: {height: {kp: 9, kd: 1}, attitude: {kp: 200, kd: \"15\"},\n"
                             "      rest: {kd: 2}}  # damping\n"),
                  {{"gains.g.attitude.kp", {200.0, 210.0}},
                   {"gains.g.attitude.kd", {16.0, 15.0}},
                   {"gains.g.rest.kd", {2.0, 2.0, 3.0, 2.0, 2.0, 4.0}}}),
            with_gains("  g: {height: {kp: 9, kd: 1}, attitude: {kp: [200, 210], kd: [16, 15]},\n"
                       "      rest: {kd: {\"*\": 2, right_knee: 3, left_knee: 4}}}  # damping\n"));
}

TEST_F(SaveValues, AJointThatLeavesItsPatternGetsAnEntry) {
  const auto rest = [](const std::string& kd) {
    return with_gains(
        "  g:\n    height: {kp: 9, kd: 1}\n    attitude: {kp: 9, kd: 1}\n"
        "    rest:\n      kd:" +
        kd);
  };
  // Joints: abduction, hip and knee of the right leg, then of the left.
  EXPECT_EQ(saved(rest(" {\"*knee\": 2, \"*hip\": 3}  # c\n"),
                  {{"gains.g.rest.kd", {0.0, 5.0, 2.0, 0.0, 5.0, 4.0}}}),
            rest(" {\"*knee\": 2, \"*hip\": 5, left_knee: 4}  # c\n"));
  EXPECT_EQ(saved(rest("\n        \"*knee\": 2\n        \"*hip\": 3  # c\n"),
                  {{"gains.g.rest.kd", {1.0, 3.0, 6.0, 0.0, 3.0, 2.0}}}),
            rest("\n        \"*knee\": 2\n        \"*hip\": 3  # c\n        right_abduction: 1\n"
                 "        right_knee: 6\n"));
}

TEST_F(SaveValues, GainsWrittenInATaskStandThere) {
  const auto text = [](const std::string& kp, const std::string& stiff) {
    return R"(behavior: 1
robot: hume
templates:
  t:
    args: [foot, stiff]
    contacts: [right_foot, left_foot]
    tasks:
      height: {type: com_position, axes: [z], reference: entry, gains: {kp: )" +
           kp + R"(, kd: $stiff}}
    after: 1 s
    to: done
machine:
  states:
    pair: {states: {a: {use: t, with: {foot: right_foot, stiff: )" +
           stiff + R"(}}, done: {type: final}}}
)";
  };
  EXPECT_EQ(saved(text("100", "20"),
                  {{"gains.pair.a.height.kp", {120.0}}, {"gains.pair.a.height.kd", {25.0}}}),
            text("120", "25"));
}

TEST_F(SaveValues, OneTextOfTwoMirrorImagesNeedsOneValue) {
  const std::string text = R"(behavior: 1
robot: hume
templates:
  t:
    args: [foot]
    states:
      go:
        contacts: [right_foot, left_foot]
        tasks: {height: {type: com_position, axes: [z], reference: entry, gains: {kp: 100, kd: 20}}}
        after: 1 s
        to: down
      down: {type: final}
machine: {states: {step: {mirror: t, with: {foot: right_foot}}}}
)";
  const std::string left = "gains.step.left_foot.go.height.kp";
  const std::string right = "gains.step.right_foot.go.height.kp";
  std::string expected = text;
  expected.replace(expected.find("kp: 100"), 7, "kp: 120");
  EXPECT_EQ(saved(text, {{left, {120.0}}, {right, {120.0}}}), expected);
  put("b.yaml", text);
  EXPECT_EQ(refusal("b.yaml", {{left, {120.0}}}),
            right +
                ": it shares its text with what is saved and would become 120 too "
                "(save the same value for both)\n");
  EXPECT_EQ(refusal("b.yaml", {{left, {120.0}}, {right, {130.0}}}),
            "b.yaml:9:87: " + left + ": it shares its text with " + right +
                ", which gets another value\n");
}

TEST_F(SaveValues, AnAnchorIsChangedIfAllItsUsersAgree) {
  const auto text = [](const char* number) {
    return with_parameters(
        fmt::format("  a: {{value: &x {} ms, range: [1 ms, 9 s], live: true}}\n"
                    "  b: {{value: *x}}\n",
                    number));
  };
  EXPECT_EQ(saved(text("20"), {{"a", {0.03}}, {"b", {0.03}}}), text("30"));
  put("b.yaml", text("20"));
  EXPECT_EQ(refusal("b.yaml", {{"b", {0.03}}}),
            "a: it shares its text with what is saved and would become 0.03 too "
            "(save the same value for both)\n");
  EXPECT_EQ(refusal("b.yaml", {{"a", {0.03}}, {"b", {0.04}}}),
            "b.yaml:4:14: b: it shares its text with a, which gets another value\n");
}

TEST_F(SaveValues, AnAnchorThatSomethingElseUsesIsNotChanged) {
  put("b.yaml",
      "behavior: 1\nparameters:\n  a: {value: &x 20 ms}\n"
      "machine: {states: {a: {after: *x, to: a}}}\n");
  EXPECT_EQ(refusal("b.yaml", {{"a", {0.03}}}),
            "machine.states.a.after would change too: it shares its text with what is saved\n");
}

TEST_F(SaveValues, OfAVariableTheFirstValueIsWrittenAndANoteSaysIfItIsNeverUsed) {
  const auto text = [](const char* count, const char* height) {
    return fmt::format(R"(behavior: 1
robot: hume
parameters:
  count: {{value: {}}}
  height: {{value: {}}}
machine:
  states:
    a: {{on_entry: [{{set: {{height: com.pos.z}}}}], on_exit: [{{set: {{count: "= $count + 1"}}}}], after: 1 s, to: a}}
)",
                       count, height);
  };
  EXPECT_EQ(saved(text("0", "90 cm"), {{"count", {3.0}}}), text("3", "90 cm"));
  EXPECT_TRUE(plan("b.yaml", {{"count", {5.0}}}).notes.empty());
  const auto made = plan("b.yaml", {{"height", {0.8}}});
  ASSERT_EQ(made.notes.size(), 1U);
  EXPECT_EQ(made.notes[0], file("b.yaml") +
                               ":8:35: the entry of 'a' sets 'height' at the start of "
                               "a run: its value in the file is never used");
}

TEST_F(SaveValues, WhatCannotBeSavedSaysWhy) {
  put("b.yaml", R"(behavior: 1
robot: hume
parameters:
  stiff: {value: 100, range: [0, 500], live: true}
  count: {value: 0}
gains: {ranges: {kd: [0, 50]}, g: {height: {kp: "= 2*$stiff", kd: 10}}}
machine:
  contacts: [right_foot, left_foot]
  gains: g
  tasks: {height: {type: com_position, axes: [z], reference: entry}}
  on_entry: [{set: {count: "= $count + 1"}}]
  states: {a: {after: 1 s, to: a}}
)");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(
      refusal("b.yaml", {{"gains.g.height.kp", {3.0}}}),
      "gains.g.height.kp: it is given by an expression, \"= 2*$stiff\": save the parameters in "
      "it\n");
  EXPECT_EQ(refusal("b.yaml", {{"stif", {3.0}}, {"stiff", {600.0}}, {"gains.g.height.kd", {-1.0}}}),
            "stif: there is no such parameter or gain (did you mean 'stiff'?)\n"
            "b.yaml:4:18: stiff: 600 is outside its range, 0 to 500\n"
            "b.yaml:6:67: gains.g.height.kd: -1 is outside its range, 0 to 50 1/s\n");
  EXPECT_EQ(refusal("b.yaml", {{"stiff", {nan}}}),
            "b.yaml:4:18: stiff: nan is not a finite number\n");
  EXPECT_EQ(refusal("b.yaml", {{"stiff", {1.0, 2.0}}}), "stiff: expected 1 values, got 2\n");
  EXPECT_EQ(refusal("b.yaml", {{"stiff", {1.0}}, {"stiff", {2.0}}}),
            "stiff: it is asked for twice, with different values\n");
}

TEST_F(SaveValues, AFileThatChangedMeanwhileStaysAsItIs) {
  const std::string text = with_parameters("  t: 1 s\n");
  put("b.yaml", text);
  const auto made = plan("b.yaml", {{"t", {2.0}}});
  put("b.yaml", text + "# edited\n");
  ASSERT_EQ(behaviors::write_saved(made).size(), 1u);
  EXPECT_EQ(get("b.yaml"), text + "# edited\n");
}

TEST_F(SaveValues, AnOverrideFromTheCommandLineIsNotSavedOfItself) {
  put("b.yaml", with_parameters("  t: 1 s\n  u: 1 s\n"));
  behaviors::LoadOptions options = options_for_tests();
  options.set = {{"t", "5 s"}};
  core::Diagnostics diagnostics;
  const auto made = behaviors::plan_save(file("b.yaml"), options, {{"u", {2.0}}}, {}, diagnostics);
  ASSERT_EQ(made.files.size(), 1u);
  EXPECT_EQ(made.files[0].after, with_parameters("  t: 1 s\n  u: 2 s\n"));
}

TEST_F(SaveValues, AFileThatDoesNotLoadSaysSo) {
  put("b.yaml", "behavior: 1\nmachine: {states: {a: {to: b}}}\n");
  core::Diagnostics diagnostics;
  EXPECT_TRUE(
      behaviors::plan_save(file("b.yaml"), options_for_tests(), {{"t", {1.0}}}, {}, diagnostics)
          .refused());
  EXPECT_TRUE(diagnostics.has_errors());
}

}  // namespace
}  // namespace footfall::tests
