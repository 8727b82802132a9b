// A whole simulated day, tick by tick (label full).
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(StatechartDay, EveryTickOfADayFindsTheTimerWhereItShouldBe) {
  constexpr std::int64_t kDay = 24LL * 3600 * 1500;  // periods at Hume's 1500 Hz
  constexpr std::int64_t kPeriods = 218;             // ceil(145 ms * 1500 Hz)
  const auto behavior =
      load("behavior: 1\nrobot: hume\nmachine: {states: {a: {after: 145 ms, to: a}}}");
  core::SignalTable signals = behavior->signals;
  std::vector<double> values = behavior->values;
  behaviors::Statechart chart(*behavior, signals.values(), values);
  chart.start(0);
  std::int64_t wrong = 0;
  for (std::int64_t tick = 1; tick <= kDay; ++tick) {
    chart.begin_tick(tick);
    chart.run();
    if (chart.entry_tick(1) != tick / kPeriods * kPeriods) ++wrong;
  }
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace footfall::tests
