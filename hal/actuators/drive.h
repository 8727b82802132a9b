// The series-elastic drive of a robot: one actuator with its torque loop a joint, the encoders that
// the loops see, and the delays between them and the servo. Shared by the backends; the joint's
// side belongs to the plant. After the constructor nothing allocates; safe for the tick.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hal/actuators/series_elastic.h"
#include "hal/actuators/torque_loop.h"
#include "hal/sensor_fields.h"

namespace footfall::hal {

struct DriveJoint {
  SeriesElasticParameters actuator;
  double nominal_spring = 0.0;  // N m/rad, with which the measured deflection becomes a torque
  TorqueLoopGains gains;        // at the start
  // N m/rad, of a link that bends behind the joint's encoder, in series with the spring; 0: rigid.
  double link = 0.0;
};

// How the loops get rates from encoders: differences of their counts, first-order filtered.
// Cutoffs in Hz; infinite: unfiltered differences; 0: the exact rates, for tests of the rest.
struct RateFilters {
  double motor = 0.0, spring = 0.0;
};
// The part of a new difference that a filter takes over in a step, (0, 1]; 0: of exact rates.
double filter_share(double cutoff, double step) noexcept;

struct DriveSettings {
  std::vector<DriveJoint> joints;
  double step = 0.0;          // s, of the torque loops and the rotors
  int steps = 1;              // of them in one advance()
  int command_delay = 0;      // steps, from command() to the torque loop
  int measurement_delay = 0;  // steps, from the encoders to measured()
  // Resolution of the encoders, rad; 0: exact.
  double motor_resolution = 0.0, deflection_resolution = 0.0;
  RateFilters filters;
};

// What the servo gets to know of a joint, after the measurement's delay.
struct DriveMeasurement {
  double torque = 0.0;        // nominal spring times deflection, N m
  double motor_angle = 0.0;   // θ by its encoder, rad
  double motor_torque = 0.0;  // u, N m, mean since the last sample()
  bool saturated = false;     // since then the motor gave less than its loop asked for
};

// How far a link is bent: what the joint's encoder shows beyond the link's end.
struct LinkBending {
  double angle = 0.0;  // rad
  double rate = 0.0;   // rad/s
};

class SeriesElasticDrive {
 public:
  // Throws std::invalid_argument as SeriesElasticActuator, and for steps or delays below 0.
  explicit SeriesElasticDrive(DriveSettings settings);

  // At rest at these joint angles, rad; springs carry these torques, N m.
  void start(std::span<const double> angles, std::span<const double> torques);
  // Torque references of the servo, N m.
  void command(std::span<const double> references) noexcept;
  // Other gains of a joint; its motor torque stays continuous.
  void change_gains(int joint, const TorqueLoopGains& gains) noexcept;
  // Where the joints are now, rad: for a plant that keeps its own account of them.
  void place(std::span<const double> angles) noexcept;
  // Advances by `steps` steps with constant joint velocities, rad/s. `torques` receives the mean
  // spring torques, which the plant applies over that time, N m.
  void advance(std::span<const double> joint_rates, std::span<double> torques) noexcept;
  // Ends the time of which measured() gives means; without an advance() since the last, nothing.
  void sample() noexcept;

  // What the servo reads of all joints, after sample(): `sensors` has where the links' ends are,
  // and gets what the encoders show.
  void read(Sensors& sensors) noexcept;

  const DriveMeasurement& measured(int joint) const noexcept;
  // At the joint velocity given, rad/s.
  LinkBending bending(int joint, double joint_rate) const noexcept;
  const SeriesElasticActuator& actuator(int joint) const noexcept;
  const TorqueLoopGains& gains(int joint) const noexcept;

 private:
  struct Joint {
    Joint(const DriveJoint& of, double step);
    SeriesElasticActuator actuator;
    TorqueLoop loop;
    double nominal_spring = 0.0;
    // Of θ − q, q at the end of the link: in the spring, and in the link. Nothing has mass between.
    double spring_share = 1.0, link_share = 0.0;
    double reference = 0.0;                 // as the loop has it
    double motor_angle = 0.0;               // rad
    double counted = 0.0, stretched = 0.0;  // as the encoders gave θ and θ − q last, rad
    double rate = 0.0, spring_rate = 0.0;   // θ' and θ' − q' as the loop has them, rad/s
    TorqueLoopInput seen;                   // by the last update
    double motor_torque = 0.0;              // sum since the last sample()
    bool saturated = false;
    DriveMeasurement measured;
  };
  // A ring of some values a joint and step.
  struct Delay {
    std::vector<double> values;
    std::size_t row = 0;               // values of a step
    std::size_t length = 1, head = 0;  // steps
    std::size_t next() const noexcept { return head + 1 == length ? 0 : head + 1; }
  };
  double through(Delay& delay, std::size_t value_index, double value) const noexcept;
  double step(std::size_t joint, double joint_rate) noexcept;
  TorqueLoopInput sense(Joint& joint, double joint_rate) const noexcept;
  void measure(std::size_t joint, double motor_torque) noexcept;

  DriveSettings settings_;
  std::vector<Joint> joints_;
  std::vector<double> commanded_;
  Delay commands_, measurements_;
  double motor_share_ = 0.0, spring_share_ = 0.0;  // filter_share()
  double per_step_ = 0.0;                          // 1/step
  int unsampled_ = 0;                              // steps since the last sample()
};

}  // namespace footfall::hal
