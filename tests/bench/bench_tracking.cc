// Commanded minus achieved task acceleration in MuJoCo: in every single-support tick later than
// 10 ms after lift-off, the simulator's own q̈ at the tick's state and torque, through the control
// model's Jacobians. Prints {"max_error", "steps", "ticks", "by_task"}.
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "lab/figures/step_counter.h"
#include "tests/support/rig.h"

namespace footfall {
namespace {

constexpr int kSteps = 50;
constexpr double kSkip = 0.010;  // s after the state's entry

// J q̈ + J̇q̇ of one axis with the simulator's acceleration.
double achieved(const model::ControlModel& m, const tasks::TaskCommand& task, int axis,
                const double* qacc) {
  const auto dot = [&](const double* row) {
    double sum = 0.0;
    for (int i = 0; i < m.nv(); ++i) sum += row[i] * qacc[i];
    return sum;
  };
  const auto at = [](int i) { return static_cast<std::size_t>(i); };
  if (task.type == tasks::TaskType::com_position || task.type == tasks::TaskType::point_position) {
    const model::Kinematics3& k =
        task.type == tasks::TaskType::com_position ? m.com() : m.point(task.point);
    return dot(k.jacobian.data() + axis * m.nv()) + k.bias[at(axis)];
  }
  const model::Kinematics3& k = m.base_rotation();
  const double c = std::cos(m.rpy()[2]), s = std::sin(m.rpy()[2]);
  std::array<double, 3> a{};
  for (int r = 0; r < 3; ++r) a[at(r)] = dot(k.jacobian.data() + r * m.nv()) + k.bias[at(r)];
  const std::array<double, 3> heading = {c * a[0] + s * a[1], -s * a[0] + c * a[1], a[2]};
  return heading[at(axis)];
}

int run(const char* behavior_name) {
  tests::Rig rig(behavior_name);
  engine::ControlLoop& loop = *rig.loop;
  mjData* scratch = mj_makeData(rig.backend->model());
  lab::StepCounter steps(2, loop.period());
  std::map<std::string, double> worst;
  double max_error = 0.0;
  std::int64_t ticks = 0;
  int previous = -1;
  double entered = 0.0;
  loop.start();
  while (steps.steps() < kSteps && loop.state() == engine::LoopState::running &&
         loop.time() < 60.0) {
    loop.sense();
    loop.compute();
    std::array<double, 2> heights = {loop.model().point(0).position[2],
                                     loop.model().point(1).position[2]};
    steps.observe(loop.time(), loop.sensors().contact.data(), heights.data());
    const int active = loop.machine().active_atomic().front();
    if (active != previous) entered = loop.time();
    previous = active;
    const bool lifting = loop.behavior().states[static_cast<std::size_t>(active)].name == "lift";
    if (lifting && loop.time() - entered >= kSkip && !loop.controller().result().limited) {
      mj_copyData(scratch, rig.backend->model(), rig.backend->data());
      for (int j = 0; j < 6; ++j)
        scratch->ctrl[j] = loop.commands().tau[static_cast<std::size_t>(j)];
      mj_forward(rig.backend->model(), scratch);
      const tasks::ControlSet& set = loop.machine().control().primary;
      for (int t = 0; t < set.task_count; ++t) {
        const tasks::TaskCommand& task = set.tasks[static_cast<std::size_t>(t)];
        if (task.type == tasks::TaskType::joint_damping ||
            task.type == tasks::TaskType::joint_posture)
          continue;
        for (int i = 0; i < task.axis_count; ++i) {
          const auto row = static_cast<std::size_t>(task.first_axis + i);
          const double error =
              std::abs(loop.controller().result().axes[row].commanded -
                       achieved(loop.model(), task, set.axes[row].axis, scratch->qacc));
          double& of_task =
              worst[loop.behavior().task_instances[static_cast<std::size_t>(task.instance)].name];
          of_task = std::max(of_task, error);
          max_error = std::max(max_error, error);
        }
      }
      ++ticks;
    }
    loop.actuate();
  }
  mj_deleteData(scratch);
  nlohmann::ordered_json out = {
      {"max_error", max_error}, {"steps", steps.steps()}, {"ticks", ticks}, {"by_task", worst}};
  std::printf("%s\n", out.dump().c_str());
  return steps.steps() >= kSteps ? 0 : 1;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) { return footfall::run(argc > 1 ? argv[1] : "balance"); }
