// MuJoCo as a robot: steps physics in lock-step with the tick, reports sensors and simulator
// faults. Its model and data are private; the controller never sees them.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/actuators/drive.h"
#include "hal/hardware.h"
#include "hal/sensors/suite.h"
#include "model/robot/description.h"
#include "sim/footholds.h"
#include "sim/springs.h"
#include "sim/world/description.h"
#include "sim/world/push.h"

struct mjModel_;
struct mjData_;

namespace footfall::sim {

// A force on a body, constant in world axes while it acts.
struct ActivePush {
  int body = 0;
  std::array<double, 3> force{};  // N, world
  // Of the body's frame, m, where it acts; nullopt: its centre of mass.
  std::optional<std::array<double, 3>> point;
  double steps_left = 0.0;  // physics steps; the last one may be a part
};
inline constexpr std::size_t kMaxPushes = 32;  // maximum number of simultaneous pushes

inline constexpr std::size_t kMaxHeld = 8;  // holds at a time

// Properties of the compiled physics that all results depend on; printed in a run's summary.
struct PhysicsFacts {
  double timestep = 0.0;         // s
  double friction = 0.0;         // of the ground
  double foot_radius_max = 0.0;  // m
  int condim_max = 0;            // of any foot contact
  double damping_max = 0.0;      // of any joint
  double armature_max = 0.0;
  int equalities = 0;  // welds and other constraints
  int mocap_bodies = 0;
  double mass = 0.0;  // kg
};

class MujocoBackend final : public hal::Hardware {
 public:
  // Throws std::runtime_error (MuJoCo's own text) if the scene does not compile.
  MujocoBackend(const model::RobotDescription& robot, const WorldDescription& world);
  ~MujocoBackend() override;
  MujocoBackend(const MujocoBackend&) = delete;
  MujocoBackend& operator=(const MujocoBackend&) = delete;

  std::string name() const override { return "mujoco"; }
  void start() override;
  bool read(hal::Sensors& sensors) noexcept override;
  void write(const hal::Commands& commands) noexcept override;
  void safe_stop() noexcept override;
  bool uses_torque_loop() const override { return drive_.has_value(); }
  void set_torque_loop(int joint, const hal::TorqueLoopGains& gains) noexcept override;
  // Of series-elastic actuators; nullptr: they are ideal.
  const hal::SeriesElasticDrive* drive() const noexcept { return drive_ ? &*drive_ : nullptr; }
  // Errors of the ground's height; nullptr: it has none.
  const Footholds* footholds() const noexcept { return footholds_ ? &*footholds_ : nullptr; }

  // Starts a push on a body's CoM; direction in rad from the robot's heading, 0 forward, pi/2 left.
  // Names were checked by find_body(). False if kMaxPushes are active.
  bool push(int body, double force, double direction, double duration, double elevation = 0.0,
            const std::optional<std::array<double, 3>>& point = {}) noexcept;
  // Holds a body by springs anchored where it is now; its number for release(), -1 if kMaxHeld are
  // held.
  int hold(int body, const model::BodySprings& springs) noexcept;
  void release(int hold) noexcept;
  int find_body(const std::string& name) const;  // -1 if absent
  PhysicsFacts facts() const;

  mjModel_* model() noexcept { return model_; }
  mjData_* data() noexcept { return data_; }

 private:
  // Target of the public constructor's delegation: once it has run, the destructor frees compiled
  // objects even if the public constructor throws.
  struct Empty {};
  MujocoBackend(Empty, const model::RobotDescription& robot, const WorldDescription& world);
  void apply_commands(const hal::Commands& commands) noexcept;
  void advance_drive(const hal::Commands& commands) noexcept;
  void apply_forces() noexcept;
  void update_positions() noexcept;
  void attach_constraints();
  void mount_sensors();
  void start_sensors();
  void sense_contacts(hal::Sensors& sensors) noexcept;
  void find_truth(const hal::Sensors& sensors) noexcept;
  std::int64_t warnings() const noexcept;
  void add_sliders();
  void tilt_axes();
  void refuse_stiff_springs();
  void place_at_posture();

  const model::RobotDescription& robot_;
  WorldDescription world_;
  mjModel_* model_ = nullptr;
  mjData_* data_ = nullptr;
  std::vector<int> qpos_, dof_, actuator_;  // by joint of the robot file
  static constexpr int kGround = -1, kOtherBody = -2;
  std::vector<int> contact_of_geom_;             // robot contact index, or one of these
  std::vector<std::vector<double>> delay_line_;  // commands on their way, one a physics step
  std::size_t delay_head_ = 0;
  std::optional<hal::SeriesElasticDrive> drive_;
  std::array<double, core::kMaxJoints> joint_angles_{}, joint_rates_{}, drive_torques_{};
  std::optional<hal::SensorSuite> sensors_;
  hal::SensorTruth truth_;
  int base_body_ = 1;
  std::optional<Footholds> footholds_;  // of a world with errors of the ground's height
  std::array<ActivePush, kMaxPushes> pushes_{};
  std::array<ActiveSprings, kMaxHeld> held_{};
  std::array<double, 3> aid_force_{};       // N, world: sum over the last tick's physics steps
  std::vector<ActiveSprings> constraints_;  // of the world, anchored at the start
  std::int64_t warnings_at_start_ = 0;
  std::int64_t tick_ = 0;
  bool stopped_ = false;
};

}  // namespace footfall::sim
