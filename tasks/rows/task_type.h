// The description of a task type: what the loader, the reference, the checks and the control law
// know of it. Each type has one, in tasks/types/; tasks/task_types.h lists them.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "core/units/units.h"
#include "tasks/rows/axis.h"

namespace footfall::model {
class ControlModel;
}  // namespace footfall::model

namespace footfall::tasks {

// What a task type measures.
enum class Subject : std::uint8_t {
  com,            // the centre of mass
  base_rotation,  // how the floating base is turned, or turns
  point,          // a contact or named point, or its frame: the task has the key `point`
  joints,         // its axes are the robot's joints: the task has `joints` in place of `axes`
  momentum,       // of the whole robot
};

// An axis by name, and the dimension of its reference (angles: kNone).
struct AxisInfo {
  std::string_view name;
  core::Dimension dimension;
};

inline constexpr std::array<AxisInfo, 3> kPositionAxes = {
    {{"x", core::kLength}, {"y", core::kLength}, {"z", core::kLength}}};
inline constexpr std::array<AxisInfo, 3> kOrientationAxes = {
    {{"roll", core::kNone}, {"pitch", core::kNone}, {"yaw", core::kNone}}};

// The frames that positions, orientations and free vectors can be given in, default first.
inline constexpr std::array<Frame, 2> kPositionFrames = {Frame::world, Frame::stance};
inline constexpr std::array<Frame, 2> kOrientationFrames = {Frame::heading, Frame::world};
inline constexpr std::array<Frame, 2> kVectorFrames = {Frame::world, Frame::heading};

// One task in this tick, for the function that computes its rows.
struct RowsRequest {
  const model::ControlModel& model;
  int point = -1;  // index into the model's points; -1: the type has no point
  Frame frame = Frame::usual;
  std::span<const AxisCommand> axes;
  std::span<const int> contacts;  // in force: Frame::stance measures from their mean
};

// Where the rows go: one per axis of the request, all zero before.
struct Rows {
  double* J = nullptr;            // axes x n, row-major
  double* bias = nullptr;         // J̇ q̇
  AxisEvaluation* out = nullptr;  // measured, velocity and error are to be written
  int n = 0;                      // columns: nv of the model
};

// In the tick: allocates nothing.
using RowsFunction = void (*)(const RowsRequest& request, const Rows& rows) noexcept;
// One axis as measured now; world frame (orientations: roll, pitch, yaw).
using MeasuredFunction = double (*)(const model::ControlModel& model, int point, int axis) noexcept;

struct TaskTypeInfo {
  std::string_view name;  // as behavior files write it
  std::string_view doc;   // one line for the reference and editors
  Subject subject = Subject::com;
  std::span<const AxisInfo> axes{};  // in the order of AxisCommand::axis; empty: the joints
  std::span<const Frame> frames{};   // of the key `frame`, default first; empty: no such key
  // What is measured is a rate (momentum, angular velocity): what is commanded is its first
  // derivative, kd acts on the error and kp on the error's integral.
  bool is_rate = false;
  bool has_reference = true;            // false: brings velocities to 0
  std::string_view gains = "kp ki kd";  // those that its law uses, blanks between
  std::string_view gains_note{};        // why it has no others, for an error
  RowsFunction rows = nullptr;          // required
  MeasuredFunction measured = nullptr;  // required
  MeasuredFunction velocity = nullptr;  // of positions; nullptr: 0

  constexpr bool of_joints() const { return subject == Subject::joints; }
  constexpr bool of_point() const { return subject == Subject::point; }
  // How many axes a task of this type may have.
  constexpr int axis_count(int joints) const {
    return of_joints() ? joints : static_cast<int>(axes.size());
  }
  // Dimension of an axis' reference, and of what the law commands.
  constexpr core::Dimension dimension(int axis) const {
    return of_joints() ? core::kNone : axes[static_cast<std::size_t>(axis)].dimension;
  }
  constexpr core::Dimension commanded_dimension(int axis) const {
    return dimension(axis) / (is_rate ? core::kTime : core::kTime * core::kTime);
  }
  constexpr bool is_length(int axis) const { return dimension(axis) == core::kLength; }
  constexpr bool is_angle(int axis) const { return dimension(axis) == core::kNone; }
};

}  // namespace footfall::tasks
