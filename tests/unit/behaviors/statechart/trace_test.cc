#include "behaviors/statechart/trace.h"

#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

std::string traced(const std::string& text, const std::vector<behaviors::TraceStep>& steps) {
  std::ostringstream out;
  behaviors::trace(*load(text), steps, out);
  return out.str();
}

TEST(Trace, OneJsonLineForTheStartAndOneAfterEachEvent) {
  EXPECT_EQ(traced(chart(R"(
  states:
    p:
      type: parallel
      states:
        b: {states: {b0: {transitions: [{on: t1, to: b1}]}, b1: {}}}
        c: {states: {c0: {transitions: [{on: t1, to: c1}]}, c1: {}}}
)"),
                   behaviors::trace_events("t1, t2")),
            "{\"event\":null,\"active\":[\"b0\",\"c0\"]}\n"
            "{\"event\":\"t1\",\"active\":[\"b1\",\"c1\"]}\n"
            "{\"event\":\"t2\",\"active\":[\"b1\",\"c1\"]}\n");
}
TEST(Trace, AnEventThatNobodyKnowsIsToldOnce) {
  const auto behavior = load(
      "behavior: 1\nevents: {press: \"a button\"}\nmachine:\n  states:\n"
      "    a: {transitions: [{on: [press, knob.*, other], to: b}]}\n    b: {}\n");
  const auto known = behaviors::trace_events("press,knob,knob.left,other,contact.x.touchdown");
  EXPECT_TRUE(behaviors::unknown_events(*behavior, known).empty());
  const auto unknown = behaviors::unknown_events(*behavior, behaviors::trace_events("pres,pres"));
  ASSERT_EQ(unknown.size(), 1U);
  EXPECT_NE(unknown[0].find("did you mean 'press'?"), std::string::npos) << unknown[0];
}
TEST(Trace, NamesOfEventsAreEscaped) {
  EXPECT_EQ(traced(chart("  states: {a: {}}"), {{-1.0, "x\"y"}}),
            "{\"event\":null,\"active\":[\"a\"]}\n{\"event\":\"x\\\"y\",\"active\":[\"a\"]}\n");
}
TEST(Trace, DelaysOfAScriptPassOnAVirtualClockAndPrintNothing) {
  core::Diagnostics diagnostics;
  const auto steps = behaviors::load_trace_script_text(
      "[{after: 99 ms}, {event: x}, {after: 1 ms}, {event: x}]", "s.yaml", diagnostics);
  ASSERT_TRUE(steps) << diagnostics.to_string();
  EXPECT_EQ(traced(chart("  states: {a: {after: 100 ms, to: b}, b: {}}"), *steps),
            "{\"event\":null,\"active\":[\"a\"]}\n{\"event\":\"x\",\"active\":[\"a\"]}\n"
            "{\"event\":\"x\",\"active\":[\"b\"]}\n");
}
TEST(Trace, ADelayThatEndsAScriptPrintsWhatItLedTo) {
  core::Diagnostics diagnostics;
  const auto steps = behaviors::load_trace_script_text(
      "[{event: x}, {after: 50 ms}, {after: 50 ms}]", "s.yaml", diagnostics);
  ASSERT_TRUE(steps) << diagnostics.to_string();
  EXPECT_EQ(traced(chart("  states: {a: {after: 100 ms, to: b}, b: {}}"), *steps),
            "{\"event\":null,\"active\":[\"a\"]}\n{\"event\":\"x\",\"active\":[\"a\"]}\n"
            "{\"event\":null,\"active\":[\"b\"]}\n");
}
TEST(Trace, AScriptWithAnErrorSaysWhere) {
  core::Diagnostics diagnostics;
  EXPECT_FALSE(
      behaviors::load_trace_script_text("- {after: 100 N}\n- {evnt: x}\n", "s.yaml", diagnostics));
  EXPECT_EQ(diagnostics.to_string(),
            "s.yaml:1:11: error: expected a time, got '100 N'\n"
            "s.yaml:2:3: error: expected either `after` or `event`\n"
            "s.yaml:2:4: error: unknown key 'evnt' (did you mean 'event'?)\n");
}
TEST(Trace, TheBalanceBehaviorWaitsForItsStart) {
  core::Diagnostics diagnostics;
  const auto behavior = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_TRUE(behavior) << diagnostics.to_string();
  std::ostringstream out;
  behaviors::trace(*behavior,
                   {{-1.0, "start"}, {5.5, ""}, {-1.0, "start"}, {0.016, ""}, {-1.0, "x"}}, out);
  EXPECT_EQ(
      out.str(),
      "{\"event\":null,\"active\":[\"rise\"]}\n{\"event\":\"start\",\"active\":[\"rise\"]}\n"
      "{\"event\":\"start\",\"active\":[\"dual\"]}\n{\"event\":\"x\",\"active\":[\"unload\"]}\n");
}

}  // namespace
}  // namespace footfall::tests
