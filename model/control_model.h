// Kinematics and dynamics of the robot as the controller believes it to be; updated once a tick
// between the estimator and the state machine. Owns its own MuJoCo model, never a simulated one.
//
//   A q̈ + b + g = Uᵀ τ + Jᵀ f        (f: force of the ground ON the robot; [Kim16] eq. (28) has
//                                       F_r = -f, force of the robot on the ground)
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "model/robot/description.h"
#include "model/sensor_mounts.h"
#include "model/state.h"
#include "model/terrain.h"
#include "model/tree_factor.h"

namespace footfall::model {

// An axis of a body that an external aid holds: 0 to 2, its centre of mass along x y z; 3 to 5, its
// rotation about them; world axes.
struct HeldAxis {
  std::string body;
  int axis = 0;
  bool operator==(const HeldAxis&) const = default;
};

// What the controller believes: of the robot differently from its file, and of the ground.
struct ModelDeviation {
  double mass_scale = 1.0;                                 // every mass and inertia
  std::map<std::string, double> mass_scales;               // likewise, of single links
  std::map<std::string, std::array<double, 3>> com_shift;  // m, link frame
  Terrain terrain;                                         // as believed; empty: level ground
  std::vector<HeldAxis> held;                              // known to hold, as constraints
};

// A 3-row task Jacobian and what goes with it; pointers stay valid for the model's life.
struct Kinematics3 {
  std::array<double, 3> position{};  // m, world (for angular: unused)
  std::array<double, 3> velocity{};  // J q̇
  std::array<double, 3> bias{};      // J̇ q̇
  std::vector<double> jacobian;      // 3 x nv, row-major
};

// Orientation of a point's frame, and its rotation as a 3-row task Jacobian.
struct FrameRotation {
  Kinematics3 angular;           // velocity = ω, bias = J̇_ω q̇, world axes; position unused
  std::array<double, 9> R_WF{};  // row-major
  std::array<double, 3> rpy{};   // rad, R_WF = Rz(yaw) Ry(pitch) Rx(roll)
};

class ControlModel {
 public:
  // Throws std::runtime_error with one clear sentence (MuJoCo's own text for a malformed MJCF).
  explicit ControlModel(const RobotDescription& robot, const ModelDeviation& deviation = {});
  ~ControlModel();
  ControlModel(const ControlModel&) = delete;
  ControlModel& operator=(const ControlModel&) = delete;

  int nv() const noexcept { return nv_; }  // 6 + joints
  int joint_count() const noexcept { return nv_ - 6; }
  int point_count() const noexcept { return static_cast<int>(points_.size()); }
  int contact_count() const noexcept { return contact_count_; }
  double mass() const noexcept { return mass_; }        // kg
  double gravity() const noexcept { return gravity_; }  // m/s^2, downwards
  const SensorMounts& mounts() const noexcept { return mounts_; }

  // Everything below is of the state given last. No allocation.
  void update(const State& state) noexcept;
  const State& state() const noexcept { return state_; }

  // Points: the robot's contacts in order, then its named points. Contact points lie at the ball's
  // centre - radius * normal of the believed ground nearest to the centre, and are material points
  // of the foot at this instant.
  // Positions are always there; the rest of a named point is computed when it is first asked for.
  const Kinematics3& point(int index) const noexcept {
    if (fresh_[static_cast<std::size_t>(index)] == 0) fill_point(index);
    return points_[static_cast<std::size_t>(index)];
  }
  const std::array<double, 3>& point_position(int index) const noexcept {
    return points_[static_cast<std::size_t>(index)].position;
  }
  // Of the believed ground nearest to a contact's ball: unit, out of the ground, world axes;
  // (0, 0, 1) on level ground.
  const std::array<double, 3>& contact_normal(int contact) const noexcept {
    return normals_[static_cast<std::size_t>(contact)];
  }
  double contact_radius(int contact) const noexcept {  // m
    return anchors_[static_cast<std::size_t>(contact)].radius;
  }
  const Terrain& terrain() const noexcept { return terrain_; }  // as believed
  // Angular velocity of the link that a point is on, rad/s, world axes.
  std::array<double, 3> point_angular_velocity(int index) const noexcept;
  // Orientation of the same points: of the site (or link) that the robot file names. Computed when
  // it is first asked for.
  const FrameRotation& frame(int index) const noexcept {
    if (fresh_frame_[static_cast<std::size_t>(index)] == 0) fill_frame(index);
    return frames_[static_cast<std::size_t>(index)];
  }
  // Axes that external aids hold: rows of a constraint on the acceleration, J q̈ + J̇ q̇ = 0.
  int held_count() const noexcept { return static_cast<int>(held_.size()); }
  const double* held_jacobian(int i) const noexcept {
    return held_[static_cast<std::size_t>(i)].jacobian.data();
  }
  double held_bias(int i) const noexcept { return held_[static_cast<std::size_t>(i)].bias; }
  const Kinematics3& com() const noexcept { return com_; }
  // Angular velocity of the floating base, world axes: velocity = ω, bias = J̇_ω q̇.
  const Kinematics3& base_rotation() const noexcept { return base_; }
  const std::array<double, 9>& R_WB() const noexcept { return R_WB_; }  // row-major
  const std::array<double, 3>& rpy() const noexcept { return rpy_; }    // rad, R = Rz Ry Rx
  // About the CoM, world axes: linear (kg m/s) then angular (kg m^2/s).
  const std::array<double, 6>& centroidal_momentum() const noexcept { return momentum_; }

  // Angular momentum about the CoM, world axes: velocity = h = A_G q̇ (kg m^2/s), jacobian = A_G
  // (the angular rows of the centroidal momentum matrix), bias = Ȧ_G q̇, so that A_G q̈ + Ȧ_G q̇ is
  // the moment of the contact forces about the CoM. Computed when it is first asked for.
  const Kinematics3& angular_momentum() const noexcept {
    if (!fresh_angular_) fill_angular_momentum();
    return angular_;
  }

  const std::vector<double>& bias() const noexcept { return bias_; }  // b + g, nv
  TreeFactor factor() const noexcept;
  // g = -M_total J_comᵀ g_vec (nv) and the dense, symmetric A (nv x nv); for tests and tools.
  void gravity_force(double* g) const noexcept;
  void mass_matrix(double* A) const noexcept;

 private:
  struct Mujoco;
  // A point's place on its link.
  struct Anchor {
    int body = 0;
    std::array<double, 3> offset{};  // m, link frame
    double radius = 0.0;             // m, from it to the contact point
    std::array<double, 9> R_LF{};    // of its frame in the link's, row-major
  };
  void update_positions() noexcept;
  void fill_point(int index) const noexcept;
  void fill_frame(int index) const noexcept;
  void fill_angular_momentum() const noexcept;
  void place_points(const RobotDescription& robot);
  void com_from_base_rows() noexcept;
  void update_com_and_base() noexcept;
  void update_held() noexcept;
  void point_motion(int body, const double* p, std::array<double, 3>* velocity,
                    std::array<double, 3>& bias) const noexcept;

  struct Held {
    int body = 0, axis = 0;
    double bias = 0.0;
    std::vector<double> jacobian;  // nv
  };
  std::unique_ptr<Mujoco> mj_;
  std::vector<Held> held_;
  std::vector<double> held_scratch_;  // 6 x nv
  SensorMounts mounts_;
  int nv_ = 0;
  int contact_count_ = 0;
  int base_body_ = 0;
  double mass_ = 0.0;
  double gravity_ = 9.81;
  State state_;
  std::vector<Anchor> anchors_;
  Terrain terrain_;
  std::vector<std::array<double, 3>> normals_;  // by contact
  mutable std::vector<Kinematics3> points_;     // Jacobians of named points are filled on demand
  mutable std::vector<unsigned char> fresh_;    // which of them are of the state given last
  mutable std::vector<FrameRotation> frames_;   // on demand too
  mutable std::vector<unsigned char> fresh_frame_;
  mutable Kinematics3 angular_;
  mutable bool fresh_angular_ = false;
  mutable std::vector<double> mass_matrix_;  // nv x nv, for angular_
  Kinematics3 com_;
  Kinematics3 base_;
  std::array<double, 9> R_WB_{};
  std::array<double, 3> rpy_{};
  std::array<double, 6> momentum_{};
  std::vector<double> bias_;
};

}  // namespace footfall::model
