// Moves Hume so that a task's rows get exactly the acceleration that its law asks for: the closed
// loop without contacts and torques. Shared by the tests of the task laws.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "tasks/task_law.h"
#include "tests/support/hume.h"
#include "tests/support/matrix.h"

namespace footfall::tests {

using tasks::AxisCommand;
using tasks::AxisEvaluation;
using tasks::TaskCommand;
using tasks::TaskType;

constexpr std::array<double, 3> kX = {1.0, 0.0, 0.0}, kY = {0.0, 1.0, 0.0}, kZ = {0.0, 0.0, 1.0};
constexpr double kPeriod = 1e-3;
constexpr double kIntegrationStep = 1e-4;  // s, of error_after

struct Law {
  Matrix J;
  Matrix bias;
  std::vector<AxisEvaluation> axes;
};

class TaskLaw : public testing::Test {
 protected:
  explicit TaskLaw(const model::RobotDescription& robot = load_hume()) : robot_(robot) {}
  Law evaluate(const TaskCommand& task, const std::vector<AxisCommand>& axes, std::int64_t tick = 0,
               const std::vector<int>& stance = {}) {
    TaskCommand t = task;
    t.axis_count = static_cast<int>(axes.size());
    Law law = {{}, Matrix(t.axis_count), {}};
    law.axes.resize(axes.size());
    std::vector<double> J(axes.size() * 12);
    const tasks::LawContext context = {&model_, &memory_,      tick,
                                       period_, stance.data(), static_cast<int>(stance.size())};
    tasks::evaluate_task(t, axes.data(), context, J.data(), law.bias.data(), law.axes.data());
    law.J = Matrix::of_rows(J.data(), t.axis_count, 12);
    return law;
  }
  static TaskCommand task(TaskType type, int point = -1) {
    TaskCommand t;
    t.type = type;
    t.point = point;
    return t;
  }
  // Base rotated about world z by yaw, then by `angle` about a unit axis of the heading frame.
  model::State turned(double yaw, const std::array<double, 3>& axis, double angle) const {
    model::State s = standing_state(robot_);
    const double cz = std::cos(yaw / 2), sz = std::sin(yaw / 2);
    const double c = std::cos(angle / 2), n = std::sin(angle / 2);
    const double x = n * axis[0], y = n * axis[1], z = n * axis[2];
    s.q_WB = {cz * c - sz * z, cz * x - sz * y, cz * y + sz * x, cz * z + sz * c};
    return s;
  }
  // What the reference does in the course of time, given the model's present state.
  using Adjust = std::function<void(std::vector<AxisCommand>&)>;

  // The errors of the task after `duration`. The exact law is ë + kd ė + kp e = 0. Velocities by
  // Euler steps, places by their mean: of second order where u does not depend on the velocity's
  // own history, else the error of a rate is at most h/2 t max|ë'|.
  Matrix error_after(const TaskCommand& task, std::vector<AxisCommand> axes, model::State state,
                     double duration, const std::vector<int>& stance = {},
                     const Adjust& adjust = nullptr) {
    constexpr double h = kIntegrationStep;
    for (int i = 0; i < static_cast<int>(duration / h + 0.5); ++i) {
      model_.update(state);
      if (adjust) adjust(axes);
      const Law law = evaluate(task, axes, i, stance);
      Matrix u(law.bias.size());
      for (int k = 0; k < u.size(); ++k) u(k) = law.axes[static_cast<std::size_t>(k)].commanded;
      const Matrix a = pseudo_inverse(law.J) * (u - law.bias);
      model::State middle = state;
      for (std::size_t k = 0; k < 6; ++k) {
        const double dv = h * a(static_cast<int>(k));
        (k < 3 ? middle.v_WB[k] : middle.w_WB_B[k - 3]) += 0.5 * dv;
        (k < 3 ? state.v_WB[k] : state.w_WB_B[k - 3]) += dv;
      }
      for (std::size_t k = 0; k < 6; ++k) {
        const double dv = h * a(static_cast<int>(6 + k));
        middle.qd[k] += 0.5 * dv;
        state.qd[k] += dv;
      }
      const model::State place = integrated(middle, h, 6);
      state.p_WB = place.p_WB;
      state.q_WB = place.q_WB;
      state.q = place.q;
    }
    model_.update(state);
    if (adjust) adjust(axes);
    const Law law = evaluate(task, axes, 1 << 20, stance);
    Matrix e(law.bias.size());
    for (int k = 0; k < e.size(); ++k) e(k) = law.axes[static_cast<std::size_t>(k)].error;
    return e;
  }

  model::RobotDescription robot_;
  model::ControlModel model_{robot_};
  tasks::TaskMemory memory_{4, 6};
  double period_ = kPeriod;  // of the integrals
  Random random_{5};
};

// kp = 100, kd = 20: critically damped, e(t) = e0 (1 + 10 t) exp(-10 t) from rest.
inline double critically_damped(double t) { return (1.0 + 10.0 * t) * std::exp(-10.0 * t); }
constexpr double kDuration = 0.2;
constexpr double kStep = 1e-3;  // of the start error: second-order integration, and bias of O(e²)

}  // namespace footfall::tests
