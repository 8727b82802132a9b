// External forces on the robot: pushes, holds, and the aids of the world.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "sim/mujoco_backend.h"

namespace footfall::sim {

// MuJoCo's positions and velocities are those of the beginning of the last physics step. A force
// that lags behind by a step h adds the damping -h k to a spring k, and an undamped one would gain
// energy; so they are brought up to date. What mj_step computes does not depend on it.
void MujocoBackend::update_positions() noexcept {
  mj_kinematics(model_, data_);
  mj_comPos(model_, data_);
  mj_comVel(model_, data_);
}

void MujocoBackend::apply_forces() noexcept {
  const auto clear = [this](int body) {
    if (body != 0) std::fill_n(data_->xfrc_applied + 6 * body, 6, 0.0);
  };
  for (const ActivePush& p : pushes_) clear(p.body);
  for (const ActiveSprings& h : held_) clear(h.body);
  for (const ActiveSprings& c : constraints_) clear(c.body);
  // Pushes on one body add up. The last step of one that lasts no whole number of steps has a part
  // of the force, so that the impulse is force times duration.
  for (ActivePush& p : pushes_) {
    if (p.body == 0) continue;
    double* force = data_->xfrc_applied + 6 * p.body;
    const double part = std::clamp(p.steps_left, 0.0, 1.0);
    for (std::size_t k = 0; k < 3 && part > 0.0; ++k) force[k] += part * p.force[k];
    if (p.point && part > 0.0) {
      update_positions();
      mjtNum place[3], arm[3], moment[3];
      mju_rotVecMat(place, p.point->data(), data_->xmat + 9 * p.body);
      mju_addTo3(place, data_->xpos + 3 * p.body);
      mju_sub3(arm, place, data_->xipos + 3 * p.body);
      mju_cross(moment, arm, p.force.data());
      for (int k = 0; k < 3; ++k) force[3 + k] += part * moment[k];
    }
    p.steps_left -= 1.0;
    if (p.steps_left <= -1.0) p = {};  // one step later: its force was cleared above
  }
  const auto needs_present = [](const ActiveSprings& s) { return s.body != 0 && s.present; };
  if (!constraints_.empty() || std::ranges::any_of(held_, needs_present)) update_positions();
  for (const ActiveSprings& h : held_) {
    if (h.body != 0) apply_springs(*model_, *data_, h);
  }
  for (const ActiveSprings& c : constraints_) {
    std::array<double, 3> before{};
    const double* force = data_->xfrc_applied + 6 * c.body;
    std::copy_n(force, 3, before.begin());
    apply_springs(*model_, *data_, c);
    for (std::size_t k = 0; k < 3; ++k) aid_force_[k] += force[k] - before[k];
  }
}

int MujocoBackend::hold(int body, const model::BodySprings& springs) noexcept {
  const auto slot = std::ranges::find(held_, 0, &ActiveSprings::body);
  if (slot == held_.end()) return -1;
  if (!springs.all) update_positions();
  *slot = attach_springs(*model_, *data_, body, springs, world_.physics.hands);
  return static_cast<int>(slot - held_.begin());
}

void MujocoBackend::release(int hold) noexcept {
  ActiveSprings& held = held_[at(hold)];
  std::fill_n(data_->xfrc_applied + 6 * held.body, 6, 0.0);
  held = {};
}

bool MujocoBackend::push(int body, double force, double direction, double duration,
                         double elevation,
                         const std::optional<std::array<double, 3>>& point) noexcept {
  const auto free_slot =
      std::find_if(pushes_.begin(), pushes_.end(), [](const ActivePush& p) { return p.body == 0; });
  if (free_slot == pushes_.end()) return false;
  const double* q = data_->qpos + 3;
  const double yaw =
      std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  free_slot->body = body;
  const double level = elevation == 0.0 ? force : force * std::cos(elevation);
  free_slot->force = {level * std::cos(yaw + direction), level * std::sin(yaw + direction),
                      force * std::sin(elevation)};
  free_slot->point = point;
  const double steps = duration / model_->opt.timestep;
  const double whole = std::round(steps);  // of times that are such up to round-off
  free_slot->steps_left = std::abs(steps - whole) < 1e-9 * std::max(whole, 1.0) ? whole : steps;
  return true;
}

}  // namespace footfall::sim
