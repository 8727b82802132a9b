// MuJoCo's recursive algorithms on the control model; see control_model.h.
#include "model/control_model.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/mjcf.h"

namespace footfall::model {
namespace {

struct ModelDeleter {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct DataDeleter {
  void operator()(mjData* d) const { mj_deleteData(d); }
};

int require_site(const mjModel* m, const RobotDescription& robot, const std::string& site,
                 const std::string& what) {
  const int id = mj_name2id(m, mjOBJ_SITE, site.c_str());
  if (id < 0) {
    throw std::runtime_error(robot.path + ": error: " + what + " names the site '" + site +
                             "', which " + robot.model_path + " does not have");
  }
  return id;
}

// The dofs must be the free base and then the robot file's joints in its order.
void check_structure(const mjModel* m, const RobotDescription& robot) {
  const std::string head = robot.path + ": error: ";
  if (m->njnt == 0 || m->jnt_type[0] != mjJNT_FREE) {
    throw std::runtime_error(head + "the first joint of " + robot.model_path +
                             " must be the free joint of the floating base");
  }
  if (m->njnt - 1 != robot.joint_count()) {
    throw std::runtime_error(head + "it lists " + std::to_string(robot.joint_count()) +
                             " joints, " + robot.model_path + " has " +
                             std::to_string(m->njnt - 1));
  }
  for (int j = 1; j < m->njnt; ++j) {
    const std::string& expected = robot.joints[static_cast<std::size_t>(j - 1)].name;
    const char* given = mj_id2name(m, mjOBJ_JOINT, j);
    const std::string actual = given ? given : "";
    if (m->jnt_type[j] != mjJNT_HINGE && m->jnt_type[j] != mjJNT_SLIDE) {
      throw std::runtime_error(head + "joint '" + actual + "' must be a hinge or a slide");
    }
    if (actual != expected) {
      throw std::runtime_error(head + "joint " + std::to_string(j) + " is '" + expected +
                               "' here and '" + actual + "' in " + robot.model_path +
                               "; the order must be the same");
    }
  }
  if (robot.joint_count() > core::kMaxJoints) {
    throw std::runtime_error(head + "more than " + std::to_string(core::kMaxJoints) + " joints");
  }
}

void apply_deviation(mjModel* m, mjData* d, const RobotDescription& robot,
                     const ModelDeviation& deviation) {
  for (int b = 1; b < m->nbody; ++b) {
    m->body_mass[b] *= deviation.mass_scale;
    for (int k = 0; k < 3; ++k) m->body_inertia[3 * b + k] *= deviation.mass_scale;
  }
  for (const auto& [link, shift] : deviation.com_shift) {
    const int b = mj_name2id(m, mjOBJ_BODY, link.c_str());
    if (b < 0) {
      throw std::runtime_error("control_model.com: " + robot.model_path + " has no link '" + link +
                               "'");
    }
    for (std::size_t k = 0; k < 3; ++k) m->body_ipos[3 * b + static_cast<int>(k)] += shift[k];
  }
  mj_setConst(m, d);
}

// Adds one body's momentum about the tree's CoM. inertia: Ixx Iyy Izz Ixy Ixz Iyz, m c (3), m.
void add_momentum(const double* inertia, const double* velocity, std::array<double, 6>& sum) {
  const double* I = inertia;
  const double* mc = inertia + 6;
  const double m = inertia[9];
  const double* w = velocity;
  const double* v = velocity + 3;
  sum[0] += m * v[0] - (mc[1] * w[2] - mc[2] * w[1]);
  sum[1] += m * v[1] - (mc[2] * w[0] - mc[0] * w[2]);
  sum[2] += m * v[2] - (mc[0] * w[1] - mc[1] * w[0]);
  sum[3] += I[0] * w[0] + I[3] * w[1] + I[4] * w[2] + mc[1] * v[2] - mc[2] * v[1];
  sum[4] += I[3] * w[0] + I[1] * w[1] + I[5] * w[2] + mc[2] * v[0] - mc[0] * v[2];
  sum[5] += I[4] * w[0] + I[5] * w[1] + I[2] * w[2] + mc[0] * v[1] - mc[1] * v[0];
}

}  // namespace

struct ControlModel::Mujoco {
  std::unique_ptr<mjModel, ModelDeleter> model;
  std::unique_ptr<mjData, DataDeleter> data;
};

ControlModel::ControlModel(const RobotDescription& robot, const ModelDeviation& deviation)
    : mj_(std::make_unique<Mujoco>()) {
  mj_->model.reset(load_robot_model(robot.model_path));
  mjModel* m = mj_->model.get();
  check_structure(m, robot);
  mj_->data.reset(mj_makeData(m));
  apply_deviation(m, mj_->data.get(), robot, deviation);
  nv_ = m->nv;
  gravity_ = -m->opt.gravity[2];
  base_body_ = mj_name2id(m, mjOBJ_BODY, robot.floating_base.c_str());
  if (base_body_ < 0 || m->body_dofnum[base_body_] != 6) {
    throw std::runtime_error(robot.path + ": error: floating_base '" + robot.floating_base +
                             "' is not a body with a free joint in " + robot.model_path);
  }
  mass_ = m->body_subtreemass[base_body_];
  contact_count_ = static_cast<int>(robot.contacts.size());
  for (const ContactDescription& c : robot.contacts) {
    point_sites_.push_back(require_site(m, robot, c.site, "contact '" + c.name + "'"));
    point_radii_.push_back(c.radius);
  }
  for (const PointDescription& p : robot.points) {
    point_sites_.push_back(require_site(m, robot, p.site, "point '" + p.name + "'"));
    point_radii_.push_back(0.0);
  }
  points_.resize(point_sites_.size());
  const auto cells = static_cast<std::size_t>(3 * nv_);
  for (Kinematics3& p : points_) p.jacobian.assign(cells, 0.0);
  com_.jacobian.assign(cells, 0.0);
  base_.jacobian.assign(cells, 0.0);
  bias_.assign(static_cast<std::size_t>(nv_), 0.0);
}

ControlModel::~ControlModel() = default;

void ControlModel::update(const State& state) noexcept {
  state_ = state;
  const mjModel* m = mj_->model.get();
  mjData* d = mj_->data.get();
  std::copy_n(state.p_WB.data(), 3, d->qpos);
  std::copy_n(state.q_WB.data(), 4, d->qpos + 3);
  std::copy_n(state.q.data(), nv_ - 6, d->qpos + 7);
  std::copy_n(state.v_WB.data(), 3, d->qvel);
  std::copy_n(state.w_WB_B.data(), 3, d->qvel + 3);
  std::copy_n(state.qd.data(), nv_ - 6, d->qvel + 6);

  mj_kinematics(m, d);
  mj_comPos(m, d);
  mj_crb(m, d);
  mj_factorM(m, d);
  mj_comVel(m, d);
  // With q̈ = 0 (d->qacc is never written) this gives each body's bias acceleration and the inverse
  // dynamics' internal forces, whose projection on the joints is b + g.
  mj_rnePostConstraint(m, d);
  for (int i = 0; i < nv_; ++i) {
    bias_[static_cast<std::size_t>(i)] =
        mju_dot(d->cdof + 6 * i, d->cfrc_int + 6 * m->dof_bodyid[i], 6);
  }
  update_points();
  update_com_and_base();
}

// J̇q̇ of a point fixed to `body` and now at p: a = a_c + α x r + ω x v_p with r from the tree's CoM
// (MuJoCo's c-frame); gravity, which MuJoCo adds as an acceleration of the world, taken out again.
std::array<double, 3> ControlModel::point_bias(int body, const double* p) const noexcept {
  const mjModel* m = mj_->model.get();
  const mjData* d = mj_->data.get();
  const double* c = d->subtree_com + 3 * m->body_rootid[body];
  const double* acc = d->cacc + 6 * body;
  const double* vel = d->cvel + 6 * body;
  const std::array<double, 3> r = {p[0] - c[0], p[1] - c[1], p[2] - c[2]};
  std::array<double, 3> v{}, wxr{}, axr{}, wxv{};
  mju_cross(wxr.data(), vel, r.data());
  for (std::size_t k = 0; k < 3; ++k) v[k] = vel[3 + k] + wxr[k];
  mju_cross(axr.data(), acc, r.data());
  mju_cross(wxv.data(), vel, v.data());
  std::array<double, 3> a{};
  for (std::size_t k = 0; k < 3; ++k) {
    a[k] = acc[3 + k] + axr[k] + wxv[k] + m->opt.gravity[k];
  }
  return a;
}

void ControlModel::update_points() noexcept {
  const mjModel* m = mj_->model.get();
  const mjData* d = mj_->data.get();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    Kinematics3& out = points_[i];
    const int site = point_sites_[i];
    const int body = m->site_bodyid[site];
    std::copy_n(d->site_xpos + 3 * site, 3, out.position.data());
    out.position[2] -= point_radii_[i];
    mj_jac(m, d, out.jacobian.data(), nullptr, out.position.data(), body);
    for (std::size_t k = 0; k < 3; ++k) {
      out.velocity[k] = mju_dot(out.jacobian.data() + k * static_cast<std::size_t>(nv_), d->qvel, nv_);
    }
    out.bias = point_bias(body, out.position.data());
  }
}

void ControlModel::update_com_and_base() noexcept {
  const mjModel* m = mj_->model.get();
  mjData* d = mj_->data.get();
  const auto n = static_cast<std::size_t>(nv_);
  std::copy_n(d->subtree_com + 3 * base_body_, 3, com_.position.data());
  mj_jacSubtreeCom(m, d, com_.jacobian.data(), base_body_);
  com_.bias = {0.0, 0.0, 0.0};
  momentum_ = {};
  for (int b = base_body_; b < m->nbody; ++b) {
    if (m->body_rootid[b] != base_body_) continue;
    const std::array<double, 3> a = point_bias(b, d->xipos + 3 * b);
    for (std::size_t k = 0; k < 3; ++k) com_.bias[k] += m->body_mass[b] / mass_ * a[k];
    add_momentum(d->cinert + 10 * b, d->cvel + 6 * b, momentum_);
  }
  mj_jacBody(m, d, nullptr, base_.jacobian.data(), base_body_);
  std::copy_n(d->xmat + 9 * base_body_, 9, R_WB_.data());
  for (std::size_t k = 0; k < 3; ++k) {
    com_.velocity[k] = mju_dot(com_.jacobian.data() + k * n, d->qvel, nv_);
    base_.velocity[k] = mju_dot(base_.jacobian.data() + k * n, d->qvel, nv_);
    base_.bias[k] = d->cacc[6 * base_body_ + static_cast<int>(k)];
    base_.position[k] = state_.p_WB[k];
  }
  rpy_[0] = std::atan2(R_WB_[7], R_WB_[8]);
  rpy_[1] = std::asin(std::clamp(-R_WB_[6], -1.0, 1.0));
  rpy_[2] = std::atan2(R_WB_[3], R_WB_[0]);
}

TreeFactor ControlModel::factor() const noexcept {
  const mjModel* m = mj_->model.get();
  const mjData* d = mj_->data.get();
  return {nv_, d->qLD, m->dof_Madr, m->dof_parentid, d->qLDiagSqrtInv};
}

void ControlModel::gravity_force(double* g) const noexcept {
  for (int i = 0; i < nv_; ++i) {
    g[i] = mass_ * gravity_ * com_.jacobian[static_cast<std::size_t>(2 * nv_ + i)];
  }
}

void ControlModel::mass_matrix(double* A) const noexcept {
  mj_fullM(mj_->model.get(), A, mj_->data->qM);
}

}  // namespace footfall::model
