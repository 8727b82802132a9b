// WBOSC problems of Hume in the two stances of [Kim16] Table I, filled by hand from the model.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tasks/solver/wbosc.h"
#include "tests/support/hume.h"

namespace footfall::tests {

inline constexpr int kRightFoot = 0;
inline constexpr int kLeftFoot = 1;

// Adds contacts, task rows and internal forces one after the other.
class ProblemBuilder {
 public:
  ProblemBuilder(const model::ControlModel& model, tasks::WboscProblem& problem)
      : model_(model), p_(problem), n_(model.nv()) {
    for (int j = 0; j < model.joint_count(); ++j) actuated_.push_back(6 + j);
    p_.factor = model.factor();
    p_.bias = model.bias().data();
    p_.actuated = actuated_.data();
    p_.torque_limit = nullptr;
    p_.tau_measured = nullptr;
    p_.contact_rows = p_.task_rows = p_.levels = p_.internal_rows = p_.named_internal_rows = 0;
    std::fill(p_.external.begin(), p_.external.end(), 0.0);
    std::fill(p_.weight.begin(), p_.weight.end(), 1.0);
  }
  ProblemBuilder(const ProblemBuilder&) = delete;
  ProblemBuilder& operator=(const ProblemBuilder&) = delete;

  void contact(int point) {
    const model::Kinematics3& k = model_.point(point);
    std::copy_n(k.jacobian.data(), 3 * n_, p_.Js.data() + p_.contact_rows * n_);
    std::copy_n(k.bias.data(), 3, p_.Js_bias.data() + p_.contact_rows);
    p_.contact_rows += 3;
  }
  // One row: direction (world axes) of a 3-row Jacobian.
  void row(const model::Kinematics3& k, const std::array<double, 3>& axis, double u) {
    double* J = p_.J.data() + p_.task_rows * n_;
    for (int q = 0; q < n_; ++q) {
      J[q] = 0.0;
      for (int i = 0; i < 3; ++i) {
        J[q] +=
            axis[static_cast<std::size_t>(i)] * k.jacobian[static_cast<std::size_t>(i * n_ + q)];
      }
    }
    const std::size_t r = static_cast<std::size_t>(p_.task_rows++);
    p_.J_bias[r] = axis[0] * k.bias[0] + axis[1] * k.bias[1] + axis[2] * k.bias[2];
    p_.u[r] = u;
  }
  void joint_row(int joint, double u) {
    double* J = p_.J.data() + p_.task_rows * n_;
    std::fill_n(J, n_, 0.0);
    J[6 + joint] = 1.0;
    const std::size_t r = static_cast<std::size_t>(p_.task_rows++);
    p_.J_bias[r] = 0.0;
    p_.u[r] = u;
  }
  void end_level() { p_.level_end[static_cast<std::size_t>(p_.levels++)] = p_.task_rows; }
  // Mean tension of two contacts at places a, b of the set, positive apart; acts on the ground's
  // force.
  void tension(int a, int point_a, int b, int point_b, double wanted) {
    const auto& pa = model_.point(point_a).position;
    const auto& pb = model_.point(point_b).position;
    const double length = std::hypot(pa[0] - pb[0], pa[1] - pb[1], pa[2] - pb[2]);
    double* w = p_.W_int.data() + p_.internal_rows * p_.contact_rows;
    std::fill_n(w, p_.contact_rows, 0.0);
    for (std::size_t k = 0; k < 3; ++k) {
      w[3 * static_cast<std::size_t>(a) + k] = -0.5 * (pa[k] - pb[k]) / length;
      w[3 * static_cast<std::size_t>(b) + k] = 0.5 * (pa[k] - pb[k]) / length;
    }
    p_.F_int[static_cast<std::size_t>(p_.internal_rows)] = wanted;
    p_.F_before[static_cast<std::size_t>(p_.internal_rows)] = wanted;
    p_.K_F[static_cast<std::size_t>(p_.internal_rows)] = 0.0;
    p_.named_internal_rows = ++p_.internal_rows;
  }

  std::array<double, 3> heading(int axis) const {
    const double yaw = model_.rpy()[2];
    if (axis == 0) return {std::cos(yaw), std::sin(yaw), 0.0};
    if (axis == 1) return {-std::sin(yaw), std::cos(yaw), 0.0};
    return {0.0, 0.0, 1.0};
  }

 private:
  const model::ControlModel& model_;
  tasks::WboscProblem& p_;
  int n_;
  std::vector<int> actuated_;
};

inline tasks::WboscSizes hume_sizes(int task_rows = 16) { return {12, 6, 6, task_rows, 4, 2}; }

// Both feet: CoM height, yaw, pitch, roll; then all joints; tension between the feet.
inline void fill_dual(ProblemBuilder& b, const model::ControlModel& m, Random& random,
                      double tension) {
  b.contact(kRightFoot);
  b.contact(kLeftFoot);
  b.row(m.com(), {0.0, 0.0, 1.0}, random.within(5.0));
  for (int axis = 2; axis >= 0; --axis)
    b.row(m.base_rotation(), b.heading(axis), random.within(5.0));
  b.end_level();
  for (int j = 0; j < m.joint_count(); ++j) b.joint_row(j, random.within(5.0));
  b.end_level();
  b.tension(0, kRightFoot, 1, kLeftFoot, tension);
}

// Right foot: CoM height, pitch, roll, the left foot in space.
inline void fill_single(ProblemBuilder& b, const model::ControlModel& m, Random& random) {
  b.contact(kRightFoot);
  b.row(m.com(), {0.0, 0.0, 1.0}, random.within(5.0));
  b.row(m.base_rotation(), b.heading(1), random.within(5.0));
  b.row(m.base_rotation(), b.heading(0), random.within(5.0));
  for (int axis = 0; axis < 3; ++axis) {
    std::array<double, 3> direction{};
    direction[static_cast<std::size_t>(axis)] = 1.0;
    b.row(m.point(kLeftFoot), direction, random.within(5.0));
  }
  b.end_level();
}

}  // namespace footfall::tests
