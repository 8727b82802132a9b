// Statistics of samples, against values worked out by hand or by sorting.
#include "behaviors/expression/statistics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace footfall::behaviors {
namespace {

const double kNoValue = std::nan("");

double of(const char* name, const std::vector<double>& samples) {
  RunningStatistic statistic(*find_statistic(name));
  for (const double x : samples) statistic.add(x);
  return statistic.value();
}

// The position of the sample that decides; -1: none.
int decided_by(const char* name, const std::vector<double>& samples) {
  RunningStatistic statistic(*find_statistic(name));
  int place = -1;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (statistic.add(samples[k])) place = static_cast<int>(k);
  }
  return place;
}

TEST(Statistics, AreThoseOfTheSamples) {
  const std::vector<double> samples = {3.0, -4.0, kNoValue, 0.0, 1.0};
  EXPECT_EQ(of("max", samples), 3.0);
  EXPECT_EQ(of("min", samples), -4.0);
  EXPECT_EQ(of("mean", samples), 0.0);
  EXPECT_DOUBLE_EQ(of("rms", samples), std::sqrt(26.0 / 4.0));
  EXPECT_EQ(of("p95", samples), 3.0);
  EXPECT_EQ(of("count", samples), 2.0);  // 3 -4 are one time, 1 another
  EXPECT_EQ(find_statistic("median"), nullptr);
}

TEST(Statistics, OfNoSamplesThereIsNoneButACountOfZero) {
  for (const Statistic& statistic : kStatistics) {
    for (const std::vector<double>& samples : {std::vector<double>{}, {kNoValue, kNoValue}}) {
      const double value = of(statistic.name.data(), samples);
      if (statistic.name == "count") {
        EXPECT_EQ(value, 0.0);
      } else {
        EXPECT_TRUE(std::isnan(value)) << statistic.name;
      }
    }
  }
}

TEST(Statistics, ASignalThatLosesItsValueBecomesTrueAgain) {
  EXPECT_EQ(of("count", {1.0, kNoValue, 1.0, 1.0}), 2.0);
}

TEST(Statistics, TheSampleThatDecidesIsTheGreatestTheSmallestOrTheLargest) {
  const std::vector<double> samples = {1.0, -5.0, 4.0, -5.0};
  EXPECT_EQ(decided_by("max", samples), 2);
  EXPECT_EQ(decided_by("min", samples), 1);
  EXPECT_EQ(decided_by("rms", samples), 1);
  EXPECT_EQ(decided_by("p95", samples), 2);
  EXPECT_EQ(decided_by("max", {kNoValue}), -1);
}

// Nearest rank over the sorted samples so far, after each sample; ties and order included.
TEST(Statistics, P95IsTheNearestRankOfTheSortedSamples) {
  std::mt19937 random(5);
  for (int round = 0; round < 20; ++round) {
    RunningStatistic statistic(*find_statistic("p95"));
    std::vector<double> sorted;
    for (int n = 1; n <= 250; ++n) {
      const double x = static_cast<double>(static_cast<int>(random() % 60U)) - 30.0;
      statistic.add(x);
      sorted.insert(std::ranges::upper_bound(sorted, x), x);
      const int rank = (19 * n + 19) / 20;  // ceil(0.95 n)
      ASSERT_EQ(statistic.value(), sorted[static_cast<std::size_t>(rank - 1)]) << n;
    }
  }
}

TEST(Statistics, P95OfMoreSamplesThanItKeepsHasNoValue) {
  RunningStatistic statistic(*find_statistic("p95"));
  for (std::size_t k = 0; k < kMostKeptSamples; ++k) statistic.add(static_cast<double>(k));
  EXPECT_EQ(statistic.value(), 949'999.0);
  statistic.add(0.0);
  EXPECT_TRUE(std::isnan(statistic.value()));
}

}  // namespace
}  // namespace footfall::behaviors
