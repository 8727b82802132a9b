// Numbers of a seed. Oracle: the distributions of libstdc++, which drew them first.
#include "core/random.h"

#include <gtest/gtest.h>

namespace footfall::tests {
namespace {

#ifdef __GLIBCXX__
TEST(Random, NumbersAreThoseOfLibstdcxxBitForBit) {
  std::mt19937_64 ours(7), theirs(7);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (int k = 0; k < 100'000; ++k) EXPECT_EQ(core::uniform(ours), uniform(theirs));
  core::Normal normal;
  std::normal_distribution<double> their_normal;
  for (int k = 0; k < 100'000; ++k) EXPECT_EQ(normal(ours), their_normal(theirs));
}
#endif

// Fixed, so that another standard library is compared with something.
TEST(Random, TheFirstNumbersOfASeed) {
  std::mt19937_64 engine(1);
  EXPECT_EQ(engine(), 2469588189546311528ULL);
  engine.seed(1);
  EXPECT_EQ(core::uniform(engine), 2469588189546311528.0 / 18446744073709551616.0);
}

TEST(Random, TheLargestNumberStaysBelowOne) {
  EXPECT_EQ(static_cast<double>(~0ULL) * 0x1p-64, 1.0);  // what is caught
  std::mt19937_64 engine(3);
  for (int k = 0; k < 100'000; ++k) EXPECT_LT(core::uniform(engine), 1.0);
}

}  // namespace
}  // namespace footfall::tests
