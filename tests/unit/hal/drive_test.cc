// The drive of a robot: delays, encoders, and the response of both kinds of torque loop.
#include "hal/actuators/drive.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <stdexcept>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include "tests/support/allocation_guard.h"
#include "tests/unit/hal/actuator_test_support.h"

namespace footfall::tests {
namespace {

using hal::DriveSettings;
using hal::SeriesElasticDrive;
using hal::TorqueLoopGains;
using Complex = std::complex<double>;

constexpr std::array<double, 1> kAtZero{};  // rad
constexpr int kTick = 8;                    // steps of a control period

DriveSettings one_joint(const TorqueLoopGains& gains) {
  DriveSettings settings;
  settings.joints = {{kKnee, kKnee.spring, gains}};
  settings.step = kLoopStep;
  return settings;
}

TEST(Drive, StartsWithSpringsThatCarryTheTorquesGiven) {
  SeriesElasticDrive drive(one_joint(kDirect));
  const std::array<double, 1> torque{12.0};
  drive.start(kAtZero, torque);
  EXPECT_DOUBLE_EQ(drive.measured(0).torque, 12.0);
  EXPECT_DOUBLE_EQ(drive.actuator(0).spring_torque(), 12.0);
}

TEST(Drive, ACommandArrivesAfterItsDelay) {
  for (const int delay : {0, 1, 8, 13}) {
    DriveSettings settings = one_joint(kDirect);
    settings.command_delay = delay;
    SeriesElasticDrive drive(settings);
    const std::array<double, 1> zero{0.0}, torque{10.0};
    std::array<double, 1> out{};
    drive.start(kAtZero, zero);
    for (int k = 0; k < 5; ++k) drive.advance(zero, out);
    drive.command(torque);
    drive.sample();
    for (int k = 0; k < delay; ++k) {
      drive.advance(zero, out);
      drive.sample();
      EXPECT_EQ(drive.measured(0).motor_torque, 0.0) << delay;
    }
    drive.advance(zero, out);
    drive.sample();
    EXPECT_DOUBLE_EQ(drive.measured(0).motor_torque, 10.0 + 20.0 * 10.0) << delay;
  }
}

TEST(Drive, AMeasurementArrivesAfterItsDelay) {
  DriveSettings settings = one_joint(kDirect);
  settings.measurement_delay = 5;
  SeriesElasticDrive late(settings), prompt(one_joint(kDirect));
  const std::array<double, 1> zero{0.0}, torque{10.0};
  std::array<double, 1> out{};
  std::vector<double> measured;
  for (SeriesElasticDrive* drive : {&late, &prompt})
    drive->start(kAtZero, zero), drive->command(torque);
  for (int k = 0; k < 50; ++k) {
    late.advance(zero, out);
    prompt.advance(zero, out);
    measured.push_back(prompt.measured(0).torque);
    if (k < 5) continue;
    EXPECT_EQ(late.measured(0).torque, measured[static_cast<std::size_t>(k - 5)]);
  }
}

TEST(Drive, EncodersCountInTheirResolution) {
  DriveSettings settings = one_joint(kDirect);
  settings.deflection_resolution = 0.7 / (1 << 14);  // 14 bit over +-0.35 rad
  SeriesElasticDrive drive(settings);
  const std::array<double, 1> zero{0.0}, torque{10.0};
  std::array<double, 1> out{};
  drive.start(kAtZero, zero);
  drive.command(torque);
  for (int k = 0; k < 1000; ++k) {
    drive.advance(zero, out);
    const double counts =
        drive.measured(0).torque / (kKnee.spring * settings.deflection_resolution);
    EXPECT_NEAR(counts, std::round(counts), 1e-9);
  }
  EXPECT_NEAR(drive.measured(0).torque, drive.actuator(0).spring_torque(),
              0.5 * kKnee.spring * settings.deflection_resolution + 1e-12);
}

// The measured torque is the nominal spring's: with another true one it is wrong by their ratio.
TEST(Drive, AWrongSpringMakesTheMeasuredTorqueWrong) {
  DriveSettings settings = one_joint(kDirect);
  settings.joints[0].nominal_spring = 1.03 * kKnee.spring;
  SeriesElasticDrive drive(settings);
  const std::array<double, 1> zero{0.0}, torque{10.0};
  std::array<double, 1> out{};
  drive.start(kAtZero, zero);
  drive.command(torque);
  for (int k = 0; k < 480000; ++k) drive.advance(zero, out);
  EXPECT_NEAR(drive.measured(0).torque, 10.0,
              1e-6);  // after 18 of the time constants (1 + F + P)/I
  EXPECT_NEAR(out[0], 10.0 / 1.03, 1e-6);
}

// The response of the sampled loop, from its equations at z = exp(j w h): the rotor by the matrix
// exponential, the integrals by Euler's forward rule, the reference after `delay` steps. x = (θ,
// θ'); free: the output is an inertia, whose θ, θ' follow.
Complex sampled_response(const TorqueLoopGains& gains, int delay, double inertia, double hertz) {
  const bool is_free = inertia > 0.0;
  const double k = kKnee.spring, j = kKnee.rotor, b = kKnee.viscous;
  Eigen::Matrix2d a;
  a << 0.0, 1.0, -k / j, -b / j;
  // Over a step the joint moves with the velocity v of its beginning: inputs u and v, x = (δ, θ').
  Eigen::Matrix4d whole = Eigen::Matrix4d::Zero();
  whole.topLeftCorner<2, 2>() = a;
  whole(0, 3) = -1.0;
  whole(1, 2) = 1.0 / j;
  const Eigen::Matrix4d step = (whole * kLoopStep).exp();
  // The mean of δ over the step, from one more integral.
  Eigen::Matrix<double, 5, 5> mean = Eigen::Matrix<double, 5, 5>::Zero();
  mean.topLeftCorner<4, 4>() = whole;
  mean(4, 0) = 1.0;
  const Eigen::Matrix<double, 5, 5> integral = (mean * kLoopStep).exp();
  const Complex z = std::exp(Complex(0.0, 2.0 * std::numbers::pi * hertz * kLoopStep));
  const Complex h = kLoopStep / (z - 1.0);  // Euler's forward rule
  // Unknowns: δ, θ', v, u, mean of τ_s; one equation each, the reference on the right.
  Eigen::Matrix<Complex, 5, 5> m = Eigen::Matrix<Complex, 5, 5>::Zero();
  Eigen::Matrix<Complex, 5, 1> right = Eigen::Matrix<Complex, 5, 1>::Zero();
  for (int row = 0; row < 2; ++row) {
    m(row, row) += z;
    m(row, 0) -= step(row, 0);
    m(row, 1) -= step(row, 1);
    m(row, 2) -= step(row, 3);
    m(row, 3) -= step(row, 2);
  }
  m(2, 2) = is_free ? z - 1.0 : Complex(1.0);
  if (is_free) m(2, 4) = -kLoopStep / inertia;
  const Complex reference = std::pow(z, -delay);
  const Complex outer = gains.p + gains.i * h;  // of the torque error
  m(3, 3) = 1.0;
  if (gains.type == TorqueLoopGains::Type::cascade) {
    const Complex inner = gains.velocity_p + gains.velocity_i * h;
    m(3, 0) = inner * outer * k;
    m(3, 1) = inner;
    right(3) = inner * outer * reference;
  } else {
    m(3, 0) = outer * k;
    m(3, 1) = gains.damping;
    right(3) = (gains.forward + outer) * reference;
  }
  m(4, 4) = 1.0;
  m(4, 0) = -k * integral(4, 0) / kLoopStep;
  m(4, 1) = -k * integral(4, 1) / kLoopStep;
  m(4, 2) = -k * integral(4, 3) / kLoopStep;
  m(4, 3) = -k * integral(4, 2) / kLoopStep;
  return m.partialPivLu().solve(right)(4);
}

Complex simulated_response(const TorqueLoopGains& gains, int delay, double inertia, double hertz) {
  DriveSettings settings = one_joint(gains);
  settings.command_delay = delay;
  SeriesElasticDrive drive(settings);
  const int period = static_cast<int>(std::lround(1.0 / (hertz * kLoopStep)));
  const double w = 2.0 * std::numbers::pi / period;
  std::array<double, 1> rate{0.0}, torque{}, reference{};
  drive.start(kAtZero, rate);
  Complex sum;
  const int settle = static_cast<int>(3.0 / kLoopStep) / period;
  for (int k = 0; k < (settle + 1) * period; ++k) {
    reference[0] = std::cos(w * k);
    drive.command(reference);
    drive.advance(rate, torque);
    if (inertia > 0.0) rate[0] += torque[0] * kLoopStep / inertia;
    if (k >= settle * period) sum += torque[0] * std::exp(Complex(0.0, -w * k)) * (2.0 / period);
  }
  return sum;
}

TEST(Drive, RespondsAsTheSampledTransferFunctionLockedAndFree) {
  double worst_gain = 0.0, worst_phase = 0.0;
  for (const TorqueLoopGains& gains : {kCascade, kDirect}) {
    for (const double inertia : {0.0, 0.3}) {  // kg m^2; 0: locked
      for (const int delay : {0, kTick}) {
        for (const int period : {12000, 2400, 1200, 600, 300, 200, 120}) {  // 1 to 100 Hz
          const double hertz = 1.0 / (period * kLoopStep);
          const Complex ratio = simulated_response(gains, delay, inertia, hertz) /
                                sampled_response(gains, delay, inertia, hertz);
          worst_gain = std::max(worst_gain, std::abs(std::abs(ratio) - 1.0));
          worst_phase = std::max(worst_phase, std::abs(std::arg(ratio)));
        }
      }
    }
  }
  EXPECT_LT(worst_gain, 0.02);
  EXPECT_LT(worst_phase, 2.0 * std::numbers::pi / 180.0);
  RecordProperty("gain", std::to_string(worst_gain));
  RecordProperty("phase_deg", std::to_string(worst_phase * 180.0 / std::numbers::pi));
}

// The rotor nearly locked by its inertia, a link on the spring, integrated by the semi-implicit
// rule as a simulator does: placed where the link is in the middle of the step, the two conserve
// energy. Were the velocities all that the drive knew, the torque would be late by half a step: k
// h/2 of negative damping, which here doubles the amplitude in 1 s.
TEST(Drive, ALinkOnItsSpringNeitherGainsNorLosesEnergy) {
  constexpr double kStep = 4 * kLoopStep, kInertia = 0.05, kStretched = 0.1;
  DriveSettings settings = one_joint({});
  settings.joints[0].actuator = {.spring = 415.0, .rotor = 1e4};
  settings.joints[0].gains = {.type = TorqueLoopGains::Type::direct, .forward = 0.0};
  settings.steps = 4;
  SeriesElasticDrive drive(settings);
  const std::array<double, 1> start{kStretched}, none{};
  drive.start(kAtZero, none);
  std::array<double, 1> angle = start, rate{}, torque{};
  double first = 0.0, last = 0.0;
  for (int k = 0; k < 30000; ++k) {
    const std::array<double, 1> begin{angle[0] - 0.5 * kStep * rate[0]};
    drive.place(begin);
    drive.advance(rate, torque);
    rate[0] += kStep * torque[0] / kInertia;
    angle[0] += kStep * rate[0];
    double& largest = k < 3000 ? first : last;
    if (k < 3000 || k >= 27000) largest = std::max(largest, std::abs(angle[0]));
  }
  EXPECT_NEAR(first, kStretched, 1e-3);
  EXPECT_NEAR(last, first, 1e-4);
}

// Two sets of gains, exchanged at random moments while torque and joint move: in no tick the torque
// steps by 2 N m more than that of a drive which keeps its gains.
TEST(Drive, AChangeBetweenStanceAndSwingNeitherJumpsNorJolts) {
  const TorqueLoopGains stance{.type = TorqueLoopGains::Type::direct,
                               .p = 20.0,
                               .damping = 38.6,
                               .damps = TorqueLoopGains::Damping::spring};
  TorqueLoopGains swing = stance;
  swing.p = 10.0;
  swing.damping = 28.0;
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> part(-1.0, 1.0);
  double jolt = 0.0;
  for (int trial = 0; trial < 1000; ++trial) {
    DriveSettings settings = one_joint(trial % 2 == 0 ? stance : swing);
    settings.joints[0].actuator.coulomb = 1.0;
    settings.filters = {HUGE_VAL, 300.0};
    SeriesElasticDrive kept(settings), changed(settings);
    const double amplitude = 40.0 * part(random), hertz = 1.0 + 4.0 * std::abs(part(random));
    const double speed = 3.0 * part(random);
    const int moment = 100 + static_cast<int>(random() % 4000);
    for (SeriesElasticDrive* drive : {&kept, &changed}) drive->start(kAtZero, kAtZero);
    std::array<double, 2> before{};
    for (int k = 0; k < moment + 1200; ++k) {
      const double turn = 2.0 * std::numbers::pi * hertz * k * kLoopStep;
      const std::array<double, 1> torque{amplitude * std::sin(turn)}, rate{speed * std::cos(turn)};
      std::array<double, 1> out{};
      if (k == moment) changed.change_gains(0, trial % 2 == 0 ? swing : stance);
      for (SeriesElasticDrive* drive : {&kept, &changed}) {
        if (k % kTick == 0) drive->command(torque);
        drive->advance(rate, out);
      }
      if (k % kTick != 0) continue;
      const std::array<double, 2> now{kept.measured(0).torque, changed.measured(0).torque};
      if (k > moment) {
        jolt = std::max(jolt, std::abs(now[1] - before[1]) - std::abs(now[0] - before[0]));
      }
      before = now;
    }
  }
  EXPECT_LT(jolt, 2.0);
  RecordProperty("jolt", std::to_string(jolt));
}

TEST(Drive, ImpossibleSettingsAreRefused) {
  DriveSettings settings = one_joint(kDirect);
  settings.steps = 0;
  EXPECT_THROW(SeriesElasticDrive{settings}, std::invalid_argument);
  settings = one_joint(kDirect);
  settings.command_delay = -1;
  EXPECT_THROW(SeriesElasticDrive{settings}, std::invalid_argument);
}

TEST(Drive, AnAdvanceAllocatesNothing) {
  DriveSettings settings = one_joint(kCascade);
  settings.steps = kTick;
  settings.command_delay = settings.measurement_delay = kTick;
  SeriesElasticDrive drive(settings);
  const std::array<double, 1> rate{0.1}, torque{10.0};
  std::array<double, 1> out{};
  drive.start(kAtZero, torque);
  const AllocationGuard guard;
  drive.command(torque);
  drive.advance(rate, out);
  drive.change_gains(0, kDirect);
  drive.place(kAtZero);
  drive.advance(rate, out);
  drive.sample();
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
