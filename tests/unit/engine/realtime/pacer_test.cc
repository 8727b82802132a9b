// Pacing by absolute boundaries. Time is only bounded from below, and above by half a second.
#include "engine/realtime/pacer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

namespace footfall::engine {
namespace {

using Clock = std::chrono::steady_clock;  // CLOCK_MONOTONIC, as the pacer's
using std::chrono::milliseconds;

TEST(Pacer, SleepsToTheEndOfEachPeriod) {
  Pacer pacer(0.02);
  const auto start = Clock::now();
  for (int k = 1; k <= 5; ++k) pacer.wait();
  EXPECT_GE(Clock::now() - start, milliseconds(5 * 20));
}

TEST(Pacer, AnOverrunIsToldAndSkipsToTheNextBoundary) {
  constexpr auto kPause = milliseconds(500);
  Pacer pacer(0.5);
  const auto before = Clock::now();
  ASSERT_TRUE(pacer.wait());  // boundaries are whole periods after this call
  std::this_thread::sleep_for(kPause + milliseconds(150));
  EXPECT_FALSE(pacer.wait());  // late: it does not wait
  const auto late = Clock::now();
  ASSERT_TRUE(pacer.wait());
  const auto next = Clock::now();
  // Boundary 3 of the clock, neither a burst (2) nor one too many (4).
  EXPECT_GE(next - before, 3 * kPause);
  EXPECT_LT(next - late, kPause);
}

}  // namespace
}  // namespace footfall::engine
