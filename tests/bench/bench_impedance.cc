// The largest stable stiffness of behavior leg_impedance by the sampled model (docs/impedance.md):
// masses, Jacobians and gains as its own loop has them once the leg is still, and of the world the
// drives and aids. Prints {"cases": [{"law", "delay_ticks", "p", "d": {JOINT}, "kd", "kp"}]}; with
// arguments BEHAVIOR WORLD of another pair of files.
#include <mujoco/mujoco.h>

#include <Eigen/Cholesky>
#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <nlohmann/json.hpp>

#include "core/index.h"
#include "sim/world/actuators.h"
#include "tasks/task_law.h"
#include "tests/support/rig.h"
#include "tests/support/sampled_impedance.h"

namespace footfall {
namespace {

using Eigen::MatrixXd;
using Json = nlohmann::ordered_json;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr double kMost = 1e5;                                          // 1/s^2, of kp
constexpr double kFixedDamping = 10.0;                                 // N m s/rad
constexpr double kScheduledDamping = 1.4;                              // times sqrt((1 + P) k J)
constexpr std::array kTorqueGains = {0.5, 1.0, 2.0, 5.0, 10.0, 20.0};  // P of the torque loops
constexpr std::array kDelays = {1, 2};                                 // ticks
constexpr const char* kState = "spring";      // in which the stiffness is under test
constexpr const char* kTask = "height";       // whose stiffness it is
constexpr const char* kLegJoints = "right_";  // whose torque loops change

// d of the torque loops, and damping of the task, 1/s.
struct Variant {
  const char* name;
  bool scheduled;
  double kd;
};
constexpr std::array<Variant, 3> kVariants = {
    {{"fixed", false, 0.0}, {"scheduled", true, 0.0}, {"scheduled_and_task", true, 8.0}}};

struct Leg {
  tests::SampledPlant plant;
  tests::SampledLaw law;
  int row = 0;              // of the task under test
  std::vector<int> joints;  // whose torque loops are under test
};

// Behavior and world until the leg is still.
void settle(engine::ControlLoop& loop) {
  loop.start();
  const auto in_test = [&] {
    const int active = loop.machine().active_atomic().front();
    return loop.behavior().states[at(active)].name == kState;
  };
  while (!in_test()) {
    if (loop.tick() != engine::LoopState::running || loop.time() > 60.0) {
      throw std::runtime_error("the behavior did not reach its state 'spring'");
    }
  }
}

// External aids on the floating base, about its origin: a spring on the body's CoM at r acts with
// K = [I; [r]x]^T k [I; [r]x]. Velocities of the base: linear in world axes, angular in its own;
// here the two agree, the torso being upright.
void hang(const sim::WorldDescription& world, sim::MujocoBackend& backend,
          tests::SampledPlant& plant) {
  const mjModel* m = backend.model();
  for (const model::BodySprings& aid : world.constraints) {
    const int body = backend.find_body(aid.body.name);
    const double* r = m->body_ipos + 3 * body;
    Eigen::Matrix<double, 6, 6> rows = Eigen::Matrix<double, 6, 6>::Identity();
    rows.topRightCorner<3, 3>() << 0.0, r[2], -r[1], -r[2], 0.0, r[0], r[1], -r[0], 0.0;
    for (int k = 0; k < 6; ++k) {
      const auto& spring = aid.axes[at(k)];
      if (!spring) continue;
      const Eigen::Matrix<double, 6, 6> square = rows.row(k).transpose() * rows.row(k);
      plant.stiffness.topLeftCorner<6, 6>() += spring->stiffness.value() * square;
      plant.damping.topLeftCorner<6, 6>() += spring->damping.value() * square;
    }
  }
}

// Rows and gains of the law in force. Contacts: none; then τ = (J A⁻¹ Uᵀ)⁻¹ u where every level has
// its rank: each takes account of those before, so that levels do not matter.
void read_law(const engine::ControlLoop& loop, Leg& leg) {
  const tasks::ControlSet& set = loop.machine().control().primary;
  const model::ControlModel& model = loop.model();
  const int n = model.nv(), m = model.joint_count(), rows = set.axis_count;
  if (rows != m || set.contact_count != 0) throw std::runtime_error("expected a row a joint");
  RowMatrix jacobian(rows, n);
  std::vector<double> bias(extent(rows));
  std::vector<tasks::AxisEvaluation> out(extent(rows));
  leg.law.kp.resize(rows);
  leg.law.ki.resize(rows);
  leg.law.kd.resize(rows);
  const tasks::LawContext context = {&model, nullptr, 0, loop.period(), set.contacts.data(), 0};
  int row = 0;
  for (int t = 0; t < set.task_count; ++t) {
    const tasks::TaskCommand& task = set.tasks[at(t)];
    const tasks::AxisCommand* axes = set.axes.data() + task.first_axis;
    tasks::task_rows(task, axes, context, jacobian.data() + row * n, bias.data(), out.data());
    if (loop.behavior().task_instances[at(task.instance)].name == kTask) leg.row = row;
    for (int i = 0; i < task.axis_count; ++i, ++row) {
      leg.law.kp[row] = axes[i].kp;
      leg.law.ki[row] = axes[i].ki;
      leg.law.kd[row] = axes[i].kd;
    }
  }
  leg.law.rows = jacobian;
  const MatrixXd free = leg.plant.inertia.llt().solve(MatrixXd::Identity(n, n)).rightCols(m);
  leg.law.torque = (leg.law.rows * free).inverse();
}

Leg read_leg(tests::Rig& rig) {
  Leg leg;
  engine::ControlLoop& loop = *rig.loop;
  settle(loop);
  const int n = loop.model().nv();
  RowMatrix inertia(n, n);
  loop.model().mass_matrix(inertia.data());
  leg.plant.inertia = inertia;
  leg.plant.stiffness = leg.plant.damping = MatrixXd::Zero(n, n);
  hang(rig.world, *rig.backend, leg.plant);
  const model::RobotDescription& robot = rig.behavior->robot;
  const int physics_steps = rig.world.physics.steps_per_tick;
  leg.plant.drive = sim::drive_settings(rig.world.actuators, robot, physics_steps);
  leg.plant.steps_per_period = leg.plant.drive.steps * physics_steps;
  for (int j = 0; j < loop.model().joint_count(); ++j) {
    leg.plant.drive.joints[at(j)].gains = rig.backend->drive()->gains(j);
    if (robot.joints[at(j)].name.starts_with(kLegJoints)) leg.joints.push_back(j);
  }
  read_law(loop, leg);
  return leg;
}

// d of a joint's torque loop.
double damping_of(const Variant& variant, double p, const hal::SeriesElasticParameters& actuator) {
  if (!variant.scheduled) return kFixedDamping;
  return kScheduledDamping * std::sqrt((1.0 + p) * actuator.spring * actuator.rotor);
}

Json solve(const Leg& leg, const model::RobotDescription& robot, const Variant& variant, double p,
           int delay_ticks) {
  tests::SampledPlant plant = leg.plant;
  tests::SampledLaw law = leg.law;
  plant.drive.command_delay = delay_ticks * plant.steps_per_period;
  law.kd[leg.row] = variant.kd;
  Json dampings;
  for (const int j : leg.joints) {
    hal::DriveJoint& joint = plant.drive.joints[at(j)];
    joint.gains.p = p;
    joint.gains.damping = damping_of(variant, p, joint.actuator);
    dampings[robot.joints[at(j)].name] = joint.gains.damping;
  }
  return {{"law", variant.name},
          {"delay_ticks", delay_ticks},
          {"p", p},
          {"d", dampings},
          {"kd", variant.kd},
          {"kp", tests::largest_stable_kp(plant, law, leg.row, kMost)}};
}

int run(const std::string& behavior, const std::string& world_name) {
  core::Diagnostics diagnostics;
  const sim::WorldDescription world = sim::load_world(
      sim::find_world_file(world_name, {FOOTFALL_SOURCE_DIR}), diagnostics, {FOOTFALL_SOURCE_DIR});
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
  tests::Rig rig(behavior, world);
  const Leg leg = read_leg(rig);
  Json cases = Json::array();
  for (const Variant& variant : kVariants) {
    for (const int delay : kDelays) {
      for (const double p : kTorqueGains) {
        cases.push_back(solve(leg, rig.behavior->robot, variant, p, delay));
      }
    }
  }
  std::printf("%s\n", Json{{"cases", cases}}.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) try {
  return footfall::run(argc > 1 ? argv[1] : "leg_impedance", argc > 2 ? argv[2] : "hoist");
} catch (const std::exception& problem) {
  std::fprintf(stderr, "error: %s\n", problem.what());
  return 1;
}
