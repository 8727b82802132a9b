// Figures of a run; see metrics.h.
#include "lab/run/metrics.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kRecent = 51;  // 50 whole steps
constexpr std::size_t kGoalSteps = 10;

// The running mean of the placement errors, and the largest.
void add_placement(RunFigures& sums, double error) noexcept {
  ++sums.placements;
  sums.placement_mean += (error - sums.placement_mean) / static_cast<double>(sums.placements);
  sums.placement_max = std::max(sums.placement_max, error);
}

// What counts from a time on; the rest of the figures is of the whole run in any case.
void take_errors(const RunFigures& from, RunFigures& to) {
  to.counted_from = from.counted_from;
  to.roll = from.roll;
  to.pitch = from.pitch;
  to.yaw = from.yaw;
  to.height = from.height;
  to.placement_mean = from.placement_mean;
  to.placement_max = from.placement_max;
  to.placements = from.placements;
  to.max_torque_step = from.max_torque_step;
  to.end_torque_step = from.end_torque_step;
  to.peak_torque = from.peak_torque;
  to.internal = from.internal;
}

double wrap(double angle) { return std::remainder(angle, 2.0 * M_PI); }

}  // namespace

void ErrorFigure::add(double value) noexcept {
  sum_of_squares += value * value;
  max = std::max(max, std::abs(value));
  ++count;
}

double ErrorFigure::rms() const noexcept {
  return count > 0 ? std::sqrt(sum_of_squares / static_cast<double>(count)) : 0.0;
}

RunMetrics::RunMetrics(const engine::ControlLoop& loop)
    : loop_(&loop),
      counter_(static_cast<int>(loop.behavior().robot.contacts.size()), loop.period()) {
  recent_.resize(kRecent);
  sums_.counted_from = kSettledAfter;
}

StepEvent RunMetrics::observe(const std::array<double, 2>& goal) noexcept {
  const model::ControlModel& model = loop_->model();
  std::array<double, core::kMaxContacts> heights{};
  for (int c = 0; c < model.contact_count(); ++c) heights[at(c)] = model.point(c).position[2];
  const StepEvent event = counter_.observe(loop_->sensors().contact.data(), heights.data());

  const auto& com = model.com().position;
  if (first_) sums_.start = {com[0], com[1]};
  if (!first_) sums_.path_length += std::hypot(com[0] - last_com_[0], com[1] - last_com_[1]);
  last_com_ = {com[0], com[1]};
  sums_.max_distance = std::max(sums_.max_distance, std::hypot(com[0] - goal[0], com[1] - goal[1]));
  first_ = false;

  observe_errors();
  observe_placement();
  if (event.foot >= 0) observe_step(event, goal);
  return event;
}

void RunMetrics::observe_errors() noexcept {
  const tasks::ControlSet& set = loop_->machine().control().primary;
  for (int t = 0; t < set.task_count; ++t) {
    const tasks::TaskCommand& task = set.tasks[at(t)];
    for (int i = 0; i < task.axis_count; ++i) {
      const tasks::AxisCommand& axis = set.axes[at(task.first_axis + i)];
      if (task.type == tasks::TaskType::body_orientation)
        orientation_ref_[at(axis.axis)] = axis.ref;
      if (task.type == tasks::TaskType::com_position && axis.axis == 2) {
        height_ref_ = axis.ref;
        have_height_ref_ = true;
      }
    }
  }
  add_errors(whole_);
  if (loop_->time() >= kSettledAfter) add_errors(sums_);
}

void RunMetrics::add_errors(RunFigures& sums) noexcept {
  const tasks::ControlSet& set = loop_->machine().control().primary;
  const auto& rpy = loop_->model().rpy();
  sums.roll.add(wrap(rpy[0] - orientation_ref_[0]));
  sums.pitch.add(wrap(rpy[1] - orientation_ref_[1]));
  sums.yaw.add(wrap(rpy[2] - orientation_ref_[2]));
  if (have_height_ref_) sums.height.add(loop_->model().com().position[2] - height_ref_);
  const core::SignalTable& signals = loop_->signals();
  const behaviors::SignalLayout& layout = loop_->behavior().layout;
  // The tick that ends the run takes the control away or hands it to the safe state; what counts
  // against the behavior is how its own torque moved.
  if (loop_->state() == engine::LoopState::running) {
    sums.max_torque_step = std::max(sums.max_torque_step, signals[layout.torque_step]);
  } else {
    sums.end_torque_step = signals[layout.torque_step];
  }
  for (int j = 0; j < loop_->model().joint_count(); ++j) {
    sums.peak_torque = std::max(sums.peak_torque, std::abs(loop_->commands().tau[at(j)]));
  }
  const tasks::ControllerResult& result = loop_->controller().result();
  for (int i = 0; i < set.internal_count; ++i) {
    const tasks::InternalCommand& c = set.internals[at(i)];
    RunFigures::Internal& out = sums.internal[loop_->behavior().internal_instances[at(c.instance)]];
    out.reference = c.reference;
    out.error.add(result.internal_measured[at(i)] - c.reference);
  }
}

// Touchdown minus the last planned target of the foot placement planner.
void RunMetrics::observe_placement() noexcept {
  const behaviors::SignalLayout& layout = loop_->behavior().layout;
  if (layout.planner.empty()) return;
  const core::SignalTable& signals = loop_->signals();
  for (int f = 0; f < loop_->model().contact_count(); ++f) {
    if (!counter_.touched_down(f)) continue;
    const auto& p = loop_->model().point(f).position;
    const int target = layout.planner.front().target;
    const double error = std::hypot(p[0] - signals[target], p[1] - signals[target + 1]);
    add_placement(whole_, error);
    if (loop_->time() >= kSettledAfter) add_placement(sums_, error);
  }
}

void RunMetrics::observe_step(const StepEvent&, const std::array<double, 2>& goal) noexcept {
  const auto& com = loop_->model().com().position;
  const double time = loop_->time();
  if (counter_.steps() == 1) first_step_time_ = time;
  if (counter_.steps() > 1) last_step_duration_ = time - last_step_time_;
  last_step_time_ = time;
  recent_[recent_head_] = {time, {com[0], com[1]}, std::hypot(com[0] - goal[0], com[1] - goal[1])};
  recent_head_ = (recent_head_ + 1) % kRecent;
}

RunFigures RunMetrics::figures(bool fell) const {
  RunFigures f = sums_;
  if (loop_->time() < kShortRun) take_errors(whole_, f);
  f.steps = counter_.steps();
  f.time = loop_->time();
  f.end = last_com_;
  f.fell = fell;
  f.worst_clearance = f.steps > 0 ? counter_.worst_clearance() : 0.0;
  const auto count = static_cast<std::size_t>(std::min<std::int64_t>(f.steps, kRecent));
  const auto sample = [&](std::size_t back) {  // 0: the last step
    return recent_[(recent_head_ + kRecent - 1 - back) % kRecent];
  };
  const std::size_t last = std::min(count, kGoalSteps);
  for (std::size_t i = 0; i < last; ++i)
    f.goal_error += sample(i).goal_distance / static_cast<double>(last);
  if (count > 1) {
    const StepSample newest = sample(0);
    const StepSample oldest = sample(count - 1);
    for (std::size_t k = 0; k < 2; ++k) {
      f.mean_velocity_last_50[k] = (newest.com[k] - oldest.com[k]) / (newest.time - oldest.time);
    }
    f.mean_step_time = (newest.time - oldest.time) / static_cast<double>(count - 1);
  }
  return f;
}

}  // namespace footfall::lab
