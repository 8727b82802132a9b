// MuJoCo's recursive algorithms on the control model; see control_model.h.
#include "model/control_model.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/index.h"
#include "model/mjcf.h"

namespace footfall::model {
namespace {

struct ModelDeleter {
  void operator()(mjModel* m) const { mj_deleteModel(m); }
};
struct DataDeleter {
  void operator()(mjData* d) const { mj_deleteData(d); }
};

int require_object(const mjModel* m, const RobotDescription& robot, mjtObj type,
                   const std::string& name, const std::string& what) {
  const int id = mj_name2id(m, type, name.c_str());
  if (id < 0) {
    throw std::runtime_error(robot.path + ": error: " + what + " names the " +
                             (type == mjOBJ_SITE ? "site" : "body") + " '" + name + "', which " +
                             robot.model_path + " does not have");
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
  const auto body = [&](const std::string& link) {
    const int b = mj_name2id(m, mjOBJ_BODY, link.c_str());
    if (b < 0) {
      throw std::runtime_error("control_model.com: " + robot.model_path + " has no link '" + link +
                               "'");
    }
    return b;
  };
  for (const auto& [link, scale] : deviation.mass_scales) {
    const int b = body(link);
    m->body_mass[b] *= scale;
    for (int k = 0; k < 3; ++k) m->body_inertia[3 * b + k] *= scale;
  }
  for (const auto& [link, shift] : deviation.com_shift) {
    const int b = body(link);
    for (std::size_t k = 0; k < 3; ++k) m->body_ipos[3 * b + static_cast<int>(k)] += shift[k];
  }
  mj_setConst(m, d);
}

using Vector3 = std::array<double, 3>;

Vector3 cross(const double* a, const double* b) noexcept {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
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

// R = Rz(yaw) Ry(pitch) Rx(roll).
Vector3 rpy_of(const std::array<double, 9>& R) noexcept {
  return {std::atan2(R[7], R[8]), std::asin(std::clamp(-R[6], -1.0, 1.0)), std::atan2(R[3], R[0])};
}

}  // namespace

struct ControlModel::Mujoco {
  std::unique_ptr<mjModel, ModelDeleter> model;
  std::unique_ptr<mjData, DataDeleter> data;
};

ControlModel::ControlModel(const RobotDescription& robot, const ModelDeviation& deviation)
    : mj_(std::make_unique<Mujoco>()), terrain_(deviation.terrain) {
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
  place_points(robot);
  mounts_ = sensor_mounts(*m, robot);
  const auto cells = static_cast<std::size_t>(3 * nv_);
  for (Kinematics3& p : points_) p.jacobian.assign(cells, 0.0);
  for (FrameRotation& f : frames_) f.angular.jacobian.assign(cells, 0.0);
  angular_.jacobian.assign(cells, 0.0);
  mass_matrix_.assign(static_cast<std::size_t>(nv_ * nv_), 0.0);
  com_.jacobian.assign(cells, 0.0);
  for (int k = 0; k < 3; ++k) com_.jacobian[at(k * nv_ + k)] = 1.0;
  base_.jacobian.assign(cells, 0.0);
  bias_.assign(static_cast<std::size_t>(nv_), 0.0);
  held_scratch_.assign(2 * cells, 0.0);
  for (const HeldAxis& axis : deviation.held) {
    const int body = require_object(m, robot, mjOBJ_BODY, axis.body, "an external aid");
    held_.push_back({body, axis.axis, 0.0, std::vector<double>(at(nv_), 0.0)});
  }
  // Shapes and sites have no part in dynamics, but MuJoCo's kinematics would place each of them
  // at every tick; their places of interest are kept as anchors.
  m->ngeom = m->nsite = m->ncam = m->nlight = 0;
}

ControlModel::~ControlModel() = default;

void ControlModel::place_points(const RobotDescription& robot) {
  const mjModel* m = mj_->model.get();
  const auto add = [&](int body, const double* p, const double* quat, double radius) {
    Anchor anchor = {body, {}, radius, {1, 0, 0, 0, 1, 0, 0, 0, 1}};
    if (p != nullptr) std::copy_n(p, 3, anchor.offset.begin());
    if (quat != nullptr) mju_quat2Mat(anchor.R_LF.data(), quat);
    anchors_.push_back(anchor);
  };
  const auto add_site = [&](const std::string& name, const std::string& what, double radius) {
    const int site = require_object(m, robot, mjOBJ_SITE, name, what);
    add(m->site_bodyid[site], m->site_pos + 3 * site, m->site_quat + 4 * site, radius);
  };
  for (const ContactDescription& c : robot.contacts) {
    add_site(c.site, "contact '" + c.name + "'", c.radius);
  }
  for (const PointDescription& p : robot.points) {
    if (p.body.empty()) {
      add_site(p.site, "point '" + p.name + "'", 0.0);
    } else {
      add(require_object(m, robot, mjOBJ_BODY, p.body, "point '" + p.name + "'"), nullptr, nullptr,
          0.0);
    }
  }
  normals_.assign(robot.contacts.size(), {0.0, 0.0, 1.0});
  points_.resize(anchors_.size());
  fresh_.assign(anchors_.size(), 0);
  frames_.resize(anchors_.size());
  fresh_frame_.assign(anchors_.size(), 0);
}

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
  update_positions();
  update_com_and_base();
  update_held();
}

void ControlModel::update_held() noexcept {
  const mjData* d = mj_->data.get();
  for (Held& held : held_) {
    double* const rows = held_scratch_.data();
    mj_jacBodyCom(mj_->model.get(), mj_->data.get(), rows, rows + 3 * nv_, held.body);
    std::copy_n(rows + held.axis * nv_, nv_, held.jacobian.data());
    Vector3 bias{};
    point_motion(held.body, d->xipos + 3 * held.body, nullptr, bias);
    held.bias = held.axis < 3 ? bias[at(held.axis)] : d->cacc[6 * held.body + held.axis - 3];
  }
}

// Velocity and J̇q̇ of a point fixed to `body` and now at p: v = v_c + ω x r, a = a_c + α x r + ω x v
// with r from the tree's CoM (MuJoCo's c-frame); gravity, which MuJoCo adds as an acceleration of
// the world, taken out again.
void ControlModel::point_motion(int body, const double* p, std::array<double, 3>* velocity,
                                std::array<double, 3>& bias) const noexcept {
  const mjModel* m = mj_->model.get();
  const mjData* d = mj_->data.get();
  const double* c = d->subtree_com + 3 * m->body_rootid[body];
  const double* acc = d->cacc + 6 * body;
  const double* vel = d->cvel + 6 * body;
  const Vector3 r = {p[0] - c[0], p[1] - c[1], p[2] - c[2]};
  const Vector3 wxr = cross(vel, r.data());
  const Vector3 v = {vel[3] + wxr[0], vel[4] + wxr[1], vel[5] + wxr[2]};
  const Vector3 axr = cross(acc, r.data());
  const Vector3 wxv = cross(vel, v.data());
  for (std::size_t k = 0; k < 3; ++k) {
    bias[k] = acc[3 + k] + axr[k] + wxv[k] + m->opt.gravity[k];
  }
  if (velocity) *velocity = v;
}

void ControlModel::update_positions() noexcept {
  const mjData* d = mj_->data.get();
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Anchor& a = anchors_[i];
    const double* R = d->xmat + 9 * a.body;
    for (std::size_t k = 0; k < 3; ++k) {
      points_[i].position[k] = d->xpos[3 * a.body + static_cast<int>(k)] + R[3 * k] * a.offset[0] +
                               R[3 * k + 1] * a.offset[1] + R[3 * k + 2] * a.offset[2];
    }
    if (i < normals_.size()) {
      normals_[i] = terrain_.nearest(points_[i].position).normal;
      for (std::size_t k = 0; k < 3; ++k) points_[i].position[k] -= a.radius * normals_[i][k];
    }
    fresh_[i] = fresh_frame_[i] = 0;
  }
  fresh_angular_ = false;
}

void ControlModel::fill_point(int index) const noexcept {
  const auto i = static_cast<std::size_t>(index);
  Kinematics3& out = points_[i];
  mj_jac(mj_->model.get(), mj_->data.get(), out.jacobian.data(), nullptr, out.position.data(),
         anchors_[i].body);
  point_motion(anchors_[i].body, out.position.data(), &out.velocity, out.bias);
  fresh_[i] = 1;
}

std::array<double, 3> ControlModel::point_angular_velocity(int index) const noexcept {
  const double* velocity = mj_->data->cvel + 6 * anchors_[static_cast<std::size_t>(index)].body;
  return {velocity[0], velocity[1], velocity[2]};
}

void ControlModel::fill_frame(int index) const noexcept {
  const auto i = static_cast<std::size_t>(index);
  const mjData* d = mj_->data.get();
  const int body = anchors_[i].body;
  FrameRotation& out = frames_[i];
  mju_mulMatMat(out.R_WF.data(), d->xmat + 9 * body, anchors_[i].R_LF.data(), 3, 3, 3);
  out.rpy = rpy_of(out.R_WF);
  mj_jac(mj_->model.get(), d, nullptr, out.angular.jacobian.data(), points_[i].position.data(),
         body);
  std::copy_n(d->cvel + 6 * body, 3, out.angular.velocity.begin());
  std::copy_n(d->cacc + 6 * body, 3, out.angular.bias.begin());
  fresh_frame_[i] = 1;
}

// The first six rows of A are the momentum of the whole tree as the base's velocity sees it: linear
// in world axes, angular about the base's origin p in its own axes. About the CoM c:
//   A_G = R_WB A[3:6] - (c - p) x A[0:3]
// and the first six entries of b + g, the wrench that q̈ = 0 takes, give Ȧ_G q̇ in the same way:
// gravity has no moment about the CoM.
void ControlModel::fill_angular_momentum() const noexcept {
  mj_fullM(mj_->model.get(), mass_matrix_.data(), mj_->data->qM);
  const Vector3 r = {com_.position[0] - state_.p_WB[0], com_.position[1] - state_.p_WB[1],
                     com_.position[2] - state_.p_WB[2]};
  const auto about_com = [&](const std::array<double, 6>& w) -> Vector3 {
    const Vector3 rxf = cross(r.data(), w.data());
    Vector3 n{};
    mju_mulMatVec(n.data(), R_WB_.data(), w.data() + 3, 3, 3);
    return {n[0] - rxf[0], n[1] - rxf[1], n[2] - rxf[2]};
  };
  const auto n = static_cast<std::size_t>(nv_);
  for (std::size_t q = 0; q < n; ++q) {
    std::array<double, 6> column{};
    for (std::size_t i = 0; i < 6; ++i) column[i] = mass_matrix_[i * n + q];
    const Vector3 h = about_com(column);
    for (std::size_t k = 0; k < 3; ++k) angular_.jacobian[k * n + q] = h[k];
  }
  angular_.bias = about_com({bias_[0], bias_[1], bias_[2], bias_[3], bias_[4], bias_[5]});
  std::copy_n(momentum_.begin() + 3, 3, angular_.velocity.begin());
  fresh_angular_ = true;
}

// The first three rows of A are the linear momentum in world axes, m J_com (its first three columns
// are the unit matrix, set by the constructor); those of b + g, the
// force that q̈ = 0 takes, are m (J̇_com q̇ - gravity).
void ControlModel::com_from_base_rows() noexcept {
  const mjModel* m = mj_->model.get();
  const mjData* d = mj_->data.get();
  // qM has of DoF i the diagonal, then the columns of its ancestors up to the base's z, y, x.
  for (int i = 3; i < nv_; ++i) {
    const int end = i + 1 < nv_ ? m->dof_Madr[i + 1] : m->nM;
    for (int k = 0; k < 3; ++k) com_.jacobian[at(k * nv_ + i)] = d->qM[end - 1 - k] / mass_;
  }
  for (std::size_t k = 0; k < 3; ++k) com_.bias[k] = bias_[k] / mass_ + m->opt.gravity[k];
}

void ControlModel::update_com_and_base() noexcept {
  const mjModel* m = mj_->model.get();
  mjData* d = mj_->data.get();
  std::copy_n(d->subtree_com + 3 * base_body_, 3, com_.position.data());
  com_from_base_rows();
  momentum_ = {};
  for (int b = base_body_; b < m->nbody; ++b) {
    if (m->body_rootid[b] != base_body_) continue;
    add_momentum(d->cinert + 10 * b, d->cvel + 6 * b, momentum_);
  }
  mj_jacBody(m, d, nullptr, base_.jacobian.data(), base_body_);
  std::copy_n(d->xmat + 9 * base_body_, 9, R_WB_.data());
  for (std::size_t k = 0; k < 3; ++k) {
    com_.velocity[k] = momentum_[k] / mass_;
    base_.velocity[k] = d->cvel[6 * base_body_ + static_cast<int>(k)];
    base_.bias[k] = d->cacc[6 * base_body_ + static_cast<int>(k)];
    base_.position[k] = state_.p_WB[k];
  }
  rpy_ = rpy_of(R_WB_);
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
