// Notices in a tick what a foot does wrong: one that should swing bears load, for more than half of
// its phase, from the tick in which the control law begins to let go of it to the one that begins
// to load it, or it is loaded then without ground contact; and one that should stand slides.
#pragma once

#include <array>
#include <cstdint>

#include "behaviors/compiled/behavior.h"
#include "core/capacities.h"
#include "engine/estimators/estimator.h"
#include "engine/tick/faults.h"
#include "model/control_model.h"
#include "tasks/active_set.h"
#include "tasks/whole_body_controller.h"

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

class SlipWatch {
 public:
  explicit SlipWatch(const behaviors::Behavior& behavior) : behavior_(behavior) {}

  // set: the law in force; result: its forces under the measured torques. The distance that a foot
  // has slid is that of its material point along the ground, forgotten with 0.2 s: what counts is
  // fast motion, not a creep. A ball that rolls does not slide. It is counted while the force uses
  // a fifth of the friction cone or more, for a foot that bears load without being pushed along the
  // ground has no cause to move: its motion is that of the estimate.
  FaultFindings check(const tasks::ControlSet& set, const model::ControlModel& model,
                      const tasks::ControllerResult& result) noexcept;

  // Goes on from the watch of another loop on the same robot.
  void take_over(const SlipWatch& old) noexcept { slides_ = old.slides_; }

 private:
  struct Slide {
    std::array<double, 3> way{};  // m
    bool held = false;            // in the tick before
  };
  const behaviors::Behavior& behavior_;
  std::array<Slide, core::kMaxContacts> slides_{};
};

// |f_t| / (mu f_n) of a contact force (N, ground on robot) on ground of this normal: 1 at the edge
// of the friction cone; infinite where the force pulls.
double cone_use(const std::array<double, 3>& force, const std::array<double, 3>& normal,
                double friction) noexcept;

}  // namespace footfall::engine
