// WBOSC solves on seeded moving states of Hume, beside Appendix A taken literally.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "tests/support/hume_problem.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {

inline constexpr int kProblems = 16;

// The algebra alone, on states of its own.
struct Algebra {
  struct Case {
    std::unique_ptr<model::ControlModel> model;
    std::unique_ptr<tasks::Wbosc> solver;
    std::unique_ptr<ProblemBuilder> builder;
    NaiveProblem naive;
  };
  std::vector<Case> cases;
  double torque_difference = 0.0;

  explicit Algebra(bool dual) {
    const model::RobotDescription robot = load_hume();
    Random random(7);
    for (int i = 0; i < kProblems; ++i) {
      Case c;
      c.model = std::make_unique<model::ControlModel>(robot);
      c.model->update(random_state(robot, random));
      c.solver = std::make_unique<tasks::Wbosc>(hume_sizes());
      c.builder = std::make_unique<ProblemBuilder>(*c.model, c.solver->problem());
      if (dual) {
        fill_dual(*c.builder, *c.model, random, 50.0);
      } else {
        fill_single(*c.builder, *c.model, random);
      }
      c.naive = dense_problem(*c.model, c.solver->problem());
      c.solver->solve();
      const Matrix expected = naive_wbosc(c.naive).tau;
      const Matrix tau = Matrix::vector(c.solver->solution().tau.data(), 6);
      torque_difference =
          std::max(torque_difference, (tau - expected).max_abs() / expected.max_abs());
      cases.push_back(std::move(c));
    }
  }
};

}  // namespace footfall::tests
