// A backend without contact physics: the robot on a stand. Its actuators, torque loops, delays and
// sensors are real with their errors; each joint is an inertia, held by a spring where the stand
// has one; the base does not move; contacts follow a script. It runs the same tick as a simulator
// or a robot, for tests of the engine, of actuators and of a behavior's timing.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "hal/actuators/drive.h"
#include "hal/hardware.h"
#include "hal/sensors/suite.h"

namespace footfall::hal {

struct StubSettings {
  int joints = 0;
  int contacts = 0;
  double period = 0.0;           // s
  double inertia = 1.0;          // kg m^2, of every joint
  double stiffness = 0.0;        // N m/rad, of the stand's spring, at rest at `start`; 0: none
  double damping = 0.0;          // N m s/rad, beside the spring
  std::vector<double> start;     // rad, joint positions at start
  std::array<double, 3> base{};  // m, base origin in the world
  // s; a contact that the control law lets go of opens, and closes again after this time or when
  // the law loads it. 0: contacts are always closed.
  double swing = 0.0;
  // Whether a contact is closed at a time (s), in the place of that.
  std::function<bool(int contact, double time)> contact_script;
  // Series-elastic actuators; an advance() of theirs is a `drive_steps`-th of a period. None: ideal
  // ones, after command_delay periods.
  std::optional<DriveSettings> drive;
  int drive_steps = 1;
  int command_delay = 0;
  // The base is at rest at `base`; of truths the CoM's is not there: it is 0. A contact that is
  // closed has a force above every threshold.
  SensorErrors sensors;
  SensorPlaces places;  // its joints and contacts are those above
  std::uint64_t noise_seed = 0;
};

class StubBackend final : public Hardware {
 public:
  // Throws std::runtime_error if the sizes are inconsistent.
  explicit StubBackend(StubSettings settings);
  std::string name() const override { return "stub"; }
  void start() override;
  bool read(Sensors& sensors) noexcept override;
  void write(const Commands& commands) noexcept override;
  void safe_stop() noexcept override;
  bool uses_torque_loop() const override { return drive_.has_value(); }
  void set_torque_loop(int joint, const TorqueLoopGains& gains) noexcept override;
  void set_support(std::uint64_t contacts) noexcept override;

 private:
  bool is_closed(int contact, double time) const noexcept;
  void move(std::span<const double> torques, double time) noexcept;

  StubSettings settings_;
  std::vector<double> q_, qd_, tau_;
  std::vector<SeriesElasticActuator> stand_;  // joints on its springs; empty: it has none
  std::optional<SeriesElasticDrive> drive_;
  std::optional<SensorSuite> sensors_;
  SensorTruth truth_;
  std::vector<std::vector<double>> delayed_;  // commands on their way to ideal actuators
  std::array<std::int64_t, core::kMaxContacts> released_{};  // by contact: the tick; -1: it is held
  std::int64_t tick_ = 0;
  bool stopped_ = false;
};

}  // namespace footfall::hal
