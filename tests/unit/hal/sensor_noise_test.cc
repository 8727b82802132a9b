// Streams of random numbers: their moments, and that they do not depend on each other.
#include <gtest/gtest.h>

#include "hal/sensors/noise.h"
#include "tests/unit/hal/sensor_test_support.h"

namespace footfall::hal {
namespace {

constexpr std::size_t kMany = 100'000;

std::vector<double> normals(NoiseStream stream, std::size_t count) {
  std::vector<double> out;
  for (std::size_t k = 0; k < count; ++k) out.push_back(stream.normal());
  return out;
}

TEST(NoiseStream, NormalNumbersHaveMeanZeroDeviationOneAndNoMemory) {
  const std::vector<double> x = normals(NoiseStream(7, NoiseSource::gyro_noise), kMany);
  EXPECT_NEAR(mean_of(x), 0.0, mean_bound(1.0, kMany));
  EXPECT_NEAR(variance_of(x), 1.0, variance_bound(1.0, kMany));
  std::vector<double> products;
  for (std::size_t k = 1; k < x.size(); ++k) products.push_back(x[k] * x[k - 1]);
  EXPECT_NEAR(mean_of(products), 0.0, mean_bound(1.0, kMany));
}

TEST(NoiseStream, UniformNumbersFillZeroToOne) {
  NoiseStream stream(7, NoiseSource::switch_jitter);
  std::vector<double> x;
  for (std::size_t k = 0; k < kMany; ++k) {
    x.push_back(stream.uniform() - 0.5);
    ASSERT_LT(std::abs(x.back()), 0.5 + 1e-16);
  }
  EXPECT_NEAR(mean_of(x), 0.0, mean_bound(std::sqrt(1.0 / 12.0), kMany));
  // The fourth moment 1/80 gives the deviation of the estimated variance.
  const double bound = mean_bound(std::sqrt(1.0 / 80.0 - 1.0 / 144.0), kMany);
  EXPECT_NEAR(variance_of(x), 1.0 / 12.0, bound);
}

TEST(NoiseStream, SeedSourceAndIndexTellStreamsApart) {
  const std::vector<double> x = normals(NoiseStream(7, NoiseSource::gyro_noise), 10);
  EXPECT_EQ(normals(NoiseStream(7, NoiseSource::gyro_noise), 10), x);
  EXPECT_NE(normals(NoiseStream(8, NoiseSource::gyro_noise), 10), x);
  EXPECT_NE(normals(NoiseStream(7ULL + (1ULL << 32U), NoiseSource::gyro_noise), 10), x);
  EXPECT_NE(normals(NoiseStream(7, NoiseSource::gyro_walk), 10), x);
  EXPECT_NE(normals(NoiseStream(7, NoiseSource::gyro_noise, 1), 10), x);
}

TEST(RandomWalk, ItsVarianceGrowsWithTime) {
  constexpr int kTicks = 150;
  std::vector<double> ends;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    NoiseStream stream(seed, NoiseSource::gyro_walk);
    RandomWalk walk;
    for (int k = 0; k < kTicks; ++k) walk.advance(0.02, kTick, stream);
    ends.insert(ends.end(), walk.value.begin(), walk.value.end());
  }
  const double variance = 0.02 * 0.02 * kTicks * kTick;
  EXPECT_NEAR(variance_of(ends), variance, variance_bound(variance, ends.size()));
}

TEST(Digital, ValuesAreTheNearestMultiples) {
  for (const double x : {0.3, -9.81, 1e-7, 123.456}) {
    EXPECT_LE(std::abs(digital(x) - x), 0.5 * kDigit);
    EXPECT_EQ(std::fmod(digital(x), kDigit), 0.0);
  }
}

}  // namespace
}  // namespace footfall::hal
