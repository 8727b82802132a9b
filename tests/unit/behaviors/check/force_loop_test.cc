// What feedback of a measured internal force bears, beside the loop stepped in time.
#include "behaviors/check/actuators/force_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "hal/actuators/drive.h"

namespace footfall::tests {
namespace {

using behaviors::DriveTiming;
using behaviors::FeedbackGains;
using behaviors::ForceLoop;
using behaviors::TensionPlant;
using hal::TorqueLoopGains;

constexpr double kServoPeriod = 1.0 / 1500.0;  // s
constexpr int kDriveSteps = 8;                 // a period
constexpr double kDriveStep = kServoPeriod / kDriveSteps;

// One joint of the tension: its share, and what drives it.
struct Joint {
  double share = 1.0;
  hal::SeriesElasticParameters actuator;
  TorqueLoopGains gains;
};

struct Case {
  std::vector<Joint> joints;
  DriveTiming timing = {kDriveSteps, 0, 1};
  double step = kDriveStep;
  hal::RateFilters filters;
  double bandwidth = 20.0;  // Hz
};

TorqueLoopGains direct(double p, double forward, double damping) {
  TorqueLoopGains gains;
  gains.type = TorqueLoopGains::Type::direct;
  gains.damps = TorqueLoopGains::Damping::spring;
  gains.p = p;
  gains.forward = forward;
  gains.damping = damping;
  return gains;
}
// Of the damping ratio of J s^2 + d s + k (1 + p).
double damping_for(double ratio, const hal::SeriesElasticParameters& actuator, double p) {
  return 2.0 * ratio * std::sqrt(actuator.rotor * actuator.spring * (1.0 + p));
}

TensionPlant plant_of(const Case& c) {
  std::vector<behaviors::TorqueResponse> joints;
  for (const Joint& joint : c.joints) {
    joints.emplace_back(behaviors::torque_loop_map(joint.gains, joint.actuator, c.step, c.filters),
                        c.timing);
  }
  return TensionPlant::elastic(joints);
}
std::vector<double> shares_of(const Case& c) {
  std::vector<double> shares;
  for (const Joint& joint : c.joints) shares.push_back(joint.share);
  return shares;
}
double limit_of(const Case& c, const FeedbackGains& gains = {}) {
  const TensionPlant plant = plant_of(c);
  return ForceLoop(plant, shares_of(c), c.bandwidth, c.timing.steps * c.step).limit(gains);
}

// Drives with their outputs locked, and the servo around them: the tension's error after so many
// periods over what it was at first, both as the largest within 100 periods.
double grown(const Case& c, const FeedbackGains& gains, int periods) {
  hal::DriveSettings settings;
  for (const Joint& joint : c.joints) {
    settings.joints.push_back({joint.actuator, joint.actuator.spring, joint.gains});
  }
  settings.step = c.step;
  settings.steps = c.timing.steps;
  settings.command_delay = c.timing.command_delay;
  settings.measurement_delay = c.timing.measurement_delay - 1;
  settings.filters = c.filters;
  hal::SeriesElasticDrive drive(settings);
  const std::size_t n = c.joints.size();
  const std::vector<double> locked(n, 0.0);
  std::vector<double> torques(n, 1.0);
  drive.start(locked, torques);
  const double period = c.step * c.timing.steps;
  const double share =
      c.bandwidth > 0.0 ? 1.0 - std::exp(-2.0 * std::numbers::pi * c.bandwidth * period) : 1.0;
  double y = 1.0, sum = 0.0, first = 0.0, last = 0.0;
  for (int k = 0; k < periods; ++k) {
    double tension = 0.0;
    for (std::size_t j = 0; j < n; ++j) {
      tension += c.joints[j].share * drive.measured(static_cast<int>(j)).torque;
    }
    y += share * (tension - y);
    sum -= period * y;
    const double asked = -gains.proportional * y + gains.integral * sum;
    if (k < 100) first = std::max(first, std::abs(asked));
    if (k >= periods - 100) last = std::max(last, std::abs(asked));
    if (!(last < 1e12)) break;
    std::ranges::fill(torques, asked);
    drive.command(torques);
    drive.advance(locked, torques);
  }
  return last / first;
}

// |exp(i t) - a|/(1 - a) at the least t in (0, pi) with (n - 1) t + arg(exp(i t) - a) = pi, the
// first crossing of z^n - a z^(n-1) + K (1 - a) = 0.
double ideal_limit(double bandwidth, int periods) {
  const double a =
      bandwidth > 0.0 ? std::exp(-2.0 * std::numbers::pi * bandwidth * kServoPeriod) : 0.0;
  const auto distance = [a](double t) { return std::polar(1.0, t) - a; };
  double low = 0.0, high = std::numbers::pi;
  for (int k = 0; k < 60; ++k) {
    const double t = 0.5 * (low + high);
    const double angle = (periods - 1) * t + std::arg(distance(t));
    (angle < std::numbers::pi ? low : high) = t;
  }
  return std::abs(distance(high)) / (1.0 - a);
}

// 1500 Hz; of the characteristic polynomial, as solved beforehand, two digits.
TEST(ForceLoop, OfIdealTorquesBearsWhatThePolynomialSays) {
  const struct {
    double bandwidth;
    std::array<double, 4> limits;  // n = 1, 2, 3, 4
  } rows[] = {{20.0, {23.9, 12.4, 8.0, 5.9}},
              {40.0, {12.0, 6.5, 4.3, 3.3}},
              {80.0, {6.0, 3.5, 2.5, 2.0}},
              {0.0, {1.0, 1.0, 1.0, 1.0}}};
  for (const auto& row : rows) {
    for (int n = 1; n <= 4; ++n) {
      const TensionPlant plant = TensionPlant::ideal(n);
      const ForceLoop loop(plant, {1.0}, row.bandwidth, kServoPeriod);
      const double limit = loop.limit({0.5});
      EXPECT_NEAR(limit, row.limits[static_cast<std::size_t>(n) - 1], 0.051) << row.bandwidth;
      EXPECT_NEAR(limit, ideal_limit(row.bandwidth, n), 1e-9 * limit) << row.bandwidth << ' ' << n;
      EXPECT_TRUE(loop.is_stable({0.995 * limit})) << row.bandwidth << ' ' << n;
      EXPECT_FALSE(loop.is_stable({1.005 * limit})) << row.bandwidth << ' ' << n;
      EXPECT_TRUE(loop.is_stable({-0.99})) << row.bandwidth << ' ' << n;
      EXPECT_FALSE(loop.is_stable({-1.01})) << row.bandwidth << ' ' << n;
      EXPECT_NEAR(loop.limit({2.0 * limit}), limit, 1e-9 * limit) << row.bandwidth << ' ' << n;
    }
  }
}

// n = 1, no low-pass: (z - 1)(z + K) + K_I T z = z^2 + (K - 1 + K_I T) z - K, whose roots are
// within the unit circle for |K| < 1 and K_I T < 2 (1 - K) (Jury).
TEST(ForceLoop, AnIntegralOfIdealTorquesIsHeldToJurysTest) {
  const TensionPlant plant = TensionPlant::ideal(1);
  const ForceLoop loop(plant, {1.0}, 0.0, kServoPeriod);
  for (const double scaled : {1e-4, 0.01, 0.3, 1.0, 1.9}) {
    const double most = 1.0 - 0.5 * scaled;
    const double integral = scaled / kServoPeriod;
    EXPECT_NEAR(loop.limit({0.0, integral}), most, 1e-9) << scaled;
    EXPECT_TRUE(loop.is_stable({most - 1e-3, integral})) << scaled;
    EXPECT_FALSE(loop.is_stable({most + 1e-3, integral})) << scaled;
  }
  EXPECT_FALSE(loop.is_stable({0.0, 2.1 / kServoPeriod}));
  EXPECT_EQ(loop.limit({0.0, 2.1 / kServoPeriod}), 0.0);
}

// Hume's rotors on springs of 415 N m/rad, k (F + Kp)/(J s^2 + d s + k (1 + Kp)) with a damping
// ratio of 0.7, held over a period (step-invariant, closed form), the torque read at once; as
// solved beforehand by the crossings of the real axis.
TEST(ForceLoop, OfContinuousTorqueLoopsBearsWhatTheirSampledResponseSays) {
  constexpr int kSteps = 200;
  const auto limit = [&](double rotor, double p, double forward, int periods) {
    const hal::SeriesElasticParameters actuator{.spring = 415.0, .rotor = rotor};
    Case c;
    c.joints = {{1.0, actuator, direct(p, forward, damping_for(0.7, actuator, p))}};
    c.timing = {kSteps, (periods - 1) * kSteps, 0};
    c.step = kServoPeriod / kSteps;
    return limit_of(c);
  };
  // The loop's own half step of 1.7 us of some ms moves them by a part in a thousand.
  constexpr double kWithin = 4e-3;
  const struct {
    double rotor, p, forward;
    std::array<double, 3> limits;  // n = 1, 2, 3
  } rows[] = {{0.0872756, 20.0, 1.0, {6.026, 4.468, 3.654}},
              {0.0872756, 0.8, 0.0, {11.014, 9.447, 8.349}},
              {0.1357200, 20.0, 1.0, {5.469, 4.213, 3.502}},
              {0.1357200, 0.8, 0.0, {11.599, 10.099, 8.991}}};
  for (const auto& row : rows) {
    for (int n = 1; n <= 3; ++n) {
      const double expected = row.limits[static_cast<std::size_t>(n) - 1];
      EXPECT_NEAR(limit(row.rotor, row.p, row.forward, n), expected, kWithin * expected)
          << row.rotor << ' ' << row.p << ' ' << n;
    }
  }
}

// A torque that has followed its reference before it is read is ideal.
TEST(ForceLoop, OfStiffActuatorsIsThatOfIdealOnes) {
  constexpr int kSteps = 200;
  const hal::SeriesElasticParameters stiff{.spring = 1e6, .rotor = 1e-4};  // 1e5 rad/s
  for (const double bandwidth : {20.0, 80.0}) {
    for (int n = 1; n <= 3; ++n) {
      Case c;
      c.joints = {{1.0, stiff, direct(0.0, 1.0, damping_for(1.0, stiff, 0.0))}};
      c.timing = {kSteps, (n - 1) * kSteps, 1};
      c.step = kServoPeriod / kSteps;
      c.bandwidth = bandwidth;
      EXPECT_NEAR(limit_of(c), ideal_limit(bandwidth, n), 1e-6) << bandwidth << ' ' << n;
    }
  }
}

// Of every type of torque loop, with both delays in parts of a period.
TEST(ForceLoop, GrowsExactlyWhereTheDrivesDo) {
  std::mt19937_64 random(11);
  const auto within = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int judged = 0;
  for (int trial = 0; judged < 60; ++trial) {
    ASSERT_LT(trial, 400);
    Case c;
    const double part = within(0.2, 0.8);
    for (const double share : {part, 1.0 - part}) {
      Joint joint = {share, {.spring = within(200, 600), .rotor = within(0.05, 0.15)}, {}};
      joint.actuator.viscous = trial % 2 == 0 ? 0.0 : within(0.0, 5.0);
      const double p = within(0.5, 20.0);
      joint.gains =
          direct(p, trial % 3 == 0 ? 0.0 : 1.0, damping_for(within(0.5, 1.0), joint.actuator, p));
      if (trial % 4 == 1) joint.gains.i = within(1.0, 20.0);
      if (trial % 4 == 2) joint.gains.observer = within(1.0, 10.0);
      if (trial % 4 == 3) {
        joint.gains = {};
        joint.gains.type = TorqueLoopGains::Type::cascade;
        joint.gains.velocity_p = within(20.0, 60.0);
        joint.gains.velocity_i = within(0.0, 100.0);
        joint.gains.p = within(0.1, 0.5);
        joint.gains.i = within(0.0, 2.0);
      }
      c.joints.push_back(joint);
    }
    if (trial % 5 == 0) c.filters = {within(200, 600), within(200, 600)};
    c.timing.command_delay = static_cast<int>(within(0.0, 25.0));
    c.timing.measurement_delay = 1 + static_cast<int>(within(0.0, 25.0));
    c.bandwidth = within(5.0, 80.0);
    const FeedbackGains gains{0.0, trial % 2 == 0 ? within(0.5, 10.0) : 0.0};
    std::vector<behaviors::TorqueResponse> actuators;
    const bool alone = std::ranges::all_of(c.joints, [&](const Joint& joint) {
      const double growth =
          behaviors::torque_loop_growth(joint.gains, joint.actuator, c.step, c.filters);
      return growth < 0.9999;  // within 1 s
    });
    if (!alone) continue;
    const double limit = limit_of(c, gains);
    if (limit == 0.0) continue;
    ++judged;
    EXPECT_LT(grown(c, {0.98 * limit, gains.integral}, 30000), 0.5) << trial << ' ' << limit;
    EXPECT_GT(grown(c, {1.02 * limit, gains.integral}, 30000), 2.0) << trial << ' ' << limit;
  }
}

}  // namespace
}  // namespace footfall::tests
