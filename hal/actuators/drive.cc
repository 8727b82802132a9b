// Actuators, loops, encoders and delays of all joints; see drive.h.
#include "hal/actuators/drive.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/index.h"

namespace footfall::hal {
namespace {

double counted(double angle, double resolution) noexcept {
  return resolution > 0.0 ? resolution * std::round(angle / resolution) : angle;
}

}  // namespace

SeriesElasticDrive::SeriesElasticDrive(DriveSettings settings) : settings_(std::move(settings)) {
  if (settings_.steps < 1 || settings_.command_delay < 0 || settings_.measurement_delay < 0) {
    throw std::invalid_argument("series-elastic drive: steps and delays cannot be negative");
  }
  for (const DriveJoint& joint : settings_.joints) {
    joints_.emplace_back(joint, settings_.step);
  }
  const auto make = [this](int delay) {
    Delay out;
    out.length = static_cast<std::size_t>(delay) + 1;
    out.values.assign(out.length * joints_.size(), 0.0);
    return out;
  };
  commands_ = make(settings_.command_delay);
  measurements_ = make(settings_.measurement_delay);
  commanded_.assign(joints_.size(), 0.0);
  if (settings_.rate_cutoff > 0.0) {
    smoothing_ = 1.0 - std::exp(-2.0 * std::numbers::pi * settings_.rate_cutoff * settings_.step);
  }
}

void SeriesElasticDrive::start(std::span<const double> torques) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const double deflection = torques[j] / joint.actuator.parameters().spring;
    joint.actuator.set_state({deflection, 0.0});
    joint.loop.reset();
    joint.motor_angle = joint.counted = joint.rate = 0.0;
    joint.reference = commanded_[j] = torques[j];
    joint.measured = {joint.nominal_spring * deflection, 0.0, torques[j], false};
    for (std::size_t k = 0; k < commands_.length; ++k) {
      commands_.values[k * joints_.size() + j] = torques[j];
    }
    for (std::size_t k = 0; k < measurements_.length; ++k) {
      measurements_.values[k * joints_.size() + j] = joint.measured.torque;
    }
  }
}

void SeriesElasticDrive::command(std::span<const double> references) noexcept {
  for (std::size_t j = 0; j < joints_.size(); ++j) commanded_[j] = references[j];
}

void SeriesElasticDrive::change_gains(int joint, const TorqueLoopGains& gains) noexcept {
  Joint& changed = joints_[at(joint)];
  changed.loop.change(gains, changed.seen);
}

// The value of `length` - 1 steps ago; this one takes its place.
double SeriesElasticDrive::through(Delay& delay, std::size_t joint, double value) const noexcept {
  delay.values[delay.head * joints_.size() + joint] = value;
  const std::size_t oldest = (delay.head + 1) % delay.length;
  return delay.values[oldest * joints_.size() + joint];
}

TorqueLoopInput SeriesElasticDrive::sense(Joint& joint, double joint_rate) const noexcept {
  const double deflection =
      counted(joint.actuator.state().deflection, settings_.deflection_resolution);
  if (settings_.rate_cutoff > 0.0) {
    const double angle = counted(joint.motor_angle, settings_.motor_resolution);
    joint.rate += smoothing_ * ((angle - joint.counted) / settings_.step - joint.rate);
    joint.counted = angle;
  } else {
    joint.rate = joint.actuator.state().rate;
  }
  return {joint.reference, joint.nominal_spring * deflection, joint.rate, joint_rate};
}

void SeriesElasticDrive::step(std::size_t j, double joint_rate) noexcept {
  Joint& joint = joints_[j];
  joint.reference = through(commands_, j, commanded_[j]);
  joint.seen = sense(joint, joint_rate);
  const double asked = joint.loop.ask(joint.seen);
  const SeriesElasticStep done = joint.actuator.advance(asked, joint_rate);
  joint.loop.settle(joint.seen, asked, done.motor_torque);
  joint.motor_angle += done.motor_angle;
  DriveMeasurement& measured = joint.measured;
  measured.torque = through(measurements_, j, joint.seen.torque);
  measured.motor_torque += done.motor_torque / settings_.steps;
  measured.spring += done.spring_torque / settings_.steps;
  measured.saturated |= done.motor_torque != asked;
}

void SeriesElasticDrive::advance(std::span<const double> joint_rates,
                                 std::span<double> torques) noexcept {
  for (Joint& joint : joints_) {
    joint.measured.motor_torque = joint.measured.spring = 0.0;
    joint.measured.saturated = false;
  }
  for (int k = 0; k < settings_.steps; ++k) {
    for (std::size_t j = 0; j < joints_.size(); ++j) step(j, joint_rates[j]);
    commands_.head = (commands_.head + 1) % commands_.length;
    measurements_.head = (measurements_.head + 1) % measurements_.length;
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) torques[j] = joints_[j].measured.spring;
}

const DriveMeasurement& SeriesElasticDrive::measured(int joint) const noexcept {
  return joints_[at(joint)].measured;
}

const SeriesElasticActuator& SeriesElasticDrive::actuator(int joint) const noexcept {
  return joints_[at(joint)].actuator;
}

}  // namespace footfall::hal
