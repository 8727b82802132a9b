// Columns of a log's rows; see step_signals.h.
#include "lab/steps/step_signals.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"

namespace footfall::lab {
namespace {

using StepValues = const std::vector<float>*;

// A task is of that foot if what it measures is where the foot is: the same number, rounded to a
// float.
constexpr double kSamePlace = 1e-4;  // m

double step_value(StepValues column, std::size_t row, double otherwise = kAbsent) {
  return column == nullptr ? otherwise : static_cast<double>((*column)[row]);
}

template <std::size_t N>
std::array<StepValues, N> columns_of(const Log& log, const std::string& stem,
                                     const std::array<const char*, N>& axes) {
  std::array<StepValues, N> out{};
  for (std::size_t k = 0; k < N; ++k) out[k] = log.values(stem + axes[k]);
  return out;
}

constexpr std::array<const char*, 2> kXy = {"x", "y"};
constexpr std::array<const char*, 3> kXyz = {"x", "y", "z"};

// R = Rz Ry Rx as a quaternion w x y z.
std::array<double, 4> quaternion_of_rpy(const std::array<double, 3>& rpy) {
  const auto half = [&](std::size_t k) {
    return std::array{std::cos(rpy[k] / 2), std::sin(rpy[k] / 2)};
  };
  const auto [cr, sr] = half(0);
  const auto [cp, sp] = half(1);
  const auto [cy, sy] = half(2);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

}  // namespace

StepSignals::StepSignals(const Log& log, const model::RobotDescription& robot) {
  const nlohmann::json types = core::parse_json(log.get("tasks", "{}"));
  for (const auto& [task, type] : types.items()) {
    const std::string stem = "task." + task;
    if (type == "point_position") {
      tasks_.push_back(
          {columns_of(log, stem + ".reference.", kXy), columns_of(log, stem + ".measured.", kXy)});
    } else if (type == "body_orientation") {
      attitudes_.push_back(columns_of(log, stem + ".reference.", std::array{"roll", "pitch"}));
    }
  }
  for (const auto& contact : robot.contacts) {
    feet_.push_back(columns_of(log, "point." + contact.name + ".", kXy));
  }
  for (const auto& joint : robot.joints) {
    joints_.push_back(
        columns_of(log, "joint." + joint.name + ".", std::array{"position", "velocity"}));
  }
  const std::vector<std::string> planners = parts(log, "planner.", ".target.x");
  if (!planners.empty()) {
    const std::string stem = "planner." + planners.front() + ".";
    target_ = columns_of(log, stem + "target.", kXy);
    predicted_ = columns_of(log, stem + "predicted_vel.", kXy);
    switch_time_ = log.values(stem + "switch_time");
    extension_ = log.values(stem + "extension");
  }
  position_ = columns_of(log, "base.pos.", kXyz);
  velocity_ = columns_of(log, "base.vel.", kXyz);
  rpy_ = columns_of(log, "base.rpy.", std::array{"roll", "pitch", "yaw"});
  angular_ = columns_of(log, "base.angvel.", kXyz);
}

void StepSignals::foot(std::size_t row, std::size_t contact, StepSample::Foot& foot) const {
  for (std::size_t k = 0; k < 2; ++k) {
    const double place = step_value(feet_[contact][k], row);
    for (const PointTask& task : tasks_) {
      const double measured = step_value(task.measured[k], row);
      if (!(std::abs(measured - place) < kSamePlace)) continue;
      foot.measured[k] = measured;
      foot.reference[k] = step_value(task.reference[k], row);
    }
  }
}

void StepSignals::plan(std::size_t row, StepSample& out) const {
  for (std::size_t c = 0; c < feet_.size(); ++c) foot(row, c, out.foot[c]);
  out.plan.yaw = step_value(rpy_[2], row, 0.0);
  // Before its first answer all that a planner says is 0.
  const double switch_time = step_value(switch_time_, row);
  if (!(switch_time > 0.0)) return;
  for (std::size_t k = 0; k < 2; ++k) {
    out.plan.target[k] = step_value(target_[k], row);
    out.plan.predicted_vel[k] = step_value(predicted_[k], row);
  }
  out.plan.extension = step_value(extension_, row, 0.0);
  out.plan.landing = switch_time + out.plan.extension;
}

std::array<double, 2> StepSignals::attitude(std::size_t row) const {
  std::array<double, 2> out{};
  for (const auto& task : attitudes_) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double reference = step_value(task[k], row);
      if (!std::isnan(reference)) out[k] = reference;
    }
  }
  return out;
}

model::State StepSignals::state(std::size_t row) const {
  model::State state;
  std::array<double, 3> rpy{};
  for (std::size_t k = 0; k < 3; ++k) {
    state.p_WB[k] = step_value(position_[k], row, 0.0);
    state.v_WB[k] = step_value(velocity_[k], row, 0.0);
    state.w_WB_B[k] = step_value(angular_[k], row, 0.0);
    rpy[k] = step_value(rpy_[k], row, 0.0);
  }
  state.q_WB = quaternion_of_rpy(rpy);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    state.q[j] = step_value(joints_[j][0], row, 0.0);
    state.qd[j] = step_value(joints_[j][1], row, 0.0);
  }
  return state;
}

}  // namespace footfall::lab
