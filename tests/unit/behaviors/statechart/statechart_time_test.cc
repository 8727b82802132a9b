// Timers: exact numbers of periods, once per entry, ahead of the tick's events.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

using behaviors::periods_of;

TEST(StatechartTime, SixteenMillisecondsAt1500HertzAre24Periods) {
  EXPECT_EQ(periods_of(0.016, 1'500'000), 24);
  EXPECT_EQ(periods_of(0.024, 1'500'000), 36);
  EXPECT_EQ(periods_of(5.5, 1'500'000), 8250);
  EXPECT_EQ(periods_of(0.145, 1'500'000), 218);  // 217.5 rounded up
}
TEST(StatechartTime, WholeMillisecondsAtOneKilohertzAreExact) {
  for (int ms = 0; ms < 100'000; ms += 7) {
    ASSERT_EQ(periods_of(ms * 1e-3, 1'000'000), ms);
  }
}
TEST(StatechartTime, ThePeriodsOfALongTimeDoNotOverflow) {
  EXPECT_EQ(periods_of(1e6, 10'000'000), 10'000'000'000);
}
TEST(StatechartTime, WhatIsNoTimeHasNoPeriods) {
  EXPECT_EQ(periods_of(-1e-9, 1'000'000), -1);
  EXPECT_EQ(periods_of(std::nan(""), 1'000'000), -1);
  EXPECT_EQ(periods_of(std::numeric_limits<double>::infinity(), 1'000'000), -1);
}

// A pure statechart that runs tick by tick at 1 kHz.
class Clock {
 public:
  explicit Clock(const std::string& text)
      : behavior(load(text)), values(behavior->values), chart(*behavior, nullptr, values) {
    chart.start(0);
  }
  void tick(std::int64_t at, const char* event = nullptr) {
    chart.begin_tick(at);
    if (event != nullptr) chart.raise(behavior->find_event(event));
    chart.run();
  }
  std::string active() const {
    return behavior->states[static_cast<std::size_t>(chart.active_atomic().front())].name;
  }
  std::unique_ptr<behaviors::Behavior> behavior;
  std::vector<double> values;
  behaviors::Statechart chart;
};

TEST(StatechartTime, AfterHoldsOnceItsStateWasActiveForThatLong) {
  Clock clock(chart("  states: {a: {after: 16 ms, to: b}, b: {}}"));
  for (int k = 0; k < 16; ++k) {
    clock.tick(k);
    ASSERT_EQ(clock.active(), "a") << k;
  }
  clock.tick(16);
  EXPECT_EQ(clock.active(), "b");
}
TEST(StatechartTime, SkippedPeriodsCount) {
  Clock clock(chart("  states: {a: {after: 16 ms, to: b}, b: {}}"));
  clock.tick(40);
  EXPECT_EQ(clock.active(), "b");
}
TEST(StatechartTime, TheDelayIsReadAtEntry) {
  Clock clock(
      "behavior: 1\nparameters: {d: {value: 10 ms}}\n"
      "machine: {states: {a: {after: $d, to: b}, b: {}}}");
  clock.values[0] = 1.0;
  clock.tick(10);
  EXPECT_EQ(clock.active(), "b");
}
TEST(StatechartTime, WithOnEarlierEventsDoNotCount) {
  Clock clock(chart("  states: {a: {transitions: [{on: e, after: 5 ms, to: b}]}, b: {}}"));
  clock.tick(4, "e");
  EXPECT_EQ(clock.active(), "a");
  clock.tick(7);
  EXPECT_EQ(clock.active(), "a");
  clock.tick(8, "e");
  EXPECT_EQ(clock.active(), "b");
}
TEST(StatechartTime, WithWhenBothMustHold) {
  Clock clock(
      "behavior: 1\nparameters: {n: {value: 0}}\nmachine:\n"
      "  states: {a: {transitions: [{when: $n > 0, after: 5 ms, to: b}]}, b: {}}");
  clock.tick(9);
  EXPECT_EQ(clock.active(), "a");
  clock.values[0] = 1.0;
  clock.tick(10);
  EXPECT_EQ(clock.active(), "b");
}
TEST(StatechartTime, AnEventlessTimerIsTakenOncePerEntry) {
  Clock clock(
      "behavior: 1\nparameters: {n: {value: 0}}\nmachine:\n"
      "  states: {a: {transitions: [{after: 5 ms, do: [{set: {n: '= $n + 1'}}]},"
      " {on: again, to: a}]}}");
  for (int k = 0; k <= 20; ++k) clock.tick(k);
  EXPECT_EQ(clock.values[0], 1.0);
  clock.tick(21, "again");
  for (int k = 22; k <= 40; ++k) clock.tick(k);
  EXPECT_EQ(clock.values[0], 2.0);
}
TEST(StatechartTime, TimersGoBeforeTheTicksEvents) {
  Clock clock(
      chart("  states: {a: {transitions: [{on: e, to: event}, {after: 5 ms, to: timer}]},"
            " event: {}, timer: {}}"));
  clock.tick(5, "e");
  EXPECT_EQ(clock.active(), "timer");
}
TEST(StatechartTime, TheStatesOwnDurationIsItsLastTransition) {
  Clock clock(
      chart("  states: {a: {after: 5 ms, to: own, transitions: [{after: 5 ms, to: listed}]},"
            " own: {}, listed: {}}"));
  clock.tick(5);
  EXPECT_EQ(clock.active(), "listed");
}
TEST(StatechartTime, AReentryStartsTheClockAnew) {
  Clock clock(chart("  states: {a: {after: 10 ms, to: b, transitions: [{on: e, to: a}]}, b: {}}"));
  clock.tick(8, "e");
  clock.tick(17);
  EXPECT_EQ(clock.active(), "a");
  clock.tick(18);
  EXPECT_EQ(clock.active(), "b");
}
TEST(StatechartTime, ADelayThatIsNoTimeRaisesAnErrorAndNeverHolds) {
  Clock clock(
      "behavior: 1\nparameters: {d: {value: 1 s}}\nmachine:\n"
      "  transitions: [{on: error.execution, to: caught}]\n"
      "  states: {a: {on_entry: [{set: {d: 0 s}}], after: '= 1 s - 1 s/$d*1 s', to: b}, b: {},"
      " caught: {}}");
  clock.tick(1);
  EXPECT_EQ(clock.active(), "caught");
}

}  // namespace
}  // namespace footfall::tests
