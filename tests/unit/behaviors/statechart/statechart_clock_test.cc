// Timers at Hume's 1500 Hz over long runs: exact numbers of periods, and no drift.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

constexpr std::int64_t kDay = 24LL * 3600 * 1500;  // periods

// A state that follows itself after `time`, at 1500 Hz, beside one that lasts a day.
class Repeater {
 public:
  explicit Repeater(const std::string& time)
      : behavior_(load("behavior: 1\nrobot: hume\nmachine:\n  type: parallel\n  states:\n"
                       "    r: {states: {a: {after: " +
                       time +
                       ", to: a}}}\n"
                       "    day: {states: {today: {after: 86400 s, to: over}, over: {}}}\n")),
        signals_(behavior_->signals),
        values_(behavior_->values),
        chart_(*behavior_, signals_.values(), values_) {
    chart_.start(0);
  }
  // Whether the state began anew in this tick.
  bool begins(std::int64_t tick) {
    chart_.begin_tick(tick);
    chart_.run();
    return chart_.entry_tick(2) == tick;
  }
  bool day_is_over() const { return chart_.is_active(5); }

 private:
  std::unique_ptr<behaviors::Behavior> behavior_;
  core::SignalTable signals_;
  std::vector<double> values_;
  behaviors::Statechart chart_;
};

// Every tick is run; the state must begin anew at the multiples of `periods` and nowhere else.
std::int64_t wrong_ticks(const std::string& time, std::int64_t periods, std::int64_t last) {
  Repeater repeater(time);
  std::int64_t wrong = 0;
  for (std::int64_t tick = 1; tick <= last; ++tick) {
    if (repeater.begins(tick) != (tick % periods == 0)) ++wrong;
  }
  return wrong;
}

TEST(StatechartClock, SixteenMillisecondsLast24PeriodsTenThousandTimes) {
  EXPECT_EQ(wrong_ticks("16 ms", 24, 10'000 * 24), 0);
}
TEST(StatechartClock, A145MillisecondLiftLasts218PeriodsTenThousandTimes) {
  EXPECT_EQ(wrong_ticks("145 ms", 218, 10'000 * 218), 0);
}
TEST(StatechartClock, A150MillisecondLandingLasts225PeriodsTenThousandTimes) {
  EXPECT_EQ(wrong_ticks("150 ms", 225, 10'000 * 225), 0);
}
// Only the ticks around each end are run: what is skipped counts.
TEST(StatechartClock, ATimerThatRepeatsForADayDoesNotDrift) {
  for (const auto& [time, periods] :
       {std::pair("16 ms", 24), std::pair("145 ms", 218), std::pair("150 ms", 225)}) {
    Repeater repeater(time);
    std::int64_t wrong = 0;
    for (std::int64_t tick = periods; tick <= kDay; tick += periods) {
      if (repeater.begins(tick - 1)) ++wrong;
      if (!repeater.begins(tick)) ++wrong;
      if (tick < kDay && repeater.day_is_over()) ++wrong;
    }
    EXPECT_EQ(wrong, 0) << time;
    repeater.begins(kDay);
    EXPECT_TRUE(repeater.day_is_over());
  }
}

}  // namespace
}  // namespace footfall::tests
