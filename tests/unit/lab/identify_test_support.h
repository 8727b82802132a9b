// A joint on a series-elastic drive that is excited, and what its log would have; no simulator.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "hal/actuators/drive.h"
#include "lab/identify/actuator.h"
#include "lab/identify/delay.h"

namespace footfall::tests {

inline constexpr int kLoopSteps = 8;  // in a tick of 1500 Hz
inline constexpr double kTickTime = 1.0 / 1500.0;

struct Excitation {
  hal::SeriesElasticParameters actuator{
      .spring = 420.0, .rotor = 0.09, .viscous = 0.5, .coulomb = 1.0};
  double nominal_spring = 410.0;
  int command_delay = 8, measurement_delay = 0;                       // steps of the loop
  double motor_resolution = 1.5e-5, deflection_resolution = 4.27e-5;  // rad
  double inertia = 0.4;                                               // kg m^2, of the joint
  double amplitude = 1.0;
  bool one_sine = false;
  double time = 20.0;  // s
  unsigned seed = 1;
  std::optional<hal::TorqueLoopGains> gains;  // nullopt: as Hume's
};

struct Excited {
  lab::ActuatorRecord record;
  lab::LoopRecord loop;
};

inline hal::TorqueLoopGains loop_of(const Excitation& excitation, double rotor) {
  if (excitation.gains) return *excitation.gains;
  return {.type = hal::TorqueLoopGains::Type::direct,
          .p = 20.0,
          .forward = 1.0,
          .damping = 1.4 * std::sqrt(21.0 * excitation.nominal_spring * rotor),
          .damps = hal::TorqueLoopGains::Damping::spring};
}

// Sines of 0.2 to 12 Hz, the fast ones small; rad.
inline double excited_angle(const Excitation& excitation, double time,
                            const std::vector<double>& phases) {
  constexpr double kFrequencies[] = {0.23, 0.61, 1.3, 2.3, 3.9, 6.1, 8.7, 11.7};
  double angle = 0.0;
  for (std::size_t k = 0; k < phases.size(); ++k) {
    const double f = excitation.one_sine ? 2.0 : kFrequencies[k];
    angle += std::min(0.15, 0.2 / f) * std::sin(2.0 * std::numbers::pi * f * time + phases[k]);
  }
  return excitation.amplitude * angle * std::min(1.0, time);
}

inline Excited excite(const Excitation& excitation) {
  hal::DriveSettings settings;
  Excited out;
  out.loop.gains = loop_of(excitation, excitation.actuator.rotor);
  out.loop.rotor = excitation.actuator.rotor;
  out.loop.filters = settings.filters = {300.0, 300.0};
  settings.joints = {{excitation.actuator, excitation.nominal_spring, out.loop.gains}};
  settings.step = kTickTime / kLoopSteps;
  settings.command_delay = excitation.command_delay;
  settings.measurement_delay = excitation.measurement_delay;
  settings.motor_resolution = excitation.motor_resolution;
  settings.deflection_resolution = excitation.deflection_resolution;
  out.record.period = kTickTime;
  out.record.drive_step = settings.step;
  out.record.nominal_spring = excitation.nominal_spring;
  hal::SeriesElasticDrive drive(std::move(settings));
  double q = 0.0, qd = 0.0, torque = 0.0;
  drive.start({&q, 1}, {&torque, 1});
  std::mt19937 random(excitation.seed);
  std::vector<double> phases(excitation.one_sine ? 1 : 8);
  for (double& phase : phases) phase = std::uniform_real_distribution<>(0.0, 6.28)(random);
  const int ticks = static_cast<int>(std::lround(excitation.time / kTickTime));
  for (int k = 0; k < ticks; ++k) {
    drive.sample();
    const hal::DriveMeasurement& measured = drive.measured(0);
    const double reference = excited_angle(excitation, k * kTickTime, phases);
    const double command = excitation.inertia * (1500.0 * (reference - q) - 60.0 * qd);
    out.record.torque.push_back(measured.torque);
    out.record.motor.push_back(measured.motor_angle);
    out.record.motor_torque.push_back(measured.motor_torque);
    out.loop.command.push_back(command);
    out.loop.saturated.push_back(measured.saturated ? 1 : 0);
    drive.command({&command, 1});
    for (int step = 0; step < kLoopSteps; ++step) {
      drive.advance({&qd, 1}, {&torque, 1});
      q += qd * kTickTime / kLoopSteps;
      qd += torque / excitation.inertia * kTickTime / kLoopSteps;
    }
  }
  return out;
}

}  // namespace footfall::tests
