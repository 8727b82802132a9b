// Lock-step MuJoCo; see mujoco_backend.h.
#include "sim/mujoco_backend.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/index.h"
#include "core/realtime/mujoco_errors.h"
#include "model/mjcf.h"
#include "sim/scene.h"

namespace footfall::sim {
namespace {

// The foot geom of a contact: the collision sphere centred at its site.
int foot_geom(const mjModel* m, const mjData* d, int site) {
  for (int g = 0; g < m->ngeom; ++g) {
    if (m->geom_bodyid[g] != m->site_bodyid[site] || m->geom_type[g] != mjGEOM_SPHERE) continue;
    if (m->geom_contype[g] == 0 && m->geom_conaffinity[g] == 0) continue;
    if (mju_dist3(d->geom_xpos + 3 * g, d->site_xpos + 3 * site) < 1e-6) return g;
  }
  return -1;
}

}  // namespace

MujocoBackend::MujocoBackend(Empty, const model::RobotDescription& robot,
                             const WorldDescription& world)
    : robot_(robot), world_(world) {}

MujocoBackend::MujocoBackend(const model::RobotDescription& robot, const WorldDescription& world)
    : MujocoBackend(Empty{}, robot, world) {
  model_ = model::compile_mjcf(scene_xml(robot, world), robot.model_path);
  model::use_own_settings(*model_);
  data_ = mj_makeData(model_);
  add_sliders();
  tilt_axes();
  mj_forward(model_, data_);
  for (const model::JointDescription& j : robot.joints) {
    const int id = mj_name2id(model_, mjOBJ_JOINT, j.name.c_str());
    if (id < 0)
      throw std::runtime_error(robot.path + ": error: no joint '" + j.name + "' in the model");
    qpos_.push_back(model_->jnt_qposadr[id]);
    dof_.push_back(model_->jnt_dofadr[id]);
    int actuator = -1;
    for (int a = 0; a < model_->nu; ++a) {
      if (model_->actuator_trntype[a] == mjTRN_JOINT && model_->actuator_trnid[2 * a] == id)
        actuator = a;
    }
    if (actuator < 0) {
      throw std::runtime_error(robot.path + ": error: joint '" + j.name +
                               "' has no motor in the model");
    }
    actuator_.push_back(actuator);
  }
  std::vector<int> balls;
  contact_of_geom_.assign(at(model_->ngeom), kOtherBody);
  for (int g = 0; g < model_->ngeom; ++g) {
    if (model_->geom_bodyid[g] == 0) contact_of_geom_[at(g)] = kGround;
  }
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    const int site = mj_name2id(model_, mjOBJ_SITE, robot.contacts[c].site.c_str());
    const int geom = site < 0 ? -1 : foot_geom(model_, data_, site);
    if (geom < 0) {
      throw std::runtime_error(robot.path + ": error: contact '" + robot.contacts[c].name +
                               "' has no collision sphere centred at its site in the model");
    }
    contact_of_geom_[at(geom)] = static_cast<int>(c);
    balls.push_back(geom);
  }
  if (world.height_error > 0.0) footholds_.emplace(*model_, world, balls);
  mount_sensors();
  attach_constraints();
  const double step = model_->opt.timestep;
  const auto delay = static_cast<std::size_t>(std::llround(world.actuators.command_delay / step));
  delay_line_.assign(delay + 1, std::vector<double>(robot.joints.size(), 0.0));
  if (world.actuators.model == ActuatorModel::series_elastic) {
    drive_.emplace(drive_settings(world.actuators, robot, world.physics.steps_per_tick));
    refuse_stiff_springs();
  }
}

MujocoBackend::~MujocoBackend() {
  core::set_mujoco_running(false, nullptr);
  mj_deleteData(data_);
  mj_deleteModel(model_);
}

// Between two physics steps a spring's torque does not see its joint move: stable up to h^2 k = 4 a
// (semi-implicit Euler), a the joint's inertia with all else free, least in the start's posture or
// another; a quarter of it is refused for that.
void MujocoBackend::refuse_stiff_springs() {
  const double h = model_->opt.timestep;
  std::vector<double> column(at(model_->nv));
  for (std::size_t j = 0; j < dof_.size(); ++j) {
    std::fill(column.begin(), column.end(), 0.0);
    column[at(dof_[j])] = 1.0;
    mj_solveM(model_, data_, column.data(), column.data(), 1);
    const double most = 1.0 / (h * h * column[at(dof_[j])]);
    const double spring = drive_->actuator(static_cast<int>(j)).parameters().spring;
    if (spring <= most) continue;
    throw std::runtime_error(robot_.path + ": error: the spring of joint '" +
                             robot_.joints[j].name + "' is too stiff for the physics step: " +
                             std::to_string(spring) + " Nm/rad, expected at most " +
                             std::to_string(most) + " (or a larger physics: timestep_divisor)");
  }
}

// Inertia on the diagonal of the free joint's translation, whose velocity is that of the base's
// origin in world axes: a mass that moves with it along an axis.
void MujocoBackend::add_sliders() {
  for (const model::BodySprings& aid : world_.constraints) {
    if (aid.slides == std::array<double, 3>{}) continue;
    const int body = find_body(aid.body.name);
    if (body <= 0 || model_->body_dofnum[body] != 6) continue;  // refused: check_springs()
    for (int k = 0; k < 3; ++k) {
      model_->dof_armature[model_->body_dofadr[body] + k] += aid.slides[at(k)];
    }
  }
}

// Of `axis_tilts`: the joint's body, and all that it carries, is turned in its parent.
void MujocoBackend::tilt_axes() {
  core::Diagnostics ignored;  // the world was checked
  const std::vector<double> tilts = axis_tilts(world_, robot_, ignored);
  for (std::size_t j = 0; j < tilts.size(); ++j) {
    const int joint = mj_name2id(model_, mjOBJ_JOINT, robot_.joints[j].name.c_str());
    if (tilts[j] == 0.0 || joint < 0) continue;
    double* quat = model_->body_quat + 4 * model_->jnt_bodyid[joint];
    const std::array<double, 4> turn = {std::cos(0.5 * tilts[j]), 0.0, 0.0,
                                        std::sin(0.5 * tilts[j])};
    std::array<double, 4> turned{};
    mju_mulQuat(turned.data(), quat, turn.data());
    std::copy(turned.begin(), turned.end(), quat);
  }
  mj_setConst(model_, data_);
}

// Sets the posture of robot and world, beside it what was drawn: upright, the start's height
// above where the first ball rests on the ground.
void MujocoBackend::place_at_posture() {
  mj_resetData(model_, data_);
  const StartOffsets& start = world_.start;
  core::Diagnostics ignored;  // the world was checked
  const std::vector<double> beside = start_joints(world_.start_joints, robot_, ignored);
  for (std::size_t j = 0; j < qpos_.size(); ++j) {
    data_->qpos[qpos_[j]] =
        robot_.joints[j].posture + beside[j] + (j < start.joints.size() ? start.joints[j] : 0.0);
  }
  mj_kinematics(model_, data_);
  const model::Terrain terrain = terrain_of(world_.terrain);
  double lift = -1e9;  // m, until the first ball rests on the ground below it
  for (const model::ContactDescription& c : robot_.contacts) {
    const int site = mj_name2id(model_, mjOBJ_SITE, c.site.c_str());
    const double* p = data_->site_xpos + 3 * site;
    lift = std::max(lift, terrain.rest_height(p[0], p[1], c.radius) - p[2]);
  }
  if (!robot_.contacts.empty()) data_->qpos[2] += lift;
  data_->qpos[2] += world_.start_height;
  for (std::size_t k = 0; k < 2; ++k) data_->qvel[k] = start.velocity[k];
  for (std::size_t k = 0; k < 3; ++k) data_->qvel[3 + k] = start.rates[k];
  mj_forward(model_, data_);
}

void MujocoBackend::start() {
  if (footholds_) footholds_->start(*model_);
  place_at_posture();
  attach_constraints();
  for (auto& line : delay_line_) std::fill(line.begin(), line.end(), 0.0);
  delay_head_ = 0;
  if (drive_) {
    for (std::size_t j = 0; j < qpos_.size(); ++j) joint_angles_[j] = data_->qpos[qpos_[j]];
    drive_torques_ = {};
    drive_->start({joint_angles_.data(), qpos_.size()}, {drive_torques_.data(), qpos_.size()});
  }
  start_sensors();
  pushes_ = {};
  aid_force_ = {};
  held_ = {};
  tick_ = 0;
  stopped_ = false;
  warnings_at_start_ = warnings();
  // From here on an error inside MuJoCo must not unwind through the tick.
  core::set_mujoco_running(true, nullptr);
}

void MujocoBackend::attach_constraints() {
  constraints_.clear();
  for (const model::BodySprings& aid : world_.constraints) {
    const int body = find_body(aid.body.name);
    if (body <= 0) {  // check_links() says it at its place
      throw std::runtime_error(world_.path + ": error: the constraint '" + aid.name +
                               "' acts on a body that the robot lacks: '" + aid.body.name + "'");
    }
    constraints_.push_back(attach_springs(*model_, *data_, body, aid, world_.physics.hands));
  }
}

std::int64_t MujocoBackend::warnings() const noexcept {
  std::int64_t sum = core::mujoco_warning_count();
  for (const auto& w : data_->warning) sum += w.number;
  return sum;
}

void MujocoBackend::write(const hal::Commands& commands) noexcept {
  aid_force_ = {};
  for (int step = 0; step < world_.physics.steps_per_tick; ++step) {
    if (drive_) {
      advance_drive(commands);
    } else {
      apply_commands(commands);
    }
    apply_forces();
    mj_step(model_, data_);
  }
  if (footholds_) footholds_->update(*model_, *data_);
  ++tick_;
}

// Ideal actuators: the commands of `delay` ago are the joint torques.
void MujocoBackend::apply_commands(const hal::Commands& commands) noexcept {
  std::vector<double>& slot = delay_line_[delay_head_];
  std::copy_n(commands.tau.begin(), slot.size(), slot.begin());
  delay_head_ = (delay_head_ + 1) % delay_line_.size();
  const std::vector<double>& now = delay_line_[delay_head_];  // oldest: written `delay` ago
  for (std::size_t j = 0; j < now.size(); ++j) data_->ctrl[actuator_[j]] = stopped_ ? 0.0 : now[j];
}

// Springs' torques over a physics step. MuJoCo's velocities are those of the middle between two
// positions (semi-implicit Euler): with the joints placed half a step back, their mean angle over
// the drive's step is the present one, and the coupling adds and takes no energy up to third order.
// With rk4 both are of one time. The spring is no motor of the model: its torque is not clamped by
// a ctrlrange.
void MujocoBackend::advance_drive(const hal::Commands& commands) noexcept {
  const std::size_t n = qpos_.size();
  const double half = model_->opt.integrator == mjINT_RK4 ? 0.0 : 0.5 * model_->opt.timestep;
  for (std::size_t j = 0; j < n; ++j) {
    joint_rates_[j] = data_->qvel[dof_[j]];
    joint_angles_[j] = data_->qpos[qpos_[j]] - half * joint_rates_[j];
    drive_torques_[j] = stopped_ ? 0.0 : commands.tau[j];
  }
  drive_->command({drive_torques_.data(), n});
  drive_->place({joint_angles_.data(), n});
  drive_->advance({joint_rates_.data(), n}, {drive_torques_.data(), n});
  for (std::size_t j = 0; j < n; ++j) data_->qfrc_applied[dof_[j]] = drive_torques_[j];
}

void MujocoBackend::set_torque_loop(int joint, const hal::TorqueLoopGains& gains) noexcept {
  if (drive_) drive_->change_gains(joint, gains);
}

int MujocoBackend::find_body(const std::string& name) const {
  return mj_name2id(model_, mjOBJ_BODY, name.c_str());
}

PhysicsFacts MujocoBackend::facts() const {
  PhysicsFacts f;
  f.timestep = model_->opt.timestep;
  f.friction = world_.friction;
  f.equalities = model_->neq;
  f.mocap_bodies = model_->nmocap;
  f.mass = model_->body_subtreemass[1];
  for (int g = 0; g < model_->ngeom; ++g) {
    if (contact_of_geom_[at(g)] < 0) continue;
    f.foot_radius_max = std::max(f.foot_radius_max, model_->geom_size[3 * g]);
    f.condim_max = std::max(f.condim_max, model_->geom_condim[g]);
  }
  for (int g = 0; g < model_->ngeom; ++g) {
    if (contact_of_geom_[at(g)] == kGround)
      f.condim_max = std::max(f.condim_max, model_->geom_condim[g]);
  }
  for (int i = 0; i < model_->nv; ++i) {
    f.damping_max = std::max(f.damping_max, model_->dof_damping[i]);
    if (model_->jnt_type[model_->dof_jntid[i]] == mjJNT_FREE) continue;  // sliders of the world
    f.armature_max = std::max(f.armature_max, model_->dof_armature[i]);
  }
  return f;
}

void MujocoBackend::safe_stop() noexcept {
  stopped_ = true;
  core::set_mujoco_running(false, nullptr);
}

}  // namespace footfall::sim
