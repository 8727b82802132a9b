// Joint positions and velocities; see joint_filter.h.
#include "engine/estimators/parts/joint_filter.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::engine {

double low_pass_share(double period, double time_constant) noexcept {
  return time_constant > 0.0 ? 1.0 - std::exp(-period / time_constant) : 1.0;
}

JointFilter::JointFilter(const model::RobotDescription& robot)
    : count_(robot.joint_count()), period_(robot.period_s()) {
  for (int j = 0; j < count_; ++j) {
    const double spring = robot.joints[at(j)].spring;
    compliance_[at(j)] = spring > 0.0 ? 1.0 / spring : 0.0;
  }
}

void JointFilter::update(const hal::Sensors& sensors, bool fresh, double velocity_filter,
                         double encoder_time, model::State& state) noexcept {
  ++ticks_;
  if (started_ && !fresh) {
    for (int i = 0; i < count_; ++i) state.q[at(i)] += period_ * rate_[at(i)];
    return;
  }
  const double elapsed = ticks_ * period_;
  const double rate_share = low_pass_share(elapsed, velocity_filter);
  const double offset_share = low_pass_share(elapsed, encoder_time);
  // Logs of before the flag say it by angles that are not 0; without motors all are exactly 0.
  const bool motors =
      sensors.has_motors || std::any_of(sensors.motor.begin(), sensors.motor.begin() + count_,
                                        [](double angle) { return angle != 0.0; });
  const bool goes_on = started_ && motors == motors_;
  for (int i = 0; i < count_; ++i) {
    const std::size_t j = at(i);
    const bool elastic = motors && compliance_[j] > 0.0;
    const double fine = elastic ? sensors.motor[j] - sensors.tau[j] * compliance_[j] : sensors.q[j];
    const double rate = elastic && goes_on ? (fine - last_[j]) / elapsed : sensors.qd[j];
    const double offset = sensors.q[j] - fine;
    rate_[j] = goes_on ? rate_[j] + rate_share * (rate - rate_[j]) : rate;
    offset_[j] = goes_on ? offset_[j] + offset_share * (offset - offset_[j]) : offset;
    last_[j] = fine;
    state.q[j] = elastic ? fine + offset_[j] : sensors.q[j];
    state.qd[j] = rate_[j];
  }
  started_ = true;
  ticks_ = 0;
  motors_ = motors;
}

}  // namespace footfall::engine
