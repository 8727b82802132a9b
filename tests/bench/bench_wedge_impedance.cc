// Hume on two wedges: stiffness of its centre of mass against a steady force, along x and along z,
// and what [Kim16] VI-B expects of it: K / (J A⁻¹ N_sᵀ Jᵀ), N_s with the feet's rows and the
// planarizer's two. The planarizer is known to the controller or not. Prints {"cases": [{"axis",
// "known", "expected", "measured"}]}, N/m.
#include <mujoco/mujoco.h>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "core/index.h"
#include "tests/support/rig.h"

namespace footfall {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kPush = 10.0;    // N
constexpr double kSettled = 5.0;  // s
constexpr double kHeld = 2.0;     // s, of the force

sim::WorldDescription world_of(bool known) {
  core::Diagnostics diagnostics;
  const std::string path = std::string(FOOTFALL_SOURCE_DIR) + "/sim/worlds/wedges.yaml";
  auto world = sim::load_world(path, diagnostics, {FOOTFALL_SOURCE_DIR},
                               {{"constraints.planarizer.known", known ? "true" : "false"}});
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
  return world;
}

// kp / (J A⁻¹ N_sᵀ Jᵀ) of the CoM along an axis. `truth`: the robot's model with the planarizer's
// rows, in the state of the loop.
double expected_stiffness(const engine::ControlLoop& loop, model::ControlModel& truth, int axis) {
  truth.update(loop.model().state());
  const int n = truth.nv(), contacts = truth.contact_count(), held = truth.held_count();
  RowMatrix A(n, n), Js(3 * contacts + held, n);
  truth.mass_matrix(A.data());
  for (int c = 0; c < contacts; ++c) {
    Js.middleRows(3 * c, 3) = Eigen::Map<const RowMatrix>(truth.point(c).jacobian.data(), 3, n);
  }
  for (int i = 0; i < held; ++i) {
    Js.row(3 * contacts + i) = Eigen::Map<const Eigen::RowVectorXd>(truth.held_jacobian(i), n);
  }
  const VectorXd J = Eigen::Map<const VectorXd>(truth.com().jacobian.data() + axis * n, n);
  const MatrixXd Ainv_JsT = A.llt().solve(Js.transpose());
  const VectorXd Ainv_J = A.llt().solve(J);
  const VectorXd constrained =
      Ainv_J - Ainv_JsT * (Js * Ainv_JsT).llt().solve(Ainv_JsT.transpose() * J);
  const tasks::ControlSet& set = loop.machine().control().primary;
  for (int i = 0; i < set.tasks[0].axis_count; ++i) {
    const tasks::AxisCommand& command = set.axes[at(set.tasks[0].first_axis + i)];
    if (command.axis == axis) return command.kp / J.dot(constrained);
  }
  throw std::runtime_error("the first task is not the CoM's along this axis");
}

// Mean position of the CoM along an axis over the next 0.2 s.
double settled_place(engine::ControlLoop& loop, int axis) {
  constexpr int kTicks = 300;
  double sum = 0.0;
  for (int k = 0; k < kTicks; ++k) {
    if (loop.tick() != engine::LoopState::running) throw std::runtime_error("it did not stand");
    sum += loop.model().com().position[at(axis)];
  }
  return sum / kTicks;
}

// A force on the whole robot's centre of mass: on each body by its part of the mass.
void push_all(sim::MujocoBackend& backend, double elevation) {
  const mjModel* m = backend.model();
  double mass = 0.0;
  for (int b = 1; b < m->nbody; ++b) mass += m->body_mass[b];
  for (int b = 1; b < m->nbody; ++b) {
    if (m->body_mass[b] <= 0.0) continue;
    const double part = kPush * m->body_mass[b] / mass;
    if (!backend.push(b, part, 0.0, kHeld + 1.0, elevation)) throw std::runtime_error("no push");
  }
}

nlohmann::ordered_json measure(int axis, bool known) {
  tests::Rig rig("wedges_compliant", world_of(known));
  model::ControlModel truth(rig.behavior->robot, world_of(true).control_model);
  engine::ControlLoop& loop = *rig.loop;
  loop.start();
  while (loop.time() < kSettled) loop.tick();
  const double before = settled_place(loop, axis);
  const double expected = expected_stiffness(loop, truth, axis);
  push_all(*rig.backend, axis == 0 ? 0.0 : -0.5 * M_PI);
  const double begin = loop.time();
  while (loop.time() < begin + kHeld) loop.tick();
  const double along = axis == 0 ? 1.0 : -1.0;  // the push
  const double moved = along * (settled_place(loop, axis) - before);
  return {{"axis", axis == 0 ? "x" : "z"},
          {"known", known},
          {"expected", expected},
          {"measured", kPush / moved},
          {"moved_mm", 1e3 * moved}};
}

int run() {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const bool known : {true, false}) {
    for (const int axis : {0, 2}) cases.push_back(measure(axis, known));
  }
  std::printf("%s\n", nlohmann::ordered_json{{"cases", cases}}.dump(2).c_str());
  return 0;
}

}  // namespace
}  // namespace footfall

int main() {
  try {
    return footfall::run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_wedge_impedance: %s\n", error.what());
    return 4;
  }
}
