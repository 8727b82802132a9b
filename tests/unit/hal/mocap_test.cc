// Frames of motion capture: when they come, what they show, what they lack.
#include "hal/sensors/mocap.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/unit/hal/sensor_test_support.h"

namespace footfall::hal {
namespace {

// Markers at the base's origin and beside it.
SensorPlaces with_markers(int count) {
  SensorPlaces places;
  places.markers = count;
  for (int m = 0; m < count; ++m) {
    places.p_BM[static_cast<std::size_t>(m)] = {0.0, 0.1 * m, 0.0};
  }
  return places;
}

constexpr double kSpeed = 0.5;  // m/s, along x
BaseMotion moving(double time) { return {.p_WB = {kSpeed * time, 0, 0}, .v_WB = {kSpeed, 0, 0}}; }

// Calls seen(sensors, time) for each of `ticks` ticks of a base that moves along x.
template <typename Seen>
void watch(const MocapErrors& errors, int markers, std::int64_t ticks, std::uint64_t seed,
           Seen seen) {
  Mocap mocap(errors, with_markers(markers), kTick, seed);
  mocap.start(moving(0.0));
  Sensors sensors;
  for (std::int64_t tick = 0; tick < ticks; ++tick) {
    const double time = static_cast<double>(tick) * kTick;
    mocap.sample(moving(time), sensors);
    seen(sensors, time);
  }
}

TEST(Mocap, APerfectOneShowsEveryMarkerInEveryTick) {
  watch({}, 3, 10, 1, [](const Sensors& s, double time) {
    ASSERT_TRUE(s.mocap_fresh);
    EXPECT_EQ(s.mocap_age, 0.0);
    for (std::size_t m = 0; m < 3; ++m) {
      EXPECT_TRUE(s.marker_seen[m]);
      EXPECT_DOUBLE_EQ(s.marker[m][0], kSpeed * time);
      EXPECT_DOUBLE_EQ(s.marker[m][1], 0.1 * static_cast<double>(m));
    }
    EXPECT_FALSE(s.marker_seen[3]);
  });
}

// 480 Hz in ticks of 1500 Hz: frame k is of k / 480 s and comes in the first tick from 5 ms later.
// The cameras have run before the start: the frame that is due then, -3, shows where the body
// starts.
TEST(Mocap, FramesComeAtTheirRateAndAreAsOldAsTheySay) {
  std::int64_t frames = -3;
  watch({.rate = 480.0, .delay = 5e-3}, 1, 15'000, 1, [&](const Sensors& s, double time) {
    if (!s.mocap_fresh) return;
    const double exposure = static_cast<double>(frames) / 480.0;
    ASSERT_NEAR(s.mocap_age, time - exposure, 1e-12);
    ASSERT_GE(s.mocap_age, 5e-3 - 1e-9);
    ASSERT_LT(s.mocap_age, 5e-3 + (frames == -3 ? 1.0 / 480.0 : kTick));
    ASSERT_NEAR(s.marker[0][0], kSpeed * std::max(exposure, 0.0), kDigit);
    ++frames;
  });
  // Exposed up to 5 ms before the last tick, at 9.99433 s.
  EXPECT_EQ(frames, static_cast<std::int64_t>(480.0 * (14'999 * kTick - 5e-3)) + 1);
}

TEST(Mocap, BetweenFramesMarkersKeepTheirPlaces) {
  double last = 0.0;
  watch({.rate = 480.0}, 1, 100, 1, [&](const Sensors& s, double) {
    if (!s.mocap_fresh) {
      EXPECT_EQ(s.marker[0][0], last);
    }
    last = s.marker[0][0];
  });
}

TEST(Mocap, OfSeveralFramesInATickTheNewestCounts) {
  watch({.rate = 6000.0}, 1, 100, 1, [&](const Sensors& s, double) {
    ASSERT_TRUE(s.mocap_fresh);
    EXPECT_NEAR(s.mocap_age, 0.0, 1e-12);
  });
}

TEST(Mocap, CoordinatesHaveWhiteNoise) {
  std::vector<double> noise;
  watch({.noise = 1e-3}, 2, 20'000, 2, [&](const Sensors& s, double) {
    noise.push_back(s.marker[0][2]);
    noise.push_back(s.marker[1][2]);
  });
  EXPECT_NEAR(mean_of(noise), 0.0, mean_bound(1e-3, noise.size()));
  EXPECT_NEAR(variance_of(noise), 1e-6, variance_bound(1e-6, noise.size()));
}

TEST(Mocap, FramesAreLostWithTheirProbability) {
  constexpr std::int64_t kFrames = 60'000;
  std::int64_t lost = 0;
  watch({.dropped = 0.01}, 1, kFrames, 2,
        [&](const Sensors& s, double) { lost += !s.mocap_fresh; });
  EXPECT_NEAR(static_cast<double>(lost) / kFrames, 0.01,
              mean_bound(std::sqrt(0.01 * 0.99), kFrames));
}

// A chain of two states forgets itself with the time constant t = spell (1 - p): over a time T the
// share has the variance 2 p (1 - p) t / T. A spell that is sampled every d ends with the
// probability (1 - p)(1 - exp(-d / t)) and lasts d over it in the mean.
TEST(Mocap, MarkersAreHiddenInSpells) {
  constexpr double kPart = 0.05, kSpell = 0.1, kRate = 480.0, kTime = 600.0;
  constexpr std::size_t kMarkers = 8;
  std::array<bool, kMarkers> hidden{};
  double frames = 0.0, hidden_frames = 0.0, spells = 0.0;
  const MocapErrors errors = {.rate = kRate, .occlusion = kPart, .spell = kSpell};
  watch(errors, kMarkers, static_cast<std::int64_t>(kTime / kTick), 4,
        [&](const Sensors& s, double) {
          if (!s.mocap_fresh) return;
          for (std::size_t m = 0; m < kMarkers; ++m) {
            frames += 1.0;
            hidden_frames += s.marker_seen[m] ? 0.0 : 1.0;
            spells += !s.marker_seen[m] && !hidden[m] ? 1.0 : 0.0;
            hidden[m] = !s.marker_seen[m];
          }
        });
  const double memory = kSpell * (1.0 - kPart);
  const double share_deviation =
      std::sqrt(2.0 * kPart * (1.0 - kPart) * memory / (kTime * kMarkers));
  EXPECT_NEAR(hidden_frames / frames, kPart, kSigmas * share_deviation);
  const double ends = (1.0 - kPart) * (1.0 - std::exp(-1.0 / (kRate * memory)));
  const double mean = 1.0 / (kRate * ends);
  EXPECT_NEAR(hidden_frames / (kRate * spells), mean,
              mean_bound(mean, static_cast<std::size_t>(spells)));
  EXPECT_NEAR(mean, kSpell, 0.02 * kSpell);
}

TEST(Mocap, AHiddenMarkerKeepsItsPlaceAndTheOthersTheirNoise) {
  const MocapErrors noisy = {.noise = 1e-3};
  MocapErrors hidden = noisy;
  hidden.occlusion = 0.3;
  std::vector<Sensors> with, without;
  watch(noisy, 2, 500, 6, [&](const Sensors& s, double) { without.push_back(s); });
  watch(hidden, 2, 500, 6, [&](const Sensors& s, double) { with.push_back(s); });
  for (std::size_t k = 1; k < with.size(); ++k) {
    for (std::size_t m = 0; m < 2; ++m) {
      ASSERT_EQ(with[k].marker[m],
                with[k].marker_seen[m] ? without[k].marker[m] : with[k - 1].marker[m]);
    }
  }
}

TEST(Mocap, MarkersOfASeedAreBesideTheirPlacesForGood) {
  std::vector<double> offsets;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    std::array<double, 3> first{};
    watch({.placement = 1e-3}, 1, 3, seed, [&](const Sensors& s, double time) {
      std::array<double, 3> offset = s.marker[0];
      offset[0] -= kSpeed * time;
      if (time == 0.0) first = offset;
      for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(offset[k], first[k], kDigit);
    });
    offsets.insert(offsets.end(), first.begin(), first.end());
  }
  EXPECT_NEAR(variance_of(offsets), 1e-6, variance_bound(1e-6, offsets.size()));
}

TEST(Mocap, ADelayThatTheLineDoesNotHoldIsRefused) {
  EXPECT_THROW(Mocap({.rate = 1e4, .delay = 1.0}, with_markers(1), kTick, 1), std::runtime_error);
}

}  // namespace
}  // namespace footfall::hal
