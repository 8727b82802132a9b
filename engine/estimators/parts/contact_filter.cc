// Contacts from switches and torques; see contact_filter.h.
#include "engine/estimators/parts/contact_filter.h"

#include <Eigen/LU>
#include <algorithm>

#include "core/index.h"
#include "engine/estimators/parts/rotation.h"

namespace footfall::engine {

ContactFilter::ContactFilter(const model::RobotDescription& robot, behaviors::ContactSource source)
    : source_(source), period_(robot.period_s()) {
  for (const model::ContactDescription& contact : robot.contacts) {
    const int group = robot.find_group(contact.group);
    legs_.push_back(group >= 0 ? robot.groups[at(group)].joints : std::vector<int>{});
  }
}

bool ContactFilter::by_switch(std::size_t c, bool closed, double debounce) noexcept {
  memory_.open[c] = closed ? 0.0 : memory_.open[c] + period_;
  return closed || (memory_.switched[c] && memory_.open[c] <= debounce);
}

// Least squares over the leg's joints: (J Jᵀ) f = -J (tau - h), with a floor under J Jᵀ where the
// leg is straight.
double ContactFilter::leg_force(const hal::Sensors& sensors, const model::ControlModel& model,
                                int c) const noexcept {
  const model::Kinematics3& foot = model.point(c);
  const int nv = model.nv();
  Matrix3d JJ = 1e-6 * Matrix3d::Identity();
  Vector3d Jt = Vector3d::Zero();
  for (const int joint : legs_[at(c)]) {
    const std::size_t column = at(6 + joint);
    const Vector3d J(foot.jacobian[column], foot.jacobian[at(nv) + column],
                     foot.jacobian[2 * at(nv) + column]);
    JJ += J * J.transpose();
    Jt += J * (sensors.tau[at(joint)] - model.bias()[column]);
  }
  return -(JJ.inverse() * Jt)[2];
}

void ContactFilter::update(const hal::Sensors& sensors, const model::ControlModel& model,
                           std::uint64_t support, const ContactSettings& settings) noexcept {
  using behaviors::ContactSource;
  settings_ = settings;
  for (int i = 0; i < count(); ++i) {
    const std::size_t c = at(i);
    memory_.switched[c] = by_switch(c, sensors.contact[c], settings.debounce);
    if (source_ != ContactSource::switches) {
      memory_.force[c] = leg_force(sensors, model, i);
      memory_.pressed[c] = memory_.force[c] > (memory_.pressed[c] ? 0.5 : 1.0) * settings.force;
    }
    memory_.contact[c] = source_ == ContactSource::switches ? memory_.switched[c]
                         : source_ == ContactSource::torque
                             ? memory_.pressed[c]
                             : memory_.switched[c] || memory_.pressed[c];
    // A foot that touches at the start has done so before.
    const double before = memory_.started ? memory_.touching[c] : 1e9;
    memory_.touching[c] = memory_.contact[c] ? before + period_ : 0.0;
    const bool relied = ((support >> static_cast<unsigned>(i)) & 1U) != 0;
    memory_.unsupported[c] = relied ? 0.0 : memory_.unsupported[c] + period_;
  }
  memory_.started = true;
}

bool ContactFilter::anchor(int c) const noexcept {
  return memory_.contact[at(c)] && memory_.touching[at(c)] > settings_.settle &&
         memory_.unsupported[at(c)] <= settings_.release;
}

}  // namespace footfall::engine
