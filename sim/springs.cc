// The law of external aids; see springs.h.
#include "sim/springs.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>

namespace footfall::sim {
namespace {

using Vector = std::array<double, 3>;
using Quaternion = std::array<double, 4>;

bool is_free_root(const mjModel& m, int body) {
  return body == m.body_rootid[body] && m.body_dofnum[body] == 6;
}

// R = Rz(yaw) Ry(pitch) Rx(roll), with the angles that axes name in the place of the body's own.
Quaternion anchored_orientation(const double* q, const model::BodySprings& springs) {
  Quaternion out{q[0], q[1], q[2], q[3]};
  const auto has_angle = [](const auto& axis) { return axis && axis->at; };
  if (std::none_of(springs.axes.begin() + model::kFirstAngle, springs.axes.end(), has_angle)) {
    return out;
  }
  Vector angles = {
      std::atan2(2.0 * (q[0] * q[1] + q[2] * q[3]), 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2])),
      std::asin(std::clamp(2.0 * (q[0] * q[2] - q[3] * q[1]), -1.0, 1.0)),
      std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]))};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto& axis = springs.axes[model::kFirstAngle + k];
    if (has_angle(axis)) angles[k] = *axis->at;
  }
  out = {1.0, 0.0, 0.0, 0.0};
  for (std::size_t k = 3; k-- > 0;) {
    Vector about{};
    about[k] = 1.0;
    Quaternion turn{}, product{};
    mju_axisAngle2Quat(turn.data(), about.data(), angles[k]);
    mju_mulQuat(product.data(), out.data(), turn.data());
    out = product;
  }
  return out;
}

ActiveAxis attach_axis(const model::AxisSpring& spring, double inertia, double hands) {
  ActiveAxis out;
  out.acts = true;
  out.per_inertia = !spring.stiffness && !spring.damping;
  if (out.per_inertia) {
    out.stiffness = hands * hands;
    out.damping = 2.0 * hands;
  } else {
    out.stiffness = spring.stiffness.value_or(inertia * hands * hands);
    out.damping = spring.damping.value_or(2.0 * std::sqrt(out.stiffness * inertia));
  }
  if (spring.travel) {
    out.one_sided = true;
    out.low = (*spring.travel)[0];
    out.high = (*spring.travel)[1];
  }
  return out;
}

bool are_alike(const ActiveAxis& a, const ActiveAxis& b) {
  return a.acts && b.acts && !a.one_sided && !b.one_sided && a.per_inertia == b.per_inertia &&
         a.stiffness == b.stiffness && a.damping == b.damping;
}

// Rows of J in e' = J w, of the rotation vector e and the angular velocity w, both in world axes:
// J = 1 - [e]/2 + (1 - (t/2) cot(t/2))/t^2 [e]^2 with t = |e|. A force f on the component e_k is
// the torque J_k^T f: then the spring's energy k e_k^2/2 is all that it stores, also while the body
// is turned far about an axis that is free. Without J it would drive a robot that turns.
std::array<Vector, 3> rows_of(const Vector& e) {
  const double square = e[0] * e[0] + e[1] * e[1] + e[2] * e[2];
  const double half = 0.5 * std::sqrt(square);
  constexpr double kSmall = 1e-3;  // rad; the series is exact to round-off below
  const double factor =
      half < kSmall ? 1.0 / 12.0 + square / 720.0 : (1.0 - half / std::tan(half)) / square;
  std::array<Vector, 3> rows{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      rows[i][j] = factor * (e[i] * e[j] - (i == j ? square : 0.0)) + (i == j ? 1.0 : 0.0);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {  // [e] has -e_k at (i, j) for i, j, k in cyclic order
    const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
    rows[i][j] += 0.5 * e[k];
    rows[j][i] -= 0.5 * e[k];
  }
  return rows;
}

void apply_turns(const mjModel& m, mjData& d, const ActiveSprings& springs,
                 const double* velocity) noexcept {
  double* torque = d.xfrc_applied + 6 * springs.body + 3;
  Quaternion back{}, turn{};
  mju_negQuat(back.data(), d.xquat + 4 * springs.body);
  mju_mulQuat(turn.data(), springs.orientation.data(), back.data());
  Vector behind{};  // rotation vector from the present to the anchored orientation
  mju_quat2Vel(behind.data(), turn.data(), 1.0);
  const double inertia = inertia_behind(m, d, springs.body);
  if (springs.alike_turns) {
    for (std::size_t k = 0; k < 3; ++k) {
      torque[k] +=
          spring_force(springs.axes[model::kFirstAngle + k], inertia, behind[k], velocity[k]);
    }
    return;
  }
  const auto rows = rows_of({-behind[0], -behind[1], -behind[2]});
  for (std::size_t k = 0; k < 3; ++k) {
    const ActiveAxis& axis = springs.axes[model::kFirstAngle + k];
    if (!axis.acts) continue;
    const Vector& row = rows[k];
    const double rate = row[0] * velocity[0] + row[1] * velocity[1] + row[2] * velocity[2];
    const double force = spring_force(axis, inertia, behind[k], rate);
    for (std::size_t j = 0; j < 3; ++j) torque[j] += row[j] * force;
  }
}

// A rope's pull at its end on the body. velocity: of the body, rotation then translation of its
// CoM, world.
void apply_rope(mjData& d, const ActiveSprings& springs, const double* velocity) noexcept {
  const ActiveRope& rope = springs.rope;
  const double* origin = d.xpos + 3 * springs.body;
  const double* com = d.xipos + 3 * springs.body;
  Vector end{}, arm{}, moved{}, along{};
  mju_rotVecMat(end.data(), rope.from.data(), d.xmat + 9 * springs.body);
  for (std::size_t k = 0; k < 3; ++k) {
    end[k] += origin[k];
    arm[k] = end[k] - com[k];
    along[k] = rope.to[k] - end[k];
  }
  const double distance = mju_normalize3(along.data());
  mju_cross(moved.data(), velocity, arm.data());
  double rate = 0.0;
  for (std::size_t k = 0; k < 3; ++k) rate -= along[k] * (velocity[3 + k] + moved[k]);
  const double tension = rope_tension(rope, distance, rate);
  Vector pull{}, torque{};
  mju_scl3(pull.data(), along.data(), tension);
  mju_cross(torque.data(), arm.data(), pull.data());
  mju_addTo3(d.xfrc_applied + 6 * springs.body, pull.data());
  mju_addTo3(d.xfrc_applied + 6 * springs.body + 3, torque.data());
}

}  // namespace

double spring_force(const ActiveAxis& axis, double inertia, double behind, double rate) noexcept {
  const double scale = axis.per_inertia ? inertia : 1.0;
  if (!axis.one_sided) return scale * (axis.stiffness * behind - axis.damping * rate);
  if (-behind > axis.high) {
    return std::min(0.0, scale * (axis.stiffness * (behind + axis.high) - axis.damping * rate));
  }
  if (-behind < axis.low) {
    return std::max(0.0, scale * (axis.stiffness * (behind + axis.low) - axis.damping * rate));
  }
  return 0.0;
}

double rope_tension(const ActiveRope& rope, double distance, double rate) noexcept {
  if (distance <= rope.length) return 0.0;
  return std::max(0.0, rope.stiffness * (distance - rope.length) + rope.damping * rate);
}

double mass_behind(const mjModel_& model, int body) noexcept {
  return model.body_subtreemass[model.body_rootid[body]];
}

double inertia_behind(const mjModel_& model, const mjData_& data, int body) noexcept {
  double inertia = 1e9;  // the least of the three: stable about all axes
  for (int k = 0; k < 3; ++k) {
    const double one = is_free_root(model, body)
                           ? data.qM[model.dof_Madr[model.body_dofadr[body] + 3 + k]]
                           : model.body_inertia[3 * body + k];
    inertia = std::min(inertia, one);
  }
  return inertia;
}

ActiveSprings attach_springs(const mjModel_& model, const mjData_& data, int body,
                             const model::BodySprings& springs, double hands) noexcept {
  ActiveSprings out;
  out.body = body;
  out.present = !springs.all;
  const std::size_t whole = is_free_root(model, body) ? 6 : model::kFirstAngle;
  for (std::size_t k = 0; k < out.axes.size(); ++k) {
    const auto& spring = springs.axes[k];
    if (!spring && !(springs.all && k < whole)) continue;
    const bool line = k < model::kFirstAngle;
    out.axes[k] =
        attach_axis(spring.value_or(model::AxisSpring{}),
                    line ? mass_behind(model, body) : inertia_behind(model, data, body), hands);
    if (!line) continue;
    const double now = data.xipos[3 * body + static_cast<int>(k)];
    out.axes[k].anchor = spring && spring->at ? *spring->at : now;
  }
  if (springs.rope) {
    const model::Rope& rope = *springs.rope;
    const double critical = 2.0 * std::sqrt(rope.stiffness * mass_behind(model, body));
    out.rope = {true,        rope.to,        rope.from,
                rope.length, rope.stiffness, rope.damping.value_or(critical)};
  }
  out.orientation = anchored_orientation(data.xquat + 4 * body, springs);
  out.alike_turns = are_alike(out.axes[3], out.axes[4]) && are_alike(out.axes[3], out.axes[5]);
  return out;
}

void apply_springs(const mjModel_& model, mjData_& data, const ActiveSprings& springs) noexcept {
  std::array<double, 6> velocity{};  // rotation, then translation of the CoM; world
  mj_objectVelocity(&model, &data, mjOBJ_BODY, springs.body, velocity.data(), 0);
  double* force = data.xfrc_applied + 6 * springs.body;
  const double* x = data.xipos + 3 * springs.body;
  const double mass = mass_behind(model, springs.body);
  for (std::size_t k = 0; k < model::kFirstAngle; ++k) {
    const ActiveAxis& axis = springs.axes[k];
    if (axis.acts) force[k] += spring_force(axis, mass, axis.anchor - x[k], velocity[3 + k]);
  }
  if (springs.rope.acts) apply_rope(data, springs, velocity.data());
  const auto acts = [](const ActiveAxis& axis) { return axis.acts; };
  if (std::any_of(springs.axes.begin() + model::kFirstAngle, springs.axes.end(), acts)) {
    apply_turns(model, data, springs, velocity.data());
  }
}

}  // namespace footfall::sim
