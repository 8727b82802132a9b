// Phases of the feet; see swing_watch.h.
#include "engine/tick/swing_watch.h"

#include "behaviors/compiled/control_set.h"
#include "core/index.h"

namespace footfall::engine {
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

}  // namespace footfall::engine
