// WBOSC as algebra over seeded moving states of Hume, both feet and one: each figure is the largest
// over all states of a difference divided by the largest acceleration (torque) involved.
//   task_acceleration  commanded against achieved by a dense solve of [Kim16] eq. (30), first level
//   dense_solve        reported against achieved by the dense solve, all levels
//   internal_force     joint accelerations with 100 N of tension against without
//   lower_priority     first level's accelerations after the second level asks for 100 rad/s² more
//   naive_torque       torque against Appendix A taken literally
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tests/support/dense_solve.h"
#include "tests/support/hume_problem.h"
#include "tests/support/naive_wbosc.h"

namespace footfall::tests {
namespace {

constexpr int kStatesOfEachStance = 1000;

struct Largest {
  double task = 0.0, dense = 0.0, internal = 0.0, lower = 0.0, naive = 0.0;
};

double relative(const Matrix& a, const Matrix& b, double scale) {
  return a.size() == 0 ? 0.0 : (a - b).max_abs() / std::max(scale, 1e-3);
}

class AlgebraCheck {
 public:
  void state(bool dual) {
    model_.update(random_state(robot_, random_));
    ProblemBuilder builder(model_, solver_.problem());
    if (dual) {
      fill_dual(builder, model_, random_, 50.0);
    } else {
      fill_single(builder, model_, random_);
    }
    const int first = solver_.problem().level_end[0];
    solver_.solve();
    const NaiveProblem p = dense_problem(model_, solver_.problem());
    const Matrix tau = torque();
    const Matrix qdd = accelerate(p, tau);
    const double scale = qdd.max_abs();
    const Matrix real = task_acceleration(p, qdd);
    const Matrix commanded = rows(solver_.problem().u);
    largest.task = std::max(largest.task, relative(real.head(first), commanded.head(first), scale));
    largest.dense =
        std::max(largest.dense, relative(real, rows(solver_.solution().achieved), scale));
    const Matrix naive = naive_wbosc(p).tau;
    largest.naive = std::max(largest.naive, relative(tau, naive, naive.max_abs()));
    if (!dual) return;
    solver_.problem().F_int[0] += 100.0;
    solver_.solve();
    largest.internal = std::max(largest.internal, relative(accelerate(p, torque()), qdd, scale));
    for (int i = first; i < solver_.problem().task_rows; ++i) {
      solver_.problem().u[static_cast<std::size_t>(i)] += 100.0;
    }
    solver_.solve();
    const Matrix pushed = accelerate(p, torque());
    largest.lower = std::max(largest.lower, relative(task_acceleration(p, pushed).head(first),
                                                     commanded.head(first), pushed.max_abs()));
  }

  Largest largest;

 private:
  Matrix torque() const { return Matrix::vector(solver_.solution().tau.data(), 6); }
  Matrix rows(const std::vector<double>& v) {
    return Matrix::vector(v.data(), solver_.problem().task_rows);
  }
  static Matrix accelerate(const NaiveProblem& p, const Matrix& tau) {
    return dense_solve(p, tau).qdd;
  }
  Matrix task_acceleration(const NaiveProblem& p, const Matrix& qdd) {
    Matrix a(solver_.problem().task_rows);
    int row = 0;
    for (const NaiveLevel& level : p.levels) {
      a.set_block(row, 0, level.J * qdd + level.J_bias);
      row += level.J.rows();
    }
    return a;
  }

  model::RobotDescription robot_ = load_hume();
  model::ControlModel model_{robot_};
  tasks::Wbosc solver_{hume_sizes()};
  Random random_{20160101};
};

}  // namespace
}  // namespace footfall::tests

int main() {
  using namespace footfall::tests;
  AlgebraCheck check;
  for (int i = 0; i < 2 * kStatesOfEachStance; ++i) check.state(i % 2 == 0);
  const nlohmann::ordered_json result = {
      {"states", kStatesOfEachStance},         {"task_acceleration", check.largest.task},
      {"dense_solve", check.largest.dense},    {"internal_force", check.largest.internal},
      {"lower_priority", check.largest.lower}, {"naive_torque", check.largest.naive}};
  std::printf("%s\n", result.dump(2).c_str());
  return 0;
}
