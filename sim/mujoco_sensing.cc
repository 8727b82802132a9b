// What the simulated robot measures: truth of a tick, and its sensors' errors.
#include <mujoco/mujoco.h>

#include <algorithm>

#include "core/index.h"
#include "model/sensor_mounts.h"
#include "sim/mujoco_backend.h"

namespace footfall::sim {

void MujocoBackend::mount_sensors() {
  hal::SensorPlaces places = sensor_places(model::sensor_mounts(*model_, robot_), robot_);
  std::copy_n(model_->opt.gravity, 3, places.gravity.begin());
  base_body_ = std::max(find_body(robot_.floating_base), 1);
  sensors_.emplace(world_.sensors.errors, places, robot_.period_s(), world_.noise_seed);
}

void MujocoBackend::start_sensors() {
  hal::BaseMotion motion;
  std::copy_n(data_->qpos, 3, motion.p_WB.begin());
  std::copy_n(data_->qpos + 3, 4, motion.q_WB.begin());
  std::copy_n(data_->qvel, 3, motion.v_WB.begin());
  std::copy_n(data_->qvel + 3, 3, motion.w_WB_B.begin());
  sensors_->start(motion);
}

bool MujocoBackend::read(hal::Sensors& s) noexcept {
  s.time_ns = tick_ * 1'000'000'000'000LL / robot_.rate_mhz;
  for (std::size_t j = 0; j < qpos_.size(); ++j) {
    s.q[j] = data_->qpos[qpos_[j]];
    s.qd[j] = data_->qvel[dof_[j]];
    s.tau[j] = data_->actuator_force[actuator_[j]];
  }
  s.has_truth = true;
  for (std::size_t k = 0; k < 3; ++k) {
    s.p_WB[k] = data_->qpos[k];
    s.v_WB[k] = data_->qvel[k];
    s.w_WB_B[k] = data_->qvel[3 + k];
  }
  for (std::size_t k = 0; k < 4; ++k) s.q_WB[k] = data_->qpos[3 + k];
  sense_contacts(s);
  if (sensors_->has_errors()) find_truth(s);
  s.motor_saturated = false;
  if (drive_) drive_->read(s);
  sensors_->sample(truth_, s);
  for (std::size_t k = 0; k < 3; ++k) {
    s.aid_force[k] = aid_force_[k] / world_.physics.steps_per_tick;
  }
  s.backend_fault = warnings() != warnings_at_start_;
  return true;
}

// Joints as the simulation has them, links that bend included. MuJoCo normalizes the base's
// quaternion where it updates positions; once more would change its last bits, and with them the
// run.
void MujocoBackend::find_truth(const hal::Sensors& s) noexcept {
  std::copy_n(s.q.begin(), qpos_.size(), truth_.q.begin());
  std::copy_n(s.qd.begin(), qpos_.size(), truth_.qd.begin());
  std::array<double, 4> orientation{};
  std::copy_n(data_->qpos + 3, 4, orientation.begin());
  update_positions();
  std::ranges::copy(orientation, data_->qpos + 3);
  mj_subtreeVel(model_, data_);
  std::copy_n(data_->subtree_com + 3 * base_body_, 3, truth_.com.begin());
  std::copy_n(data_->subtree_linvel + 3 * base_body_, 3, truth_.com_velocity.begin());
}

// Contacts of the last physics step: forces on the feet, and contact of any other body.
void MujocoBackend::sense_contacts(hal::Sensors& s) noexcept {
  s.contact.fill(false);
  for (auto& f : s.force) f = {};
  truth_.normal_force.fill(0.0);
  s.body_contact = false;
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& con = data_->contact[i];
    if (con.exclude != 0 || con.efc_address < 0) continue;
    std::array<double, 6> local{};
    mj_contactForce(model_, data_, i, local.data());
    if (!(local[0] > 0.0)) continue;
    std::array<double, 3> world{};
    mju_mulMatTVec(world.data(), con.frame, local.data(), 3, 3);
    const std::array<int, 2> geoms = {con.geom1, con.geom2};
    for (std::size_t side = 0; side < 2; ++side) {
      const int owner = contact_of_geom_[at(geoms[side])];
      if (owner == kOtherBody) s.body_contact = true;
      if (owner < 0) continue;
      if (contact_of_geom_[at(geoms[1 - side])] == kGround) {
        truth_.normal_force[at(owner)] += local[0];
      }
      const double sign = side == 1 ? 1.0 : -1.0;  // the force acts on geom2
      for (std::size_t k = 0; k < 3; ++k) s.force[at(owner)][k] += sign * world[k];
    }
  }
}

}  // namespace footfall::sim
