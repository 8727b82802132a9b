// Selection, exit and entry sets, history, done events: what the W3C Recommendation says, on small
// charts whose outcome follows from Appendix D by hand.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(Statechart, TheFirstStateIsTheInitialOne) {
  EXPECT_EQ(trace_of(chart("  states: {a: {states: {a1: {}, a2: {}}}, b: {}}"), ""), Lines{"a1"});
}
TEST(Statechart, InitialNamesAnyDescendant) {
  EXPECT_EQ(trace_of(chart("  initial: a2\n  states: {a: {states: {a1: {}, a2: {}}}, b: {}}"), ""),
            Lines{"a2"});
}
TEST(Statechart, AnEventThatEnablesNothingIsGone) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    a: {transitions: [{on: x, to: b}]}
    b: {transitions: [{on: y, to: a}]}
)"),
                     "y,x,unheard-of,y"),
            (Lines{"a", "a", "b", "b", "a"}));
}
TEST(Statechart, ADescendantsTransitionBeatsItsAncestors) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p: {states: {c: {transitions: [{on: e, to: inner}]}}, transitions: [{on: e, to: outer}]}
    inner: {}
    outer: {}
)"),
                     "e"),
            (Lines{"c", "inner"}));
}
TEST(Statechart, TheFirstEnabledTransitionInDocumentOrderWins) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    a: {transitions: [{on: e, when: 1 > 2, to: x}, {on: e, to: y}, {on: e, to: x}]}
    x: {}
    y: {}
)"),
                     "e"),
            (Lines{"a", "y"}));
}
TEST(Statechart, ARootTransitionIsADefault) {
  EXPECT_EQ(trace_of(chart(R"(
  transitions: [{on: e, to: z}]
  states:
    a: {transitions: [{on: e, to: b}]}
    b: {}
    z: {}
)"),
                     "e,e"),
            (Lines{"a", "b", "z"}));
}
TEST(Statechart, AllRegionsAreActiveAndReactToOneEvent) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p:
      type: parallel
      states:
        r: {states: {a: {transitions: [{on: e, to: b}]}, b: {}}}
        s: {states: {c: {transitions: [{on: e, to: d}]}, d: {}}}
)"),
                     "e"),
            (Lines{"a c", "b d"}));
}
TEST(Statechart, ARegionsOwnTransitionToItsChildReentersTheWholeParallel) {
  const std::string text = R"(
  states:
    p:
      type: parallel
      states:
        r: {states: {a: {}, b: {}}, transitions: [{on: e, to: a}]}
        s: {states: {c: {transitions: [{on: f, to: d}]}, d: {}}}
)";
  EXPECT_EQ(trace_of(chart(text), "f,e"), (Lines{"a c", "a d", "a c"}));
  std::string internal = text;
  internal.replace(internal.find("to: a}"), 6, "to: b, internal: true}");
  EXPECT_EQ(trace_of(chart(internal), "f,e"), (Lines{"a c", "a d", "b d"}));
}
TEST(Statechart, OfTwoConflictingTransitionsInRegionsTheEarlierWins) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p:
      type: parallel
      states:
        r: {states: {a: {transitions: [{on: e, to: x}]}}}
        s: {states: {c: {transitions: [{on: e, to: y}]}}}
    x: {}
    y: {}
)"),
                     "e"),
            (Lines{"a c", "x"}));
}
TEST(Statechart, ATransitionWithoutTargetExitsNothingAndConflictsWithNothing) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p:
      type: parallel
      states:
        r: {states: {a: {transitions: [{on: e, do: [{raise: g}]}]}}}
        s: {states: {c: {transitions: [{on: e, to: d}]}, d: {transitions: [{on: g, to: f}]}, f: {}}}
)"),
                     "e"),
            (Lines{"a c", "a f"}));
}
TEST(Statechart, EnteringOneRegionEntersTheOthersByDefault) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    o: {transitions: [{on: e, to: b}]}
    p: {type: parallel, states: {r: {states: {a: {}, b: {}}}, s: {states: {c: {}, d: {}}}}}
)"),
                     "e"),
            (Lines{"o", "b c"}));
}
TEST(Statechart, SeveralTargetsEnterSeveralRegions) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    o: {transitions: [{on: e, to: [b, d]}]}
    p: {type: parallel, states: {r: {states: {a: {}, b: {}}}, s: {states: {c: {}, d: {}}}}}
)"),
                     "e"),
            (Lines{"o", "b d"}));
}
TEST(Statechart, AParallelRootComesBackWhole) {
  EXPECT_EQ(trace_of(chart(R"(
  type: parallel
  transitions: [{on: reset, to: a}]
  states:
    r: {states: {a: {transitions: [{on: e, to: b}]}, b: {}}}
    s: {states: {c: {transitions: [{on: e, to: d}]}, d: {}}}
)"),
                     "e,reset"),
            (Lines{"a c", "b d", "a c"}));
}
TEST(Statechart, ExitsGoInnermostLastFirstThenActionsThenEntriesOutermostFirst) {
  // Each action writes its rank only if the one before it was right.
  const auto behavior = load(R"(
behavior: 1
parameters: {n: {value: 0}}
machine:
  states:
    p:
      on_exit: [{set: {n: "= $n*10 + 2"}}]
      states:
        c: {on_exit: [{set: {n: "= $n*10 + 1"}}], transitions: [{on: e, to: d, do: [{set: {n: "= $n*10 + 3"}}]}]}
    q:
      on_entry: [{set: {n: "= $n*10 + 4"}}]
      states: {d: {on_entry: [{set: {n: "= $n*10 + 5"}}]}}
)");
  std::vector<double> values = behavior->values;
  behaviors::Statechart chart(*behavior, nullptr, values);
  chart.start(0);
  chart.begin_tick(0);
  chart.raise(behavior->find_event("e"));
  chart.run();
  EXPECT_EQ(values[0], 12345.0);
}
TEST(Statechart, ATransitionToItselfLeavesAndReenters) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    a: {states: {a1: {transitions: [{on: e, to: a2}]}, a2: {}}, transitions: [{on: again, to: a}]}
)"),
                     "e,again"),
            (Lines{"a1", "a2", "a1"}));
}
TEST(Statechart, InternalEventsGoBeforeExternalOnes) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    a: {transitions: [{on: e, to: b, do: [{raise: in1}]}]}
    b: {transitions: [{on: in1, to: c}, {on: e, to: wrong}]}
    c: {transitions: [{on: e, to: d}]}
    d: {}
    wrong: {}
)"),
                     "e,e"),
            (Lines{"a", "c", "d"}));
}
TEST(Statechart, EventlessTransitionsGoBeforeInternalEvents) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    a: {transitions: [{on: e, to: b, do: [{raise: i}]}]}
    b: {transitions: [{on: i, to: wrong}, {when: 1 < 2, to: c}]}
    c: {transitions: [{on: i, to: d}]}
    d: {}
    wrong: {}
)"),
                     "e"),
            (Lines{"a", "d"}));
}
TEST(Statechart, InAsksForTheConfiguration) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p:
      type: parallel
      states:
        r: {states: {a: {transitions: [{on: e, to: b}]}, b: {}}}
        s: {states: {c: {transitions: [{when: in(r.b), to: d}]}, d: {}}}
)"),
                     "e"),
            (Lines{"a c", "b d"}));
}
TEST(Statechart, AListAndAPrefixOfEventsMatchWhatTheyName) {
  const std::string text = R"(
  states:
    a: {transitions: [{on: [x, y], to: b}, {on: "fault.*", to: c}]}
    b: {transitions: [{on: "*", to: a}]}
    c: {}
)";
  EXPECT_EQ(trace_of(chart(text), "y,x,fault.tick.overrun"), (Lines{"a", "b", "a", "c"}));
  EXPECT_TRUE(behaviors::Chart::event_matches("fault.*", "fault"));
  EXPECT_FALSE(behaviors::Chart::event_matches("fault.*", "faults.x"));
}
TEST(Statechart, AZeroTimeLoopIsBoundedAndReported) {
  const auto behavior = load(chart(R"(
  micro_steps: 64
  states:
    a: {transitions: [{when: 1 < 2, to: b}]}
    b: {transitions: [{on: error.execution, to: c}, {when: 1 < 2, to: a}]}
    c: {}
)"));
  std::vector<double> values;
  behaviors::Statechart chart(*behavior, nullptr, values);
  chart.start(0);
  chart.begin_tick(0);
  chart.run();
  EXPECT_EQ(chart.transitions_taken().size(), 64u);
  EXPECT_EQ(chart.faults().of(core::Fault::execution), 1);
}
TEST(Statechart, AValueOutOfRangeSkipsTheRestOfItsListAndRaisesAnError) {
  EXPECT_EQ(trace_of(R"(
behavior: 1
parameters: {n: {value: 1, range: [0, 2]}}
machine:
  states:
    a: {transitions: [{on: e, to: b, do: [{set: {n: "= $n*5"}}, {raise: next}]}]}
    b: {transitions: [{on: next, to: wrong}, {on: error.execution, to: c}]}
    c: {transitions: [{when: $n == 1, to: d}]}
    d: {}
    wrong: {}
)",
                     "e"),
            (Lines{"a", "d"}));
}
TEST(Statechart, AConditionThatIsNotFiniteIsFalse) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    a: {transitions: [{on: e, when: 1/0 > 1, to: b}, {on: e, when: not (1/0 > 1), to: b}]}
    b: {}
)"),
                     "e"),
            (Lines{"a", "a"}));
}
TEST(Statechart, WhatAnActionSetsIsSeenAtOnceByWhatFollows) {
  EXPECT_EQ(trace_of(R"(
behavior: 1
parameters: {n: {value: 1}}
machine:
  states:
    a: {on_entry: [{set: {n: 7}}], transitions: [{when: $n == 7, to: b}]}
    b: {}
)",
                     ""),
            Lines{"b"});
}
TEST(Statechart, AFinalChildOfTheRootEndsTheRun) {
  EXPECT_EQ(trace_of(chart(R"(
  transitions: [{on: back, to: a}]
  states: {a: {transitions: [{on: e, to: z}]}, z: {type: final}}
)"),
                     "e,back"),
            (Lines{"a", "z", "z"}));
}
TEST(Statechart, TheSafeStateIsEnteredAheadOfTheTicksTransitions) {
  const auto behavior = load(chart(R"(
  safe: limp
  states: {a: {transitions: [{on: e, to: b}]}, b: {}, limp: {}}
)"));
  std::vector<double> values;
  behaviors::Statechart chart(*behavior, nullptr, values);
  chart.start(0);
  chart.begin_tick(1);
  chart.raise(behavior->find_event("e"));
  chart.request_safe();
  chart.run();
  EXPECT_EQ(behavior->states[static_cast<std::size_t>(chart.active_atomic()[0])].name, "limp");
  const auto serial = chart.entry_serial(3);
  chart.begin_tick(2);
  chart.request_safe();  // it is there already
  chart.run();
  EXPECT_EQ(chart.entry_serial(3), serial);
}
TEST(Statechart, TheShallowestStateOfANameIsMeant) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p: {states: {a: {transitions: [{on: e, to: x}]}, x: {states: {y: {states: {x: {}}}}}}}
    x: {states: {w: {}}}
)"),
                     "e"),
            (Lines{"a", "x"}));
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p: {states: {a: {transitions: [{on: e, to: q.x}]}}}
    q: {states: {w: {}, x: {}}}
)"),
                     "e"),
            (Lines{"a", "x"}));
}
TEST(Statechart, AQueueThatIsFullCountsAndTells) {
  const auto behavior = load(chart("  states: {a: {transitions: [{on: e, to: a}]}}"));
  std::vector<double> values;
  behaviors::Statechart chart(*behavior, nullptr, values);
  chart.start(0);
  chart.begin_tick(0);
  int accepted = 0;
  while (accepted < 1000 && chart.raise(behavior->find_event("e"))) ++accepted;
  EXPECT_EQ(accepted, 256);
  EXPECT_EQ(chart.faults().of(core::Fault::event_overflow), 1);
}

}  // namespace
}  // namespace footfall::tests
