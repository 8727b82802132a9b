// Actuators, loops, encoders and delays of all joints; see drive.h.
#include "hal/actuators/drive.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/index.h"

namespace footfall::hal {
namespace {

constexpr std::size_t kMeasured = 3;  // values a joint on their way to the servo

double counted(double angle, double resolution) noexcept {
  return resolution > 0.0 ? resolution * std::round(angle / resolution) : angle;
}

}  // namespace

// Spring and link in series: k l/(k + l).
SeriesElasticDrive::Joint::Joint(const DriveJoint& of, double step)
    : actuator(
          [&of] {
            SeriesElasticParameters together = of.actuator;
            if (of.link > 0.0) together.spring *= of.link / (of.link + of.actuator.spring);
            return together;
          }(),
          step),
      loop(of.gains, step, of.actuator.rotor),
      nominal_spring(of.nominal_spring) {
  if (of.link <= 0.0) return;
  link_share = of.actuator.spring / (of.link + of.actuator.spring);
  spring_share = 1.0 - link_share;
}

LinkBending SeriesElasticDrive::bending(int joint, double joint_rate) const noexcept {
  const Joint& bent = joints_[at(joint)];
  const SeriesElasticState& state = bent.actuator.state();
  return {bent.link_share * state.deflection, bent.link_share * (state.rate - joint_rate)};
}

double filter_share(double cutoff, double step) noexcept {
  return -std::expm1(-2.0 * std::numbers::pi * cutoff * step);
}

SeriesElasticDrive::SeriesElasticDrive(DriveSettings settings) : settings_(std::move(settings)) {
  if (settings_.steps < 1 || settings_.command_delay < 0 || settings_.measurement_delay < 0) {
    throw std::invalid_argument("series-elastic drive: steps and delays cannot be negative");
  }
  for (const DriveJoint& joint : settings_.joints) {
    joints_.emplace_back(joint, settings_.step);
  }
  const auto make = [this](int delay, std::size_t values) {
    Delay out;
    out.length = static_cast<std::size_t>(delay) + 1;
    out.row = values * joints_.size();
    out.values.assign(out.length * out.row, 0.0);
    return out;
  };
  commands_ = make(settings_.command_delay, 1);
  measurements_ = make(settings_.measurement_delay, kMeasured);
  commanded_.assign(joints_.size(), 0.0);
  per_step_ = 1.0 / settings_.step;
  motor_share_ = filter_share(settings_.filters.motor, settings_.step);
  spring_share_ = filter_share(settings_.filters.spring, settings_.step);
}

void SeriesElasticDrive::start(std::span<const double> angles, std::span<const double> torques) {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    const double deflection = torques[j] / joint.actuator.parameters().spring;
    joint.actuator.set_state({deflection, 0.0});
    joint.motor_angle = angles[j] + deflection;
    joint.counted = counted(joint.motor_angle, settings_.motor_resolution);
    joint.stretched = counted(joint.spring_share * deflection, settings_.deflection_resolution);
    joint.rate = joint.spring_rate = joint.motor_torque = 0.0;
    joint.saturated = false;
    joint.reference = commanded_[j] = torques[j];
    joint.loop.change(settings_.joints[j].gains, {});
    joint.loop.reset();
    joint.seen = {torques[j], joint.nominal_spring * joint.stretched, 0.0, 0.0};
    joint.measured = {joint.nominal_spring * joint.stretched, joint.counted, 0.0, false};
    for (std::size_t k = 0; k < commands_.length; ++k) {
      commands_.values[k * joints_.size() + j] = torques[j];
    }
    for (std::size_t k = 0; k < measurements_.length; ++k) {
      double* const values = &measurements_.values[(k * joints_.size() + j) * kMeasured];
      values[0] = joint.measured.torque;
      values[1] = joint.measured.motor_angle;
      values[2] = 0.0;
    }
  }
  unsampled_ = 0;
}

void SeriesElasticDrive::command(std::span<const double> references) noexcept {
  for (std::size_t j = 0; j < joints_.size(); ++j) commanded_[j] = references[j];
}

void SeriesElasticDrive::change_gains(int joint, const TorqueLoopGains& gains) noexcept {
  Joint& changed = joints_[at(joint)];
  changed.loop.change(gains, changed.seen);
}

void SeriesElasticDrive::place(std::span<const double> angles) noexcept {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    Joint& joint = joints_[j];
    joint.actuator.set_state({joint.motor_angle - angles[j], joint.actuator.state().rate});
  }
}

// The value of `length` - 1 steps ago; this one takes its place.
double SeriesElasticDrive::through(Delay& delay, std::size_t index, double value) const noexcept {
  if (delay.length == 1) return value;
  delay.values[delay.head * delay.row + index] = value;
  return delay.values[delay.next() * delay.row + index];
}

TorqueLoopInput SeriesElasticDrive::sense(Joint& joint, double joint_rate) const noexcept {
  const SeriesElasticState& state = joint.actuator.state();
  const double stretched =
      counted(joint.spring_share * state.deflection, settings_.deflection_resolution);
  const double angle = counted(joint.motor_angle, settings_.motor_resolution);
  const auto follow = [this](double& rate, double share, double now, double before, double exact) {
    rate = share > 0.0 ? rate + share * ((now - before) * per_step_ - rate) : exact;
  };
  follow(joint.rate, motor_share_, angle, joint.counted, state.rate);
  follow(joint.spring_rate, spring_share_, stretched, joint.stretched,
         joint.spring_share * (state.rate - joint_rate));
  joint.counted = angle;
  joint.stretched = stretched;
  return {joint.reference, joint.nominal_spring * stretched, joint.rate, joint.spring_rate};
}

void SeriesElasticDrive::measure(std::size_t j, double motor_torque) noexcept {
  Joint& joint = joints_[j];
  joint.measured.torque = through(measurements_, j * kMeasured, joint.seen.torque);
  joint.measured.motor_angle = through(measurements_, j * kMeasured + 1, joint.counted);
  joint.motor_torque += through(measurements_, j * kMeasured + 2, motor_torque);
}

// One step of a joint; returns the mean spring torque.
double SeriesElasticDrive::step(std::size_t j, double joint_rate) noexcept {
  Joint& joint = joints_[j];
  joint.reference = through(commands_, j, commanded_[j]);
  joint.seen = sense(joint, joint_rate);
  const double asked = joint.loop.ask(joint.seen);
  const SeriesElasticStep done = joint.actuator.advance(asked, joint_rate);
  joint.loop.settle(joint.seen, asked, done.motor_torque);
  joint.motor_angle += done.motor_angle;
  joint.saturated |= done.motor_torque != asked;
  measure(j, done.motor_torque);
  return done.spring_torque;
}

void SeriesElasticDrive::advance(std::span<const double> joint_rates,
                                 std::span<double> torques) noexcept {
  for (std::size_t j = 0; j < joints_.size(); ++j) torques[j] = 0.0;
  for (int k = 0; k < settings_.steps; ++k) {
    for (std::size_t j = 0; j < joints_.size(); ++j) {
      torques[j] += step(j, joint_rates[j]);
    }
    commands_.head = commands_.next();
    measurements_.head = measurements_.next();
  }
  for (std::size_t j = 0; j < joints_.size(); ++j) torques[j] /= settings_.steps;
  unsampled_ += settings_.steps;
}

void SeriesElasticDrive::sample() noexcept {
  if (unsampled_ == 0) return;
  for (Joint& joint : joints_) {
    joint.measured.motor_torque = joint.motor_torque / unsampled_;
    joint.measured.saturated = joint.saturated;
    joint.motor_torque = 0.0;
    joint.saturated = false;
  }
  unsampled_ = 0;
}

void SeriesElasticDrive::read(Sensors& sensors) noexcept {
  sample();
  sensors.has_motors = true;
  sensors.motor_saturated = false;
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const DriveMeasurement& measured = joints_[j].measured;
    const LinkBending bent = bending(static_cast<int>(j), sensors.qd[j]);
    sensors.q[j] += bent.angle;
    sensors.qd[j] += bent.rate;
    sensors.tau[j] = measured.torque;
    sensors.motor[j] = measured.motor_angle;
    sensors.motor_torque[j] = measured.motor_torque;
    sensors.motor_saturated |= measured.saturated;
  }
}

const DriveMeasurement& SeriesElasticDrive::measured(int joint) const noexcept {
  return joints_[at(joint)].measured;
}

const SeriesElasticActuator& SeriesElasticDrive::actuator(int joint) const noexcept {
  return joints_[at(joint)].actuator;
}

const TorqueLoopGains& SeriesElasticDrive::gains(int joint) const noexcept {
  return joints_[at(joint)].loop.gains();
}

}  // namespace footfall::hal
