// A joint held by stiffness and damping over a series-elastic drive: the simulated drive against
// the sampled model, and late damping against late stiffness ([Kim16] IV-A; docs/impedance.md).
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "hal/actuators/drive.h"
#include "tests/support/sampled_impedance.h"
#include "tests/unit/hal/actuator_test_support.h"

namespace footfall::tests {
namespace {

constexpr int kDriveSteps = 4;  // in a step of the plant
constexpr int kPlantSteps = 2;  // in a period
constexpr double kLink = 0.3;   // kg m^2, of the link
constexpr double kRatio = 0.7;  // damping ratio of the task

// Hume's right knee without friction, its loop as in robots/hume, a period of delay.
SampledPlant knee_plant(double p) {
  SampledPlant plant;
  plant.inertia = Eigen::MatrixXd::Constant(1, 1, kLink);
  plant.damping = plant.stiffness = Eigen::MatrixXd::Zero(1, 1);
  hal::SeriesElasticParameters actuator = kKnee;
  actuator.viscous = 0.0;
  const double damping = 1.4 * std::sqrt((1.0 + p) * actuator.spring * actuator.rotor);
  plant.drive.joints = {{actuator,
                         actuator.spring,
                         {.type = hal::TorqueLoopGains::Type::direct,
                          .p = p,
                          .damping = damping,
                          .damps = hal::TorqueLoopGains::Damping::spring}}};
  plant.drive.step = kLoopStep;
  plant.drive.steps = kDriveSteps;
  plant.drive.filters = {300.0, 300.0};
  plant.steps_per_period = kDriveSteps * kPlantSteps;
  plant.drive.command_delay = plant.steps_per_period;
  return plant;
}

SampledLaw knee_law(double kp, int position_delay, int velocity_delay) {
  SampledLaw law;
  law.rows = Eigen::MatrixXd::Ones(1, 1);
  law.torque = Eigen::MatrixXd::Constant(1, 1, kLink);
  law.kp = Eigen::VectorXd::Constant(1, kp);
  law.ki = Eigen::VectorXd::Zero(1);
  law.kd = Eigen::VectorXd::Constant(1, 2.0 * kRatio * std::sqrt(kp));
  law.position_delay = position_delay;
  law.velocity_delay = velocity_delay;
  return law;
}

bool is_stable_by_model(const SampledPlant& plant, const SampledLaw& law) {
  return sampled_growth(plant, law) <= 1.0 + 1e-9;
}

// The drive and a link that moves as in the simulator (semi-implicit, the drive placed half a step
// back): whether a deviation is smaller in the end than it was in the middle.
bool is_stable_by_simulation(const SampledPlant& plant, const SampledLaw& law) {
  constexpr double kStep = kDriveSteps * kLoopStep;
  constexpr int kPeriods = 1500;
  hal::SeriesElasticDrive drive(plant.drive);
  std::array<double, 1> angle{1e-3}, rate{}, torque{};
  const std::array<double, 1> none{};
  drive.start(angle, none);
  std::vector<double> angles(1, angle[0]), rates(1, 0.0);
  double middle = 0.0, last = 0.0;
  for (int t = 0; t < kPeriods; ++t) {
    angles.push_back(angle[0]);
    rates.push_back(rate[0]);
    const auto seen = [&](const std::vector<double>& values, int delay) {
      return values[static_cast<std::size_t>(std::max(0, t + 1 - delay))];
    };
    const std::array<double, 1> command{-kLink * (law.kp[0] * seen(angles, law.position_delay) +
                                                  law.kd[0] * seen(rates, law.velocity_delay))};
    drive.command(command);
    for (int k = 0; k < kPlantSteps; ++k) {
      const std::array<double, 1> begin{angle[0] - 0.5 * kStep * rate[0]};
      drive.place(begin);
      drive.advance(rate, torque);
      rate[0] += kStep * torque[0] / kLink;
      angle[0] += kStep * rate[0];
    }
    double& largest = t < kPeriods / 2 ? middle : last;
    if (t % (kPeriods / 2) >= kPeriods / 4) largest = std::max(largest, std::abs(angle[0]));
  }
  return last < middle;
}

using Judge = bool (*)(const SampledPlant&, const SampledLaw&);

double largest_kp(Judge is_stable, double p) {
  const SampledPlant plant = knee_plant(p);
  double kp = 100.0;
  while (is_stable(plant, knee_law(1.02 * kp, 0, 0))) kp *= 1.02;
  return kp;
}

// Periods; of one of the two, the other prompt.
int longest_delay(Judge is_stable, double kp, bool of_velocity) {
  const SampledPlant plant = knee_plant(20.0);
  int delay = 0;
  while (delay < 100 &&
         is_stable(plant, knee_law(kp, of_velocity ? 0 : delay + 1, of_velocity ? delay + 1 : 0)))
    ++delay;
  return delay;
}

TEST(ImpedanceDelay, TheSampledModelFindsTheLargestStiffnessOfTheSimulatedDrive) {
  for (const double p : {2.0, 5.0, 10.0, 20.0}) {
    const double model = largest_kp(is_stable_by_model, p);
    EXPECT_NEAR(largest_kp(is_stable_by_simulation, p), model, 0.15 * model) << p;
  }
}

// At half of the largest stiffness: what is stable of either delay, model and simulation.
TEST(ImpedanceDelay, LateDampingHurtsMoreThanLateStiffness) {
  const double kp = 0.5 * largest_kp(is_stable_by_model, 20.0);
  const int late_damping = longest_delay(is_stable_by_model, kp, true);
  const int late_stiffness = longest_delay(is_stable_by_model, kp, false);
  RecordProperty("late_damping_periods", late_damping);
  RecordProperty("late_stiffness_periods", late_stiffness);
  EXPECT_EQ(late_damping, 3);
  EXPECT_EQ(late_stiffness, 18);
  EXPECT_NEAR(longest_delay(is_stable_by_simulation, kp, true), late_damping, 1);
  EXPECT_NEAR(longest_delay(is_stable_by_simulation, kp, false), late_stiffness,
              0.15 * late_stiffness);
}

TEST(ImpedanceDelay, AModelRefusesTorqueLoopsThatItLacks) {
  SampledPlant plant = knee_plant(20.0);
  plant.drive.joints[0].gains = kCascade;
  EXPECT_THROW(sampled_growth(plant, knee_law(100.0, 0, 0)), std::invalid_argument);
  plant = knee_plant(20.0);
  plant.drive.joints[0].gains.i = 1.0;
  EXPECT_THROW(sampled_growth(plant, knee_law(100.0, 0, 0)), std::invalid_argument);
}

// 1 to 4 periods: the largest stiffness falls by a fifth with the first of damping, and with
// stiffness it does not.
TEST(ImpedanceDelay, LateDampingLowersTheLargestStiffness) {
  const SampledPlant plant = knee_plant(20.0);
  const double prompt = largest_kp(is_stable_by_model, 20.0);
  double before = prompt;
  for (const int delay : {1, 2, 3, 4}) {
    EXPECT_TRUE(is_stable_by_model(plant, knee_law(0.98 * prompt, delay, 0))) << delay;
    double kp = before;
    while (!is_stable_by_model(plant, knee_law(kp, 0, delay))) kp *= 0.99;
    EXPECT_LT(kp, 0.9 * before) << delay;
    before = kp;
  }
  EXPECT_NEAR(before, 0.43 * prompt, 0.02 * prompt);
}

}  // namespace
}  // namespace footfall::tests
