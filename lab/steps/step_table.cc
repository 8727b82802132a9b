// Steps from ticks; see step_table.h.
#include "lab/steps/step_table.h"

#include <algorithm>
#include <cmath>

#include "lab/figures/step_counter.h"

namespace footfall::lab {
namespace {

using Plane = std::array<double, 2>;

double horizontal(const std::array<double, 3>& v) { return std::hypot(v[0], v[1]); }

double between(const Plane& a, const Plane& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }

// To the left of a heading.
double leftward(const Plane& v, double yaw) { return -std::sin(yaw) * v[0] + std::cos(yaw) * v[1]; }

Plane from_to(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return {b[0] - a[0], b[1] - a[1]};
}

int feet_down(const StepSample& sample, int feet) {
  int down = 0;
  for (int f = 0; f < feet; ++f) down += sample.foot[static_cast<std::size_t>(f)].force[2] > 0.0;
  return down;
}

}  // namespace

double StepTable::side(int foot) const noexcept { return side_[static_cast<std::size_t>(foot)]; }

void StepTable::begin(const StepSample& sample) {
  for (std::size_t f = 0; f < static_cast<std::size_t>(feet_); ++f) {
    const auto& foot = sample.foot[f];
    swing_[f] = {foot.force[2] > 0.0, sample.time, foot.position[2], 0.0};
    double left = 0.0;
    for (std::size_t o = 0; o < static_cast<std::size_t>(feet_); ++o) {
      left += leftward(from_to(sample.foot[o].position, foot.position), sample.yaw);
    }
    side_[f] = left < 0.0 ? -1.0 : 1.0;
  }
  first_ = false;
}

// What adds up from one touchdown to the next.
void StepTable::during(const StepSample& sample, double period) {
  const bool single = feet_down(sample, feet_) == 1;
  for (std::size_t f = 0; f < static_cast<std::size_t>(feet_); ++f) {
    const auto& foot = sample.foot[f];
    if (foot.force[2] <= loaded_) continue;
    const double path = horizontal(foot.velocity) * period;
    (single ? running_.slip_single : running_.slip_double) += path;
    if (!single) continue;
    const double use = horizontal(foot.force) / foot.force[2];
    running_.friction = std::isnan(running_.friction) ? use : std::max(running_.friction, use);
  }
  running_.tilt = std::max(running_.tilt, sample.tilt);
  running_.saturated += sample.saturated ? 1.0 : 0.0;
  if (after_open_ && single) {
    rows_.back().yaw_rate_after = sample.yaw_rate;
    after_open_ = false;
  }
}

void StepTable::plan_of(StepRow& row) const {
  const auto& foot = last_.foot[static_cast<std::size_t>(row.foot)];
  const StepSample::Plan& plan = last_.plan;
  row.extension = plan.extension;
  row.early = plan.landing - row.time;
  row.not_reached = between(foot.reference, plan.target);
  row.tracking = between(foot.measured, foot.reference);
  row.error = between(foot.measured, plan.target);
  row.lateral_predicted = side(row.foot) * leftward(plan.predicted_vel, plan.yaw);
}

void StepTable::land(int foot, const StepSample& sample) {
  const auto f = static_cast<std::size_t>(foot);
  StepRow row = running_;
  row.foot = foot;
  row.number = static_cast<double>(rows_.size() + 1);
  row.time = sample.time;
  row.step_time = sample.time - last_touchdown_;
  row.flight_time = sample.time - swing_[f].left_at;
  row.clearance = swing_[f].rise;
  // Of the last tick in the air: with the first force the ground has changed them.
  const auto& before = last_.foot[f];
  row.speed = horizontal(before.velocity);
  row.sink_speed = -before.velocity[2];
  row.lateral_speed = side(foot) * leftward(last_.com_velocity, last_.yaw);
  row.yaw = last_.yaw;
  row.yaw_rate = last_.yaw_rate;
  if (feet_ == 2) {
    const auto& other = sample.foot[1 - f];
    row.width = side(foot) * leftward(from_to(other.position, sample.foot[f].position), sample.yaw);
  }
  plan_of(row);
  rows_.push_back(row);
  running_ = {};
  last_touchdown_ = sample.time;
  after_open_ = true;
}

void StepTable::observe(const StepSample& sample) {
  if (first_) {
    begin(sample);
    last_ = sample;
    return;
  }
  const double period = sample.time - last_.time;
  if (period <= 0.0) return;  // a reload that was taken back did its last tick again
  during(sample, period);
  for (int f = 0; f < feet_; ++f) {
    Swing& swing = swing_[static_cast<std::size_t>(f)];
    const auto& foot = sample.foot[static_cast<std::size_t>(f)];
    if (foot.force[2] > 0.0) {
      // Shorter flights are bounces. A foot that hardly rose is a step, too: falls end in those.
      const bool swung = sample.time - swing.left_at + 0.5 * period >= StepCounter::kMinFlight;
      if (!swing.in_contact && swung) land(f, sample);
      swing.in_contact = true;
      continue;
    }
    if (swing.in_contact) swing = {false, sample.time, foot.position[2], 0.0};
    swing.rise = std::max(swing.rise, foot.position[2] - swing.lift_height);
  }
  last_ = sample;
}

}  // namespace footfall::lab
