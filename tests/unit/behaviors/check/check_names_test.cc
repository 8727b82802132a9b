// Events and names that nothing uses, and mistakes in --set: found, and said once.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(CheckEvents, APrefixThatMatchesNothingIsSaid) {
  EXPECT_EQ(
      problems(chart("  states: {a: {transitions: [{on: falt.*, to: b}]}, b: {type: final}}")),
      "b.yaml:3:35: warning: nothing raises 'falt.*', and `events` does not list it (did you "
      "mean 'fault.*'?)\n");
  EXPECT_EQ(
      problems(chart("  states: {a: {transitions: [{on: fault*, to: b}]}, b: {type: final}}")),
      "b.yaml:3:35: error: 'fault*' is no prefix of events (did you mean 'fault.*'?)\n");
  EXPECT_EQ(problems(chart("  states: {a: {transitions: [{on: [fault.*, error.*, done.*, '*'], to: "
                           "b}]}, b: {type: final}}")),
            "");
}
TEST(CheckEvents, AnEventThatNothingListensToIsSaidWhereItIsRaised) {
  EXPECT_EQ(
      problems(chart("  states:\n    a: {on_entry: [{raise: gone}], transitions: [{on: go, to: "
                     "b}]}\n    b: {type: final, on_entry: [{raise: go}]}\n")),
      "b.yaml:4:28: warning: nothing listens to 'gone'\n");
}
TEST(CheckEvents, AListedEventThatNothingListensToIsSaidInTheList) {
  EXPECT_EQ(problems("behavior: 1\nevents: {stop: '', start: ''}\nmachine:\n"
                     "  states: {a: {transitions: [{on: stop, to: b}]}, b: {type: final}}\n"),
            "b.yaml:2:20: warning: nothing listens to 'start'\n");
}
TEST(CheckEvents, AMisspeltEventIsOneWarning) {
  EXPECT_EQ(problems(chart("  on_entry: [{raise: tuchdown}]\n  states: {a: {transitions: [{on: "
                           "touchdown, to: b}]}, b: {type: final}}")),
            "b.yaml:4:35: warning: nothing raises 'touchdown', and `events` does not list it (did "
            "you mean 'tuchdown'?)\n");
}
TEST(CheckEvents, AStateWithoutAnEndIsNeverDone) {
  EXPECT_EQ(
      problems(chart("  states:\n    a: {states: {x: {}}, transitions: [{on: done.state.a, to: "
                     "b}]}\n    b: {type: final}\n")),
      "b.yaml:4:45: warning: 'a' is never done: it has no `type: final` state that would end "
      "it\n");
}
TEST(CheckEvents, AParallelStateIsDoneAsItsRegionsSay) {
  const auto with = [](const std::string& done) {
    return problems(chart("  states:\n    p:\n      type: parallel\n      " + done +
                          "\n      transitions: [{on: done.state.p, to: q}]\n      states:\n"
                          "        l: {states: {w: {after: 1 s, to: x}, x: {type: final}}}\n"
                          "        r: {states: {y: {}}}\n    q: {type: final}\n"));
  };
  EXPECT_EQ(with("done: any"), "");
  EXPECT_EQ(with("done: l"), "");
  EXPECT_NE(with("done: all").find("b.yaml:7:26: warning: 'p' is never done"), std::string::npos);
  EXPECT_NE(with("done: r").find("b.yaml:7:26: warning: 'p' is never done"), std::string::npos);
}

TEST(CheckUnused, AParameterThatNothingReadsIsSaid) {
  EXPECT_EQ(
      problems("behavior: 1\nparameters:\n  lift: 1 s\n  lnad: 1 s\n  seen: 0\n  shown: 0\n"
               "  button: {value: 0, range: [0, 1], live: true}\nmachine:\n  states:\n"
               "    a: {after: $lift, to: b, on_entry: [{set: {seen: 1}}, {log: '{$shown}'}]}\n"
               "    b: {transitions: [{on: parameter.changed.button, to: a}]}\n"),
      "b.yaml:4:3: warning: parameter 'lnad' is never used: nothing reads $lnad\n"
      "b.yaml:5:3: warning: parameter 'seen' is set, but never used: nothing reads $seen\n");
}
TEST(CheckUnused, AnArgumentThatTheTemplateDoesNotUseIsSaid) {
  EXPECT_EQ(
      problems("behavior: 1\ntemplates:\n  s: {args: [time, spare], states: {a: {after: $time, "
               "to: b}, b: {type: final}}}\n"
               "machine: {states: {x: {use: s, with: {time: 1 s, spare: 2}}}}\n"),
      "b.yaml:3:20: warning: argument 'spare' of template 's' is never used\n");
}
TEST(CheckUnused, WhatARobotControlsWithIsSaidToo) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\ntorque_loop: {soft: {p: 1}, hard: {p: 2}}\n"
                     "planners: {foot: {type: velocity_reversal}}\n"
                     "stacks: {s: {contacts: [right_foot]}, u: {contacts: []}}\n"
                     "machine: {stack: s, torque_loop: {left_foot: soft}}\n"),
            "b.yaml:3:29: warning: torque_loop table 'hard' is never used\n"
            "b.yaml:4:12: warning: no state invokes planner 'foot': it never plans\n"
            "b.yaml:5:39: warning: stack 'u' is never used, and not checked\n");
}
TEST(CheckUnused, AMisspeltNameIsOneErrorNotAlsoAnUnusedOne) {
  EXPECT_EQ(
      problems("behavior: 1\nparameters: {lift: 1 s}\nmachine: {states: {a: {after: $lfit, to: "
               "b}, b: {type: final}}}\n")
          .find("never used"),
      std::string::npos);
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\ngains: {g: {f: {kp: 1}}}\nstacks:\n"
               "  s: {gains: g, tasks: {f: {type: com_postion, reference: 0}}, contacts: []}\n"
               "machine: {stack: s}\n"),
      "b.yaml:5:35: error: unknown task type 'com_postion' (did you mean 'com_position'?)\n");
}

TEST(CheckOverrides, AWrongDimensionIsOneErrorThatNamesTheOverride) {
  auto options = options_for_tests();
  options.set = {{"lift_time", "5 N"}};
  core::Diagnostics diagnostics;
  EXPECT_FALSE(behaviors::load_behavior(balance_path(), options, diagnostics));
  EXPECT_EQ(diagnostics.to_string(),
            "--set lift_time:1:1: error: --set lift_time: expected a time, got '5 N'\n");
}
TEST(CheckOverrides, WhatTheFileNeedsIsSaidAtTheOverride) {
  auto options = options_for_tests();
  options.set = {{"goal", "[1 s, 2 s]"}, {"lift_time", "140 ms"}};
  core::Diagnostics diagnostics;
  EXPECT_FALSE(behaviors::load_behavior(balance_path(), options, diagnostics));
  const std::string text = diagnostics.to_string();
  EXPECT_TRUE(text.starts_with("--set goal:1:1: error: expected a length, got a time (needed at "))
      << text;
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
}
TEST(CheckOverrides, AFileThatIsWrongItselfIsSaidAsItIs) {
  auto options = options_for_tests();
  options.set = {{"d", "2 s"}};
  EXPECT_EQ(
      problems("behavior: 1\nparameters: {d: 1 s}\nmachine: {states: {a: {after: $d, to: bb}, b: "
               "{after: $d, to: a}}}\n",
               options),
      "b.yaml:3:39: error: unknown state 'bb' (did you mean 'b'?)\n");
}

}  // namespace
}  // namespace footfall::tests
