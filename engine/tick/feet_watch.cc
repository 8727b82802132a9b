// Phases and slides of the feet; see feet_watch.h.
#include "engine/tick/feet_watch.h"

#include <cmath>
#include <limits>

#include "behaviors/compiled/control_set.h"
#include "core/index.h"

namespace footfall::engine {
namespace {

constexpr double kForgotten = 0.2;  // s
constexpr double kLeastUse = 0.2;   // of the friction cone

double along(const std::array<double, 3>& v, const std::array<double, 3>& normal) noexcept {
  return v[0] * normal[0] + v[1] * normal[1] + v[2] * normal[2];
}

}  // namespace

FaultFindings SwingWatch::check(int control, const Contacts& contacts, bool stepping) noexcept {
  FaultFindings findings;
  const behaviors::ControlSpec& spec = behavior_.controls[at(control)];
  const model::RobotDescription& robot = behavior_.robot;
  const double period = robot.period_s();
  for (int c = 0; c < static_cast<int>(robot.contacts.size()); ++c) {
    Phase& phase = phases_[at(c)];
    const bool held = behaviors::law_holds(behavior_, control, c);
    if (!stepping || held || spec.contacts.empty()) {
      if (held && phase.ticks > 0 && !contacts[at(c)]) {
        findings.add(core::Fault::load_air, {c, static_cast<double>(phase.ticks) * period, 0.0});
      }
      const std::int64_t excess = 2 * phase.loaded - phase.ticks;
      if (held && excess > 0) {
        findings.add(core::Fault::swing_contact, {c, static_cast<double>(phase.loaded) * period,
                                                  0.5 * static_cast<double>(excess) * period});
      }
      phase = {};
      continue;
    }
    ++phase.ticks;
    if (contacts[at(c)]) ++phase.loaded;
    const double loaded = static_cast<double>(phase.loaded) * period;
    if (loaded <= 0.5 * robot.swing_limit) continue;
    findings.add(core::Fault::swing_contact, {c, loaded, loaded - 0.5 * robot.swing_limit});
  }
  return findings;
}

double cone_use(const std::array<double, 3>& force, const std::array<double, 3>& normal,
                double friction) noexcept {
  const double push = along(force, normal);
  if (!(push > 0.0)) return std::numeric_limits<double>::infinity();
  double squared = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double tangential = force[k] - push * normal[k];
    squared += tangential * tangential;
  }
  return std::sqrt(squared) / (friction * push);
}

FaultFindings SlipWatch::check(const tasks::ControlSet& set, const model::ControlModel& model,
                               const tasks::ControllerResult& result) noexcept {
  FaultFindings findings;
  const model::RobotDescription& robot = behavior_.robot;
  const double period = robot.period_s();
  std::array<bool, core::kMaxContacts> holds{};
  for (int i = 0; i < set.contact_count; ++i) {
    const int c = set.contacts[at(i)];
    holds[at(c)] = true;
    Slide& slide = slides_[at(c)];
    if (!slide.held) slide.way = {};
    const std::array<double, 3>& normal = model.contact_normal(c);
    const std::array<double, 3>& velocity = model.point(c).velocity;
    const double away = along(velocity, normal);
    const bool counts =
        cone_use(result.force_measured[at(c)], normal, robot.contacts[at(c)].friction) >= kLeastUse;
    double squared = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      slide.way[k] *= 1.0 - period / kForgotten;
      if (counts) slide.way[k] += period * (velocity[k] - away * normal[k]);
      squared += slide.way[k] * slide.way[k];
    }
    const double way = std::sqrt(squared);
    if (way > robot.slip_limit) {
      findings.add(core::Fault::slip, {c, way, way - robot.slip_limit});
    }
  }
  for (std::size_t c = 0; c < holds.size(); ++c) slides_[c].held = holds[c];
  return findings;
}

}  // namespace footfall::engine
