// What a state remembers, and when it is done.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(Statechart, DoneIsRaisedWhenACompoundStateReachesItsFinalChild) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    job:
      states: {work: {transitions: [{on: e, to: end}]}, end: {type: final}}
      transitions: [{on: done.state.job, to: after}]
    after: {}
)"),
                     "e"),
            (Lines{"work", "after"}));
}
TEST(Statechart, AParallelStateIsDoneWhenAllItsRegionsAre) {
  const std::string text = R"(
  states:
    p:
      type: parallel
      states:
        r: {states: {a: {transitions: [{on: e, to: ra}]}, ra: {type: final}}}
        s: {states: {b: {transitions: [{on: f, to: sb}]}, sb: {type: final}}}
      transitions: [{on: done.state.p, to: after}]
    after: {}
)";
  EXPECT_EQ(trace_of(chart(text), "e,f"), (Lines{"a b", "ra b", "after"}));
  std::string any = text;
  any.insert(any.find("      states:\n        r:"), "      done: any\n");
  EXPECT_EQ(trace_of(chart(any), "e"), (Lines{"a b", "after"}));
  std::string region = text;
  region.insert(region.find("      states:\n        r:"), "      done: s\n");
  EXPECT_EQ(trace_of(chart(region), "e,f"), (Lines{"a b", "ra b", "after"}));
}
TEST(Statechart, ShallowHistoryRestoresTheChildAndStartsItAnew) {
  const std::string text = R"(
  states:
    p:
      transitions: [{on: out, to: o}]
      states:
        h: {type: history, depth: DEPTH}
        a: {transitions: [{on: e, to: c}]}
        b: {states: {b1: {}, c: {}}}
    o: {transitions: [{on: back, to: h}]}
)";
  std::string shallow = text, deep = text;
  shallow.replace(shallow.find("DEPTH"), 5, "shallow");
  deep.replace(deep.find("DEPTH"), 5, "deep");
  // Without `initial`, a history state is not the first state: `a` is.
  EXPECT_EQ(trace_of(chart(shallow), "e,out,back"), (Lines{"a", "c", "o", "b1"}));
  EXPECT_EQ(trace_of(chart(deep), "e,out,back"), (Lines{"a", "c", "o", "c"}));
}
TEST(Statechart, HistoryThatWasNeverLeftTakesItsDefault) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    o: {transitions: [{on: back, to: h}]}
    p: {states: {h: {type: history, default: b}, a: {}, b: {}}}
)"),
                     "back"),
            (Lines{"o", "b"}));
  EXPECT_EQ(trace_of(chart(R"(
  states:
    o: {transitions: [{on: back, to: h}]}
    p: {states: {h: {type: history}, a: {}, b: {}}}
)"),
                     "back"),
            (Lines{"o", "a"}));
}
TEST(Statechart, DeepHistoryOfAParallelStateRestoresAllRegions) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p:
      type: parallel
      transitions: [{on: out, to: o}]
      states:
        h: {type: history, depth: deep}
        r: {states: {a: {transitions: [{on: e, to: b}]}, b: {}}}
        s: {states: {c: {transitions: [{on: f, to: d}]}, d: {}}}
    o: {transitions: [{on: back, to: h}]}
)"),
                     "e,f,out,back"),
            (Lines{"a c", "b c", "b d", "o", "b d"}));
}
TEST(Statechart, HistoryRecordsAtEveryExitBeforeTheStatesAreLeft) {
  EXPECT_EQ(trace_of(chart(R"(
  states:
    p:
      states:
        h: {type: history}
        a: {transitions: [{on: e, to: b}]}
        b: {transitions: [{on: e, to: a}]}
      transitions: [{on: again, to: h}]
)"),
                     "again,e,again,e"),
            (Lines{"a", "a", "b", "b", "a"}));
}

}  // namespace
}  // namespace footfall::tests
