// Notices in a tick that a foot that should swing bears load: for more than half of its phase, from
// the tick in which the control law begins to let go of it to the one that begins to load it; and
// that it is loaded then without ground contact.
#pragma once

#include <array>
#include <cstdint>

#include "behaviors/compiled/behavior.h"
#include "core/capacities.h"
#include "engine/estimators/estimator.h"
#include "engine/tick/faults.h"

namespace footfall::engine {

class SwingWatch {
 public:
  explicit SwingWatch(const behaviors::Behavior& behavior) : behavior_(behavior) {}

  // control: of this tick, index into Behavior::controls. stepping: the behavior has marked a step.
  // A phase is judged when it ends, and before that as soon as the foot has borne load for half of
  // `limits.swing`. A foot that no other one replaces (contacts: []) does not swing.
  FaultFindings check(int control, const Contacts& contacts, bool stepping) noexcept;

  // Goes on from the watch of another loop on the same robot.
  void take_over(const SwingWatch& old) noexcept { phases_ = old.phases_; }

 private:
  struct Phase {
    std::int64_t ticks = 0;   // since the foot was let go; 0: it is not
    std::int64_t loaded = 0;  // of them with ground contact
  };

  const behaviors::Behavior& behavior_;
  std::array<Phase, core::kMaxContacts> phases_{};
};

}  // namespace footfall::engine
