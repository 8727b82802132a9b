// The whole-body controller of Hume in a random state, for its tests.
#pragma once

#include <gtest/gtest.h>

#include <array>

#include "tasks/whole_body_controller.h"
#include "tests/support/dense_solve.h"
#include "tests/support/hume_control.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {

using tasks::ActiveControl;
using tasks::ControlSet;

class Controller : public testing::Test {
 protected:
  void SetUp() override {
    model_.update(random_state(robot_, random_));
    fill_dual_set(dual_);
    fill_single_set(single_, model_.point(kLeftFoot).position);
  }
  Matrix torque_of(const ControlSet& set) {
    control_.primary = set;
    control_.has_other = false;
    compute(control_);
    return tau();
  }
  void compute(const ActiveControl& control) {
    const std::array<double, 6> measured{};
    controller_.compute(control, tick_++, measured.data(), tau_.data());
  }
  Matrix tau() const { return Matrix::vector(tau_.data(), 6); }
  // As the controller should have assembled the single-support law.
  NaiveProblem single_problem(const std::vector<double>& u) {
    tasks::Wbosc solver(hume_sizes());
    ProblemBuilder b(model_, solver.problem());
    b.contact(kRightFoot);
    b.row(model_.com(), {0.0, 0.0, 1.0}, u[0]);
    b.row(model_.base_rotation(), b.heading(1), u[1]);
    b.row(model_.base_rotation(), b.heading(0), u[2]);
    for (std::size_t k = 0; k < 3; ++k) {
      std::array<double, 3> axis{};
      axis[k] = 1.0;
      b.row(model_.point(kLeftFoot), axis, u[3 + k]);
    }
    b.end_level();
    return dense_problem(model_, solver.problem());
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::WholeBodyController controller_{model_, {}, {4, 16, 2, 2}, 1.0 / 1500.0};
  std::array<double, 6> tau_{};
  Random random_{11};
  ControlSet dual_, single_;
  ActiveControl control_;
  std::int64_t tick_ = 0;
};

}  // namespace footfall::tests
