// Transitions that are never taken, re-enter regions, or loop within a tick: found, and only those.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

// A chart with events e and f, a parameter $p that anyone may change and one $v that actions set.
std::string machine(const std::string& lines) {
  return "behavior: 1\nevents: {e: '', f: ''}\n"
         "parameters: {p: {value: 0, range: [0, 9], live: true}, v: 0}\nmachine:\n"
         "  transitions: [{on: [e, f], when: $p + $v > 8, do: [{mark: m}, {set: {v: 1}}]}]\n" +
         lines;
}

TEST(CheckTransitions, AConstantConditionThatIsFalseIsSaidAtTheCondition) {
  EXPECT_EQ(problems(machine("  states:\n    a: {transitions: [{on: e, when: 1 > 2, to: b}, {on: "
                             "e, to: b}]}\n    b: {after: 1 s, to: a}\n")),
            "b.yaml:7:37: warning: `when` is never true: this transition is never taken\n");
}
TEST(CheckTransitions, AnArgumentMaySwitchATransitionOff) {
  const std::string file =
      "behavior: 1\ntemplates:\n  s: {args: [n], states: {a: {transitions: [{when: $n > 1 , to: "
      "b}], after: 1 s, to: b}, b: {type: final}}}\n";
  EXPECT_EQ(problems(file + "machine: {states: {x: {use: s, with: {n: 1}, after: 9 s, to: y}, "
                            "y: {use: s, with: {n: 2}}}}\n"),
            "");
}

TEST(CheckTransitions, TheSameEventTwiceIsNeverTakenTheSecondTime) {
  EXPECT_EQ(problems(machine("  states:\n    a:\n      transitions:\n        - {on: e, to: b}\n"
                             "        - {on: e, to: c}\n"
                             "    b: {after: 1 s, to: c}\n    c: {after: 1 s, to: a}\n")),
            "b.yaml:10:11: warning: this transition is never taken: the one at b.yaml:9:11 is, "
            "whenever this could be\n");
}
TEST(CheckTransitions, AMoreGeneralOneGoesBefore) {
  const auto second = [](const std::string& first, const std::string& later) {
    const std::string text =
        problems(machine("  states:\n    a:\n      transitions:\n        - " + first +
                         "\n        - " + later + "\n    b: {after: 1 s, to: a}\n"));
    return text.starts_with("b.yaml:10:11: warning: this transition is never taken: ");
  };
  EXPECT_TRUE(second("{on: '*', to: b}", "{on: e, to: b}"));
  EXPECT_TRUE(second("{on: fault.*, to: b}", "{on: fault.fall, to: b}"));
  EXPECT_TRUE(second("{on: [e, f], to: b}", "{on: f, when: $p > 1, to: b}"));
  EXPECT_TRUE(second("{on: e, when: $p > 1, to: b}", "{on: e, when: $p > 1, to: b}"));
  EXPECT_TRUE(second("{on: e, when: 2 > 1, to: b}", "{on: e, to: b}"));
  EXPECT_TRUE(second("{after: 1 s, to: b}", "{after: 2 s, to: b}"));
  EXPECT_TRUE(second("{after: 1 s, to: b}", "{after: 1 s, when: $p > 1, to: b}"));
  EXPECT_TRUE(second("{when: $p > 1, to: b}", "{on: e, when: $p > 1, to: b}"));
}
TEST(CheckTransitions, WhatMayStillBeTakenIsNotSaidToBeHidden) {
  const auto clean = [](const std::string& first, const std::string& later) {
    return problems(machine("  states:\n    a:\n      transitions:\n        - " + first +
                            "\n        - " + later + "\n    b: {after: 1 s, to: a}\n"));
  };
  EXPECT_EQ(clean("{on: e, when: $p > 1, to: b}", "{on: e, to: b}"), "");
  EXPECT_EQ(clean("{on: e, when: $p > 1, to: b}", "{on: e, when: $p > 2, to: b}"), "");
  EXPECT_EQ(clean("{on: fault.fall, to: b}", "{on: fault.*, to: b}"), "");
  EXPECT_EQ(clean("{on: e, to: b}", "{on: [e, f], to: b}"), "");
  EXPECT_EQ(clean("{on: e, after: 1 s, to: b}", "{on: e, to: b}"), "");
  EXPECT_EQ(clean("{after: 2 s, to: b}", "{after: 1 s, to: b}"), "");
  EXPECT_EQ(clean("{after: \"= $p*1 s\", to: b}", "{after: 3 s, to: b}"), "");
  EXPECT_EQ(clean("{after: 1 s, do: [{mark: m}]}", "{after: 2 s, to: b}"), "");
  EXPECT_EQ(clean("{after: 1 s, to: b}", "{on: e, to: b}"), "");
}
TEST(CheckTransitions, AStateThatIsLeftAtOnceHearsNoEvent) {
  EXPECT_EQ(problems(machine("  states:\n    a:\n      transitions:\n        - {on: e, to: b}\n"
                             "        - {when: true, to: b}\n    b: {after: 1 s, to: a}\n")),
            "b.yaml:9:11: warning: this transition is never taken: the one at b.yaml:10:11 is, "
            "whenever this could be\n");
}
TEST(CheckTransitions, AnOuterOneIsHiddenOnlyIfEveryStateInsideHasItsOwn) {
  const std::string inner =
      "  states:\n    a:\n      transitions: [{on: e, to: b}]\n      states:\n";
  EXPECT_EQ(problems(machine(inner + "        x: {transitions: [{on: e, to: y}]}\n"
                                     "        y: {transitions: [{on: e, to: x}], after: 1 s, to: "
                                     "b}\n    b: {after: 1 s, to: a}\n")),
            "b.yaml:8:21: warning: this transition is never taken: every state inside takes its "
            "own, as at b.yaml:10:27\n");
  EXPECT_EQ(
      problems(machine(inner + "        x: {transitions: [{on: e, to: y}]}\n"
                               "        y: {after: 1 s, to: b}\n    b: {after: 1 s, to: a}\n")),
      "");
}
TEST(CheckTransitions, TheTimeOfAnInnerStateIsNotThatOfTheOuter) {
  EXPECT_EQ(problems(chart("  states:\n    a:\n      states:\n"
                           "        x: {after: 1 s, to: y}\n        y: {after: 1 s, to: x}\n"
                           "      after: 3 s\n      to: b\n    b: {after: 1 s, to: a}\n")),
            "");
}

std::string two_regions(const std::string& l, const std::string& more = "") {
  return machine("  states:\n    p:\n      type: parallel\n      states:\n        l: {" + l +
                 "states: {w: {after: 1 s, to: x}, x: {after: 1 s, to: w}}}\n" +
                 "        r: {states: {y: {after: 1 s, to: z}, z: {after: 1 s, to: y}}}\n" + more);
}
TEST(CheckTransitions, ARegionThatReEntersTheWholeParallelIsToldOfInternal) {
  EXPECT_EQ(problems(two_regions("transitions: [{on: e, to: w}], ")),
            "b.yaml:10:39: warning: this leaves and re-enters all regions of 'p': `internal: true` "
            "keeps it inside 'l'\n");
  EXPECT_EQ(problems(two_regions("transitions: [{on: e, to: w, internal: true}], ")), "");
}
TEST(CheckTransitions, OtherWaysToReEnterAllRegionsAreSaidToo) {
  EXPECT_EQ(problems(two_regions("transitions: [{on: e, to: l}], ")),
            "b.yaml:10:39: warning: this leaves and re-enters all regions of 'p': only a target "
            "inside the source's own region lets the others go on\n");
  EXPECT_EQ(problems(two_regions("transitions: [{on: e, to: z}], ")),
            "b.yaml:10:39: warning: this leaves and re-enters all regions of 'p': only a target "
            "inside the source's own region lets the others go on\n");
  EXPECT_EQ(problems(two_regions("", "      transitions: [{on: e, to: x}]\n")),
            "b.yaml:12:33: warning: this leaves and re-enters all regions of 'p': give it to the "
            "region that it is for, with `internal: true`\n");
}
TEST(CheckTransitions, WhoNamesTheParallelOrAllItsRegionsMeansIt) {
  EXPECT_EQ(problems(two_regions("transitions: [{on: e, to: p}], ")), "");
  EXPECT_EQ(problems(two_regions("transitions: [{on: e, to: [x, z]}], ")), "");
  EXPECT_EQ(
      problems(two_regions("transitions: [{on: e, to: q}], ", "    q: {after: 1 s, to: x}\n")), "");
  EXPECT_EQ(problems(two_regions("after: 9 s, to: q, ", "    q: {after: 1 s, to: p}\n")), "");
}

TEST(CheckLoops, ACycleWithoutTimeOrConditionIsFound) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 0 s, to: b}\n    b: {transitions: [{when: "
                           "true, to: a}]}\n")),
            "b.yaml:4:16: warning: 'a' -> 'b' -> 'a' is a loop that takes no time: it needs an "
            "`after` or a condition that ends it\n");
}
TEST(CheckLoops, WithARobotACertainLoopIsAnError) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\nmachine:\n  states:\n"
                     "    a: {after: 0 s, to: b}\n    b: {after: 0 ms, to: a}\n"),
            "b.yaml:5:16: error: 'a' -> 'b' -> 'a' is a loop that takes no time: it needs an "
            "`after` or a condition that ends it\n");
}
TEST(CheckLoops, AParameterThatIsZeroTakesNoTime) {
  const std::string file =
      "behavior: 1\nparameters: {d: {value: 0 s}}\nmachine:\n"
      "  states: {a: {after: $d, to: a}}\n";
  EXPECT_EQ(problems(file),
            "b.yaml:4:23: warning: 'a' -> 'a' is a loop that takes no time: it needs an `after` or "
            "a condition that ends it\n");
  auto options = options_for_tests();
  options.set = {{"d", "1 ms"}};
  EXPECT_EQ(problems(file, options), "");
}
TEST(CheckLoops, OneConditionThatHoldsAllTheWayRoundIsFound) {
  EXPECT_EQ(problems(machine("  states:\n    a: {transitions: [{when: $p > 1, to: b}]}\n"
                             "    b: {transitions: [{when: $p > 1, to: a}]}\n")),
            "b.yaml:7:23: warning: 'a' -> 'b' -> 'a' is a loop that takes no time while '$p > 1': "
            "it needs an `after` or a condition that ends it\n");
  EXPECT_EQ(problems(machine("  states:\n    a: {transitions: [{when: $p > 1, to: c}], after: 0 s, "
                             "to: a}\n    c: {after: 1 s, to: a}\n")),
            "b.yaml:7:54: warning: 'a' -> 'a' is a loop that takes no time unless '$p > 1': it "
            "needs an `after` or a condition that ends it\n");
}
// A condition that is not met leaves the cycle as it is, wherever it stands in the list.
TEST(CheckLoops, ATransitionBeforeThatOfTheCycleHidesNothing) {
  const auto said = [](const std::string& before) {
    return problems(
        "behavior: 1\nparameters: {p: {value: 0}, q: {value: 0}, v: 0}\nevents: {e: ''}\n"
        "machine:\n  states:\n    a:\n      transitions: [" +
        before +
        "{when: $p > 1, to: b}]\n"
        "    b: {transitions: [{when: $p > 1, to: a}]}\n"
        "    c: {on_entry: [{set: {v: '= $v + 1'}}], transitions: [{on: e, to: a}], "
        "after: $q * 1 s + 1 s, to: a}\n");
  };
  const auto loop = [](const char* line, const char* given) {
    return fmt::format(
        "b.yaml:{}: warning: 'a' -> 'b' -> 'a' is a loop that takes no time while '$p > 1'{}: it "
        "needs an `after` or a condition that ends it\n",
        line, given);
  };
  EXPECT_EQ(said("{when: $q > 1, to: c}, "), loop("7:44", " and not '$q > 1'"));
  EXPECT_EQ(said("{when: $q > 1, to: c}, {when: $v > 3, to: c}, "),
            loop("7:67", " and not '$q > 1' and not '$v > 3'"));
  EXPECT_EQ(said("{when: t > 2 s, to: c}, "), loop("7:45", ""));
  EXPECT_EQ(said("{when: 't > 2 s and $v > 3', to: c}, "), loop("7:58", ""));
  EXPECT_EQ(said("{on: e, to: c}, "), loop("7:37", ""));
  // These are met where the cycle's condition is, are met at once, or change on the way.
  EXPECT_EQ(said("{when: $p > 0, to: c}, "), "");
  EXPECT_EQ(said("{when: t < 2 s, to: c}, ").find("is a loop"), std::string::npos);
}
TEST(CheckLoops, ACycleThatChangesWhatWouldLeaveItIsNotReported) {
  EXPECT_EQ(problems(machine("  states:\n    a: {transitions: [{when: $v > 3, to: c}, {when: true, "
                             "to: b}]}\n    b: {on_entry: [{set: {v: '= $v + 1'}}], transitions: "
                             "[{when: true, to: a}]}\n    c: {after: 1 s, to: a}\n")),
            "");
}
TEST(CheckLoops, CyclesThatEndByThemselvesAreNot) {
  const auto clean = [](const std::string& a, const std::string& b) {
    return problems(machine("  states:\n    a: {transitions: [" + a + "]}\n    b: {transitions: [" +
                            b + "]}\n"));
  };
  EXPECT_EQ(clean("{when: $p > 1, to: b}", "{when: $p <= 1, to: a}"), "");
  EXPECT_EQ(clean("{when: true, to: b}", "{when: t > 1 s, to: a}"), "");
  EXPECT_EQ(clean("{when: true, to: b}", "{on: e, to: a}"), "");
  EXPECT_EQ(clean("{when: true, to: b}", "{after: 1 ms, to: a}"), "");
  EXPECT_EQ(clean("{when: $v < 3, to: b, do: [{set: {v: '= $v + 1'}}]}", "{when: true, to: a}"),
            "");
  EXPECT_EQ(clean("{when: true, to: b}", "{when: $v > 0, to: a, do: [{set: {v: 0}}]}"), "");
}
TEST(CheckLoops, AConditionThatOnlyActsIsTakenAgainAndAgain) {
  EXPECT_EQ(
      problems(machine("  states:\n    a: {transitions: [{when: $p > 1, do: [{mark: m}]}]}\n")),
      "b.yaml:7:23: warning: this is taken again and again in the same tick as long as `when` "
      "holds: take an event (`on:`), or `after: 0 s`, which is taken once an entry\n");
  EXPECT_EQ(problems(machine("  states:\n    a: {transitions: [{when: $p > 1, after: 0 s, do: "
                             "[{mark: m}]}]}\n")),
            "");
  EXPECT_EQ(problems(machine("  states:\n    a: {transitions: [{when: $v > 0, do: [{set: {v: "
                             "0}}]}]}\n")),
            "");
}

}  // namespace
}  // namespace footfall::tests
