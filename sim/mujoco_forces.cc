// External forces on the robot: pushes and held bodies.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "sim/mujoco_backend.h"

namespace footfall::sim {
void MujocoBackend::apply_forces() noexcept {
  for (const ActivePush& p : pushes_) {
    if (p.body != 0) std::fill_n(data_->xfrc_applied + 6 * p.body, 6, 0.0);
  }
  for (const HeldBody& h : held_) {
    if (h.body != 0) std::fill_n(data_->xfrc_applied + 6 * h.body, 6, 0.0);
  }
  // Pushes on one body add up. The last step of one that lasts no whole number of steps has a part
  // of the force, so that the impulse is force times duration.
  for (ActivePush& p : pushes_) {
    if (p.body == 0) continue;
    double* force = data_->xfrc_applied + 6 * p.body;
    const double part = std::clamp(p.steps_left, 0.0, 1.0);
    for (std::size_t k = 0; k < 3 && part > 0.0; ++k) force[k] += part * p.force[k];
    p.steps_left -= 1.0;
    if (p.steps_left <= -1.0) p = {};  // one step later: its force was cleared above
  }
  for (const HeldBody& h : held_) {
    if (h.body != 0) apply_hold(h);
  }
}

// f = m (w^2 (x_held - x) - 2 w v) at the centre of mass; at the root body, whose rotation carries
// all the others, likewise with the rotational inertia that its free joint sees.
void MujocoBackend::apply_hold(const HeldBody& held) noexcept {
  const double w = world_.physics.hands;
  const int root = model_->body_rootid[held.body];
  const double mass = model_->body_subtreemass[root];
  std::array<double, 6> velocity{};  // rotation, then translation of the CoM; world
  mj_objectVelocity(model_, data_, mjOBJ_BODY, held.body, velocity.data(), 0);
  double* force = data_->xfrc_applied + 6 * held.body;
  const double* x = data_->xipos + 3 * held.body;
  for (std::size_t k = 0; k < 3; ++k) {
    force[k] += mass * (w * w * (held.position[k] - x[k]) - 2.0 * w * velocity[3 + k]);
  }
  if (held.body != root || model_->body_dofnum[root] != 6) return;
  std::array<double, 4> back{}, turn{};
  mju_negQuat(back.data(), data_->xquat + 4 * held.body);
  mju_mulQuat(turn.data(), held.orientation.data(), back.data());
  std::array<double, 3> angle{};
  mju_quat2Vel(angle.data(), turn.data(), 1.0);
  const int dof = model_->body_dofadr[root] + 3;
  double inertia = 1e9;  // the smallest of the three: stable about all axes
  for (int k = 0; k < 3; ++k) inertia = std::min(inertia, data_->qM[model_->dof_Madr[dof + k]]);
  for (std::size_t k = 0; k < 3; ++k) {
    force[3 + k] += inertia * (w * w * angle[k] - 2.0 * w * velocity[k]);
  }
}

bool MujocoBackend::hold(int body, bool on) noexcept {
  const auto wanted = std::ranges::find(held_, on ? 0 : body, &HeldBody::body);
  if (wanted == held_.end()) return false;
  *wanted = {};
  if (!on) {
    std::fill_n(data_->xfrc_applied + 6 * body, 6, 0.0);
    return true;
  }
  wanted->body = body;
  std::copy_n(data_->xipos + 3 * body, 3, wanted->position.begin());
  std::copy_n(data_->xquat + 4 * body, 4, wanted->orientation.begin());
  return true;
}

bool MujocoBackend::push(int body, double force, double direction, double duration) noexcept {
  const auto free_slot =
      std::find_if(pushes_.begin(), pushes_.end(), [](const ActivePush& p) { return p.body == 0; });
  if (free_slot == pushes_.end()) return false;
  const double* q = data_->qpos + 3;
  const double yaw =
      std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  free_slot->body = body;
  free_slot->force = {force * std::cos(yaw + direction), force * std::sin(yaw + direction), 0.0};
  const double steps = duration / model_->opt.timestep;
  const double whole = std::round(steps);  // of times that are such up to round-off
  free_slot->steps_left = std::abs(steps - whole) < 1e-9 * std::max(whole, 1.0) ? whole : steps;
  return true;
}

}  // namespace footfall::sim
