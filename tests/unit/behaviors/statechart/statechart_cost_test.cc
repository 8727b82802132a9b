// A chart of 200 states allocates nothing, whatever transition it takes.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/allocation_guard.h"
#include "tests/support/big_chart.h"

namespace footfall::tests {
namespace {

TEST(StatechartCost, NoTransitionOfABigChartAllocates) {
  BigChart chart;
  ASSERT_EQ(chart.behavior->states.size(), static_cast<std::size_t>(kBigStates));
  ASSERT_EQ(chart.behavior->transitions.size(), static_cast<std::size_t>(kBigTransitions));
  std::vector<int> taken(kBigTransitions);
  long allocations = 0;
  {
    const AllocationGuard guard;
    for (int k = 0; k < 100'000; ++k) {
      chart.drive();
      for (const int t : chart.machine.transitions_taken()) ++taken[static_cast<std::size_t>(t)];
    }
    allocations = guard.allocations();
  }
  EXPECT_EQ(allocations, 0);
  EXPECT_EQ(std::count(taken.begin(), taken.end(), 0), 0);
}

}  // namespace
}  // namespace footfall::tests
