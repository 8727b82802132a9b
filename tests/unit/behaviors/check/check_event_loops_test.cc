// Loops that raised events and done events keep going: found where nothing can end them, and only
// there. In all charts `e` starts it.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

// States a (line 4) and b (line 5), and what more there is.
std::string two_states(const std::string& a, const std::string& b, const std::string& more = "") {
  return "behavior: 1\nmachine:\n  states:\n    a: {" + a + "}\n    b: {" + b + "}\n" + more +
         "events: {e: ''}\n";
}
constexpr const char* kBack = "transitions: [{on: go, to: a, do: [{raise: go}]}]";

TEST(CheckEventLoops, TransitionsThatRaiseEachOthersEventAreALoop) {
  EXPECT_EQ(problems(two_states("transitions: [{on: [e, go], to: b, do: [{raise: go}]}]", kBack)),
            "b.yaml:4:23: warning: 'a' -> (go) 'b' -> (go) 'a' is a loop that takes no time: its "
            "transitions raise the events that take them; it needs an `after` or a condition that "
            "ends it\n");
}
TEST(CheckEventLoops, TheRaiseMayBeAtTheExitOrTheEntry) {
  const std::string take = "transitions: [{on: [e, go], to: b}]",
                    back = "transitions: [{on: go, to: a}]";
  for (const char* key : {"on_entry", "on_exit"}) {
    const std::string raise = std::string(", ") + key + ": [{raise: go}]";
    EXPECT_TRUE(problems(two_states(take + raise, back + raise))
                    .starts_with("b.yaml:4:23: warning: 'a' -> (go) 'b' -> (go) 'a' is a loop"))
        << key;
  }
}
TEST(CheckEventLoops, ActionsAloneMayKeepThemselvesGoing) {
  EXPECT_TRUE(problems(two_states("transitions: [{on: e, do: [{raise: e}]}], after: 1 s, to: b",
                                  "after: 1 s, to: a"))
                  .starts_with("b.yaml:4:23: warning: 'a' -> (e) 'a' is a loop"));
}
TEST(CheckEventLoops, DoneOfAStateThatIsDoneAtOnceIsALoop) {
  EXPECT_TRUE(
      problems(two_states("transitions: [{on: done.state.a, to: a}], states: {f: {type: final}}, "
                          "after: 1 s, to: b",
                          "after: 1 s, to: a"))
          .starts_with("b.yaml:4:23: warning: 'a.f' -> (done.state.a) 'a.f' is a loop"));
}
TEST(CheckEventLoops, EventlessStepsMayBePartOfIt) {
  EXPECT_TRUE(problems(two_states("transitions: [{on: [e, go], to: b}]",
                                  "transitions: [{when: true, to: a, do: [{raise: go}]}]"))
                  .starts_with("b.yaml:4:23: warning: 'a' -> (go) 'b' -> 'a' is a loop"));
}
// What the check says is what happens: the tick is cut off, or is not.
TEST(CheckEventLoops, WhatEndsByItselfIsNot) {
  const std::string go = "transitions: [{on: [e, go], to: b, do: [{raise: go}]}]";
  const std::string clean[] = {
      two_states(go, "transitions: [{on: go, to: a}]"),  // raises nothing
      two_states(go,
                 "transitions: [{on: go, when: $v < 3, to: a, do: [{set: {v: '= $v + 1'}}, {raise: "
                 "go}]}], after: 1 s, to: a",
                 "parameters: {v: 0}\n"),  // a condition ends it
      two_states(go, "transitions: [{on: go, to: a, do: [{set: {w: '= $w + 1'}}, {raise: go}]}]",
                 "parameters: {w: {value: 0, range: [0, 3]}}\n"),  // so does a range
      two_states(go,
                 "transitions: [{on: go, after: 1 ms, to: a, do: [{raise: go}]}]"),  // takes time
      two_states(go, "transitions: [{when: true, to: c}, {on: go, to: a, do: [{raise: go}]}]",
                 "    c: {after: 1 s, to: a}\n"),  // left before the event
      two_states(go, "transitions: [{on: go, to: f, do: [{raise: go}]}, {after: 1 s, to: a}]",
                 "    f: {type: final}\n"),  // the end of the run
  };
  for (const std::string& text : clean) {
    EXPECT_EQ(problems(text).find("is a loop"), std::string::npos) << text << problems(text);
    const auto behavior = load(text);
    behaviors::Statechart chart(*behavior, nullptr, behavior->values);
    chart.start(0);
    chart.begin_tick(1);
    chart.raise(behavior->find_event("e"));
    chart.run();
    EXPECT_LT(chart.transitions_taken().size(), 12U) << text;
  }
}
TEST(CheckEventLoops, RegionsAreNotJudged) {
  EXPECT_EQ(problems("behavior: 1\nevents: {e: ''}\nmachine:\n  type: parallel\n  states:\n"
                     "    l: {states: {a: {transitions: [{on: [e, go], to: b, internal: true, do: "
                     "[{raise: go}]}]}, b: {transitions: [{on: go, to: a, do: [{raise: go}]}]}}}\n"
                     "    r: {states: {c: {after: 1 s, to: d}, d: {after: 1 s, to: c}}}\n"),
            "");
}

// The same event again and again, as often as there are micro steps.
TEST(CheckEventLoops, ALoopThatIsFoundIsCutOffWhenItRuns) {
  const auto behavior =
      load(two_states("transitions: [{on: [e, go], to: b, do: [{raise: go}]}]", kBack));
  behavior->micro_steps = 64;
  behaviors::Statechart chart(*behavior, nullptr, behavior->values);
  chart.start(0);
  chart.begin_tick(1);
  chart.raise(behavior->find_event("e"));
  chart.run();
  EXPECT_EQ(chart.transitions_taken().size(), 64U);
  EXPECT_EQ(chart.faults().of(core::Fault::execution), 1);
}

// W3C SCXML 1.0, Appendix D, enterStates: the final state's grandparent, if it is parallel, is
// done; no state further out.
TEST(CheckDone, OfAParallelIsNeverRaisedByWhatEndsInsideAParallelRegion) {
  const auto nested = [](const std::string& done, const std::string& second) {
    return "behavior: 1\nmachine:\n  states:\n    p:\n      type: parallel\n" + done +
           "      transitions: [{on: done.state.p, to: z}]\n      states:\n"
           "        q: {type: parallel, states: {x: {states: {f: {type: final}}}, y: {states: {g: "
           "{type: final}}}}}\n        r: {" +
           second + "}\n    z: {type: final}\n";
  };
  const std::string compound = "states: {s: {after: 1 s, to: h}, h: {type: final}}";
  const std::string parallel = "type: parallel, states: {k: {states: {i: {type: final}}}}";
  EXPECT_EQ(problems(nested("      done: q\n", compound)),
            "b.yaml:6:13: warning: 'q' is parallel itself: `done` waits for a final child of a "
            "region, and is never raised for it; listen to done.state.q\n");
  EXPECT_EQ(problems(nested("      done: r\n", compound)), "");
  EXPECT_EQ(problems(nested("", compound)), "");
  EXPECT_EQ(problems(nested("      done: any\n", compound)), "");
  EXPECT_NE(problems(nested("", parallel)).find("'p' is never done"), std::string::npos);
  // It is what happens: all regions of q end at once, r after a second.
  const std::vector<behaviors::TraceStep> later = {{2.0, ""}, {-1.0, "none"}};
  EXPECT_EQ(trace_of(*load(nested("      done: q\n", compound)), later).back(), "f g h");
  EXPECT_EQ(trace_of(*load(nested("", compound)), later).back(), "z");
}

}  // namespace
}  // namespace footfall::tests
