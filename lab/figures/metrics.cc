// Figures of a run; see metrics.h.
#include "lab/figures/metrics.h"

#include <algorithm>
#include <cmath>

namespace footfall::lab {
namespace {

constexpr std::size_t kRecent = 51;  // 50 whole steps
constexpr std::size_t kGoalSteps = 10;

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

void ErrorFigure::add(double value, std::int64_t ticks) noexcept {
  sum_of_squares += static_cast<double>(ticks) * value * value;
  max = std::max(max, std::abs(value));
  count += ticks;
}

double ErrorFigure::rms() const noexcept {
  return count > 0 ? std::sqrt(sum_of_squares / static_cast<double>(count)) : 0.0;
}

RunMetrics::RunMetrics(const SampleNames& names, double period, std::optional<double> counted_from)
    : contacts_(names.contacts.size()), counter_(static_cast<int>(contacts_), period) {
  recent_.resize(kRecent);
  settled_.figures.counted_from = counted_from.value_or(kSettledAfter);
  whole_.figures.counted_from = counted_from.value_or(0.0);
  go_on(names);
}

void RunMetrics::go_on(const SampleNames& names) {
  for (Sums* sums : {&settled_, &whole_}) {
    sums->internal.clear();
    for (const std::string& name : names.internals) {
      sums->internal.push_back(&sums->figures.internal[name]);
    }
  }
}

StepEvent RunMetrics::observe(const TickSample& tick) noexcept {
  std::array<double, core::kMaxContacts> heights{};
  for (std::size_t c = 0; c < contacts_; ++c) heights[c] = tick.point[c][2];
  const StepEvent event = counter_.observe(tick.time, tick.contact.data(), heights.data());

  RunFigures& run = settled_.figures;
  const std::array<double, 2> com = {tick.com[0], tick.com[1]};
  if (first_) run.start = com;
  if (!first_) run.path_length += std::hypot(com[0] - last_com_[0], com[1] - last_com_[1]);
  last_com_ = com;
  run.max_distance =
      std::max(run.max_distance, std::hypot(com[0] - tick.goal[0], com[1] - tick.goal[1]));
  first_ = false;

  observe_errors(tick);
  observe_placement(tick);
  if (event.foot >= 0) observe_step(tick);
  return event;
}

void RunMetrics::observe_errors(const TickSample& tick) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    if (!std::isnan(tick.rpy_reference[k])) rpy_reference_[k] = tick.rpy_reference[k];
  }
  if (!std::isnan(tick.height_reference)) height_reference_ = tick.height_reference;
  whole_.add_errors(tick, rpy_reference_, height_reference_);
  if (tick.time >= settled_.figures.counted_from)
    settled_.add_errors(tick, rpy_reference_, height_reference_);
}

void RunMetrics::Sums::add_errors(const TickSample& tick,
                                  const std::array<double, 3>& rpy_reference,
                                  double height_reference) noexcept {
  figures.roll.add(wrap(tick.rpy[0] - rpy_reference[0]), tick.ticks);
  figures.pitch.add(wrap(tick.rpy[1] - rpy_reference[1]), tick.ticks);
  figures.yaw.add(wrap(tick.rpy[2] - rpy_reference[2]), tick.ticks);
  if (!std::isnan(height_reference)) {
    figures.height.add(tick.com[2] - height_reference, tick.ticks);
  }
  // The tick that ends the run takes the control away or hands it to the safe state; what counts
  // against the behavior is how its own torque moved.
  if (tick.going_on) {
    figures.max_torque_step = std::max(figures.max_torque_step, tick.torque_step);
  } else {
    figures.end_torque_step = tick.torque_step;
  }
  figures.peak_torque = std::max(figures.peak_torque, tick.torque);
  for (std::size_t i = 0; i < internal.size(); ++i) {
    const TickSample::Force& force = tick.internal[i];
    if (std::isnan(force.reference) || std::isnan(force.measured)) continue;
    internal[i]->reference = force.reference;
    internal[i]->error.add(force.measured - force.reference, tick.ticks);
  }
}

// The running mean of the placement errors, and the largest.
void RunMetrics::Sums::add_placement(double error) noexcept {
  ++figures.placements;
  figures.placement_mean +=
      (error - figures.placement_mean) / static_cast<double>(figures.placements);
  figures.placement_max = std::max(figures.placement_max, error);
}

// Touchdown minus the last planned target of the foot placement planner.
void RunMetrics::observe_placement(const TickSample& tick) noexcept {
  if (!tick.has_target()) return;
  for (std::size_t c = 0; c < contacts_; ++c) {
    if (!counter_.touched_down(static_cast<int>(c))) continue;
    const auto& p = tick.point[c];
    const double error = std::hypot(p[0] - tick.target[0], p[1] - tick.target[1]);
    whole_.add_placement(error);
    if (tick.time >= settled_.figures.counted_from) settled_.add_placement(error);
  }
}

void RunMetrics::observe_step(const TickSample& tick) noexcept {
  if (counter_.steps() > 1) last_step_duration_ = tick.time - last_step_time_;
  last_step_time_ = tick.time;
  recent_[recent_head_] = {tick.time,
                           {tick.com[0], tick.com[1]},
                           std::hypot(tick.com[0] - tick.goal[0], tick.com[1] - tick.goal[1])};
  recent_head_ = (recent_head_ + 1) % kRecent;
}

RunFigures RunMetrics::figures(double time, bool fell) const {
  RunFigures f = settled_.figures;
  if (time < kShortRun) take_errors(whole_.figures, f);
  std::erase_if(f.internal, [](const auto& item) { return item.second.error.count == 0; });
  f.steps = counter_.steps();
  f.time = time;
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
