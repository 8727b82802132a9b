// States that are never entered and states that can never be left: found, and only those.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(CheckStates, AStateThatNothingLeadsToIsNamedAtItsKey) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: b}\n    b: {after: 1 s, to: a}\n"
                           "    c: {after: 1 s, to: a}\n")),
            "b.yaml:6:5: warning: 'c' is never entered: nothing leads to it\n");
}
TEST(CheckStates, OneMissingTransitionIsOneWarningThatNamesWhatFollows) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: a}\n    b: {after: 1 s, to: c}\n"
                           "    c: {after: 1 s, to: d}\n    d: {after: 1 s, to: a}\n")),
            "b.yaml:5:5: warning: 'b' is never entered: nothing leads to it; nor, then, to 'c', "
            "'d'\n");
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: a}\n    d: {after: 1 s, to: a}\n"
                           "    b: {after: 1 s, to: d}\n")),
            "b.yaml:6:5: warning: 'b' is never entered: nothing leads to it; nor, then, to 'd'\n");
}
TEST(CheckStates, AmongStatesThatLeadToEachOtherTheFirstIsNamed) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: a}\n    b: {after: 1 s, to: c}\n"
                           "    c: {after: 1 s, to: b}\n")),
            "b.yaml:5:5: warning: 'b' is never entered: nothing leads to it; nor, then, to 'c'\n");
}
TEST(CheckStates, OnlyTheOutermostStateThatIsNeverEnteredIsNamed) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: a}\n"
                           "    b: {states: {x: {after: 1 s, to: y}, y: {after: 1 s, to: a}}}\n")),
            "b.yaml:5:5: warning: 'b' is never entered: nothing leads to it\n");
}
TEST(CheckStates, AConditionThatIsNeverTrueLeadsNowhere) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: a, transitions: [{when: 1 > 2, to: "
                           "b}]}\n    b: {after: 1 s, to: a}\n")),
            "b.yaml:4:49: warning: `when` is never true: this transition is never taken\n"
            "b.yaml:5:5: warning: 'b' is never entered: nothing leads to it\n");
}
TEST(CheckStates, AHistoryStateThatNothingNamesIsNeverEntered) {
  EXPECT_EQ(problems(chart("  states:\n    a:\n      states:\n        x: {after: 1 s, to: y}\n"
                           "        y: {after: 1 s, to: x}\n        h: {type: history}\n")),
            "b.yaml:8:9: warning: 'a.h' is never entered: nothing leads to it\n");
}
TEST(CheckStates, WaysThroughHistorySafeRegionsAndDefaultsCount) {
  EXPECT_EQ(problems("behavior: 1\nevents: {pause: '', go: ''}\nmachine:\n  safe: limp\n  states:\n"
                     "    wait: {transitions: [{on: go, to: [x, z]}]}\n"
                     "    work:\n      type: parallel\n      transitions: [{on: pause, to: held}]\n"
                     "      states:\n"
                     "        l: {states: {w: {after: 1 s, to: x}, x: {after: 1 s, to: w}}}\n"
                     "        r: {states: {y: {after: 1 s, to: z}, z: {after: 1 s, to: y}}}\n"
                     "        h: {type: history, depth: deep}\n"
                     "    held: {transitions: [{on: go, to: work.h}]}\n    limp: {}\n"),
            "");
}
TEST(CheckStates, AMirroredTemplateIsEnteredOnBothSides) {
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\n"
               "templates: {s: {args: [f], states: {a: {after: 1 s, to: b}, b: {type: final}}}}\n"
               "machine: {states: {step: {mirror: s, with: {f: right_foot}}}}\n"),
      "");
}
TEST(CheckStates, ATemplatesTextIsNamedOnlyIfNoInstanceUsesIt) {
  const std::string file =
      "behavior: 1\ntemplates:\n  s: {states: {a: {after: 1 s, to: b}, b: {after: 1 s, to: b}}}\n";
  EXPECT_EQ(problems(file + "machine: {states: {x: {use: s, initial: b, after: 9 s, to: y}, "
                            "y: {use: s}}}\n"),
            "");
  EXPECT_EQ(problems(file + "machine: {states: {x: {use: s, initial: b}}}\n"),
            "b.yaml:3:16: warning: 'x.a' is never entered: nothing leads to it\n");
}
TEST(CheckStates, AnEventThatNothingRaisesIsSaidOnce) {
  EXPECT_EQ(problems("behavior: 1\nevents: {start: go}\nmachine:\n"
                     "  states: {a: {transitions: [{on: strat, to: b}]}, b: {type: final}}\n"),
            "b.yaml:4:35: warning: nothing raises 'strat', and `events` does not list it (did you "
            "mean 'start'?)\n");
}

TEST(CheckStates, AStateThatCanNeverBeLeftIsNamedAtItsKey) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: b}\n    b: {}\n")),
            "b.yaml:5:5: warning: 'b' can never be left: give it a transition, or `type: final` if "
            "this is where it ends\n");
}
TEST(CheckStates, ADeadEndInsideACompoundStateIsFound) {
  EXPECT_EQ(problems(chart("  states:\n    a:\n      states:\n        x: {after: 1 s, to: y}\n"
                           "        y: {}\n")),
            "b.yaml:7:9: warning: 'a.y' can never be left: give it a transition, or `type: final` "
            "if this is where it ends\n");
}
TEST(CheckStates, TransitionsOfParentsAndOfTheRootLeadOut) {
  EXPECT_EQ(problems("behavior: 1\nevents: {stop: ''}\nmachine:\n"
                     "  transitions: [{on: stop, to: z}]\n"
                     "  states: {a: {after: 1 s, to: b}, b: {}, z: {type: final}}\n"),
            "");
  EXPECT_EQ(problems("behavior: 1\nevents: {stop: ''}\nmachine:\n  states:\n"
                     "    a: {states: {x: {after: 1 s, to: y}, y: {}}, after: 5 s, to: b}\n"
                     "    b: {transitions: [{on: stop, to: a}]}\n"),
            "");
}
TEST(CheckStates, FinalStatesAndTheSafeStateAreWhereItMayEnd) {
  EXPECT_EQ(problems(chart("  safe: limp\n  states:\n    a: {after: 1 s, to: b}\n"
                           "    b: {type: final}\n    limp: {states: {x: {after: 1 s, to: y}, "
                           "y: {}}}\n")),
            "");
}
TEST(CheckStates, SafeIsNoWayOut) {
  EXPECT_EQ(problems(chart("  safe: limp\n  states:\n    a: {after: 1 s, to: b}\n    b: {}\n"
                           "    limp: {}\n")),
            "b.yaml:6:5: warning: 'b' can never be left: give it a transition, or `type: final` if "
            "this is where it ends\n");
}
TEST(CheckStates, ABehaviorThatIsOnlyEverInOneStateIsNoDeadEnd) {
  EXPECT_EQ(problems("behavior: 1\nmachine: {}\n"), "");
  EXPECT_EQ(problems(chart("  safe: limp\n  states: {stand: {}, limp: {}}\n")), "");
  EXPECT_EQ(problems(chart("  type: parallel\n  states: {legs: {}, arms: {states: {wave: {}}}}\n")),
            "");
}
TEST(CheckStates, AStateThatOnlyReactsIsNoDeadEnd) {
  EXPECT_EQ(problems("behavior: 1\nevents: {tap: ''}\nmachine:\n  states:\n"
                     "    a: {after: 1 s, to: b}\n"
                     "    b: {transitions: [{on: tap, do: [{mark: tap}]}]}\n"),
            "");
}
TEST(CheckStates, ARegionIsLeftByWhatAnotherRegionDoes) {
  const std::string regions =
      "  states:\n    p:\n      type: parallel\n      states:\n"
      "        l: {states: {w: {after: 1 s, to: x}, x: {}}}\n";
  EXPECT_EQ(
      problems(chart(regions + "        r: {states: {y: {after: 9 s, to: q}}}\n    q: {after: "
                               "1 s, to: p}\n")),
      "");
  EXPECT_EQ(problems(chart(regions + "        r: {states: {y: {after: 9 s, to: y}}}\n")),
            "b.yaml:7:46: warning: 'p.l.x' can never be left: give it a transition, or `type: "
            "final` if this is where it ends\n");
}
TEST(CheckStates, MissingTargetsLeaveTheQuestionOpen) {
  EXPECT_EQ(problems(chart("  states: {a: {after: 1 s, to: bb}, b: {}, c: {}}\n")),
            "b.yaml:3:32: error: unknown state 'bb' (did you mean 'b'?)\n");
}
TEST(CheckStates, AfterAnErrorItsConsequencesAreNotSaid) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 N, to: b}\n    b: {}\n    c: {}\n")),
            "b.yaml:4:16: error: expected a time, got '1 N'\n");
}

}  // namespace
}  // namespace footfall::tests
