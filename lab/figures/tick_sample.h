// One tick as the figures of a run see it, read by the same code from the control loop's signals
// and from a row of a log: what a page says of a part of a run is computed as what the summary says
// of the whole.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/capacities.h"

namespace footfall::behaviors {
struct Behavior;
}

namespace footfall::lab {

inline constexpr double kAbsent = std::numeric_limits<double>::quiet_NaN();

// SI, world frame. Orientation, height and place are the true ones where the state is estimated and
// a simulator tells the truth: a robot is judged by what it did, not by what it believed. An
// estimator without motion capture drifts, and the frame of its goals with it: there the place in
// the horizontal plane is the estimated one.
struct TickSample {
  double time = 0.0;
  std::int64_t ticks = 1;  // that it stands for: a log has not a row of each
  bool going_on = true;    // false in the tick that ended the run
  std::array<bool, core::kMaxContacts> contact{};
  std::array<std::array<double, 3>, core::kMaxContacts> point{};  // of the contacts
  std::array<double, 3> com{}, rpy{};
  std::array<double, 3> rpy_reference{kAbsent, kAbsent, kAbsent};  // NaN: not controlled
  double height_reference = kAbsent;
  std::array<double, 2> goal{};
  std::array<double, 2> target{kAbsent, kAbsent};  // of the first planner; NaN: there is none
  double torque_step = 0.0, torque = 0.0;          // largest of the joints
  struct Force {
    double reference = kAbsent, measured = kAbsent;  // NaN: not in force
  };
  std::array<Force, core::kMaxInternal> internal{};
  // Before its first answer a planner's target is the origin.
  bool has_target() const noexcept {
    return target[0] == target[0] && (target[0] != 0.0 || target[1] != 0.0);
  }
};

// What a run is named after: the parts of the names of its signals.
struct SampleNames {
  std::vector<std::string> contacts, joints, internals;
  std::vector<std::string> height_tasks, orientation_tasks;
  std::string planner;    // the first one; empty: none
  bool odometry = false;  // the estimator's frame is its own: goals are told in that one
};
SampleNames sample_names(const behaviors::Behavior& behavior);
// Whether an estimator, by its name, has no place in the world to begin from.
bool has_own_frame(std::string_view estimator);

// Indices of the signals; -1: there is none.
struct SampleColumns {
  int time = -1, torque_step = -1;
  std::vector<int> contact, command;
  std::vector<std::array<int, 3>> point;
  std::array<int, 3> com{}, rpy{};
  std::array<int, 3> true_com{}, true_rpy{};      // instead, where they have a value
  std::vector<std::array<int, 3>> rpy_reference;  // of each task
  std::vector<int> height_reference;
  std::array<int, 2> goal{}, target{};
  std::vector<std::pair<int, int>> internal;  // reference and measured
};
// find: index of a signal's name, -1 if there is none.
SampleColumns sample_columns(const SampleNames& names,
                             const std::function<int(std::string_view)>& find);

// value(index): the signal in this tick. The references of several tasks of a kind: the one in
// force.
template <typename Value>
TickSample read_sample(const SampleColumns& columns, const Value& value) noexcept {
  const auto number = [&](int column, double otherwise) {
    return column < 0 ? otherwise : static_cast<double>(value(column));
  };
  const auto numbers = [&](const auto& from, auto& to, double otherwise) {
    for (std::size_t k = 0; k < from.size(); ++k) to[k] = number(from[k], otherwise);
  };
  TickSample sample;
  sample.time = number(columns.time, 0.0);
  for (std::size_t c = 0; c < columns.contact.size(); ++c) {
    sample.contact[c] = number(columns.contact[c], 0.0) > 0.5;
    numbers(columns.point[c], sample.point[c], 0.0);
  }
  numbers(columns.com, sample.com, 0.0);
  numbers(columns.rpy, sample.rpy, 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    const double com = number(columns.true_com[k], kAbsent);
    const double angle = number(columns.true_rpy[k], kAbsent);
    if (com == com) sample.com[k] = com;
    if (angle == angle) sample.rpy[k] = angle;
  }
  for (const auto& task : columns.rpy_reference) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double reference = number(task[k], kAbsent);
      if (reference == reference) sample.rpy_reference[k] = reference;
    }
  }
  for (const int task : columns.height_reference) {
    const double reference = number(task, kAbsent);
    if (reference == reference) sample.height_reference = reference;
  }
  numbers(columns.goal, sample.goal, 0.0);
  numbers(columns.target, sample.target, kAbsent);
  sample.torque_step = number(columns.torque_step, 0.0);
  for (const int joint : columns.command) {
    const double torque = number(joint, 0.0);
    const double magnitude = torque < 0.0 ? -torque : torque;
    if (magnitude > sample.torque) sample.torque = magnitude;
  }
  for (std::size_t i = 0; i < columns.internal.size(); ++i) {
    sample.internal[i] = {number(columns.internal[i].first, kAbsent),
                          number(columns.internal[i].second, kAbsent)};
  }
  return sample;
}

}  // namespace footfall::lab
