// Contact transitions: two complete control laws and the weight between them. The torques are
// blended by the whole-body controller, so both ends are exact ([Kim16] eqs. (1)-(2),
// torque-continuous).
//   releases:  w = (1 + cos(pi s))/2 of the previous set, from 1 in the first tick to 0
//   loads:     w = (1 - cos(pi s))/2 of the next set, from 0 to 1
// with s = ticks in the state / ticks of `over`. The ramp is a cosine, in the paper it is linear.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "behaviors/machine/control_merge.h"
#include "core/index.h"

namespace footfall::behaviors {
bool ControlMerge::transition_goes_on(const ControlSpec& spec) const noexcept {
  if (transition_ < 0 || spec.transition < 0) return false;
  const int owner = behavior_.contact_transitions[at(spec.transition)].owner;
  return behavior_.contact_transitions[at(transition_)].owner == owner &&
         transition_serial_ == statechart_.entry_serial(owner);
}

void ControlMerge::update_transition(const ControlSpec& spec) noexcept {
  if (spec.transition < 0) {
    control_.has_other = false;
    control_.moving_contact_count = 0;
    transition_ = -1;
    return;
  }
  const bool goes_on = transition_goes_on(spec);
  transition_ = spec.transition;
  if (goes_on) {
    std::swap(other_, old_other_);
    return;
  }
  begin_transition(behavior_.contact_transitions[at(spec.transition)]);
}

void ControlMerge::begin_transition(const TransitionSpec& transition) noexcept {
  transition_serial_ = statechart_.entry_serial(transition.owner);
  control_.has_other = true;
  control_.transition_entered = true;
  control_.form = transition.form;
  control_.moving_contact_count = static_cast<int>(transition.contacts.size());
  std::copy(transition.contacts.begin(), transition.contacts.end(),
            control_.moving_contacts.begin());
  if (transition.loads) {
    fill(*other_, control_.other, behavior_.controls[at(transition.toward)]);
  } else {
    const ControlSpec& left = behavior_.controls[at(statechart_.control_before(transition.owner))];
    fill(*other_, control_.other, left);
    if (old_primary_->spec == &left) {  // in force until now: exactly its references
      std::copy_n(old_primary_->axes.begin(), old_set_->axis_count, other_->axes.begin());
      std::copy_n(old_primary_->knots.begin(), old_primary_->knot_count, other_->knots.begin());
      other_->knot_count = old_primary_->knot_count;
    } else {
      advance(*other_, control_.other);  // passed in no time: as it would have begun
    }
    other_->frozen = true;
  }
  const double over = value_or(transition.over, 0.0, *other_, nullptr);
  transition_periods_ = std::max<std::int64_t>(periods_of(over, behavior_.rate_mhz), 0);
}

void ControlMerge::weigh_transition() noexcept {
  control_.other_weight = 0.0;
  if (!control_.has_other) return;
  const TransitionSpec& transition = behavior_.contact_transitions[at(transition_)];
  const std::int64_t ticks = statechart_.context().tick - statechart_.entry_tick(transition.owner);
  const bool over = ticks >= transition_periods_;
  const double s =
      over ? 1.0 : static_cast<double>(ticks) / static_cast<double>(transition_periods_);
  const double rising = 0.5 * (1.0 - std::cos(std::numbers::pi * s));
  control_.other_weight = transition.loads ? rising : 1.0 - rising;
  if (over && !transition.loads) {
    control_.has_other = false;
    control_.other_weight = 0.0;
  }
}

}  // namespace footfall::behaviors
