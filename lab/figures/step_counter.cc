// Steps from contacts and foot heights; see step_counter.h.
#include "lab/figures/step_counter.h"

#include <algorithm>

namespace footfall::lab {

StepEvent StepCounter::observe(double time, const bool* contact, const double* height) noexcept {
  StepEvent event;
  for (int f = 0; f < feet_; ++f) {
    Foot& foot = feet_state_[static_cast<std::size_t>(f)];
    foot.landed = false;
    if (first_) {
      foot.in_contact = contact[f];
      foot.lift_height = height[f];
      foot.left_at = time;
    }
    if (!contact[f]) {
      if (foot.in_contact) {  // a bounce after touchdown keeps the step that is pending
        foot.in_contact = false;
        foot.left_at = time;
        foot.lift_height = height[f];
        foot.rise = 0.0;
      }
      if (time + 1.5 * period_ - foot.left_at >= kMinFlight) foot.pending = false;
      foot.rise = std::max(foot.rise, height[f] - foot.lift_height);
    } else if (!foot.in_contact) {
      foot.in_contact = true;
      // Half a period of tolerance: 60 ms is a whole number of ticks at most rates.
      const double flight = time - foot.left_at;
      const bool swung = flight + 0.5 * period_ >= kMinFlight && foot.rise >= kMinRise;
      if (swung) {
        foot.pending = foot.landed = true;
        foot.swing_time = flight;
        foot.swing_rise = foot.rise;
      }
    }
  }
  first_ = false;
  for (int f = 0; f < feet_; ++f) {
    Foot& foot = feet_state_[static_cast<std::size_t>(f)];
    if (foot.landed) note_others(foot, contact);
  }
  for (int f = 0; f < feet_ && event.foot < 0; ++f) {
    const Foot& foot = feet_state_[static_cast<std::size_t>(f)];
    if (foot.pending && contact[f] && took_over(foot, contact)) {
      event = {f, foot.swing_time, foot.swing_rise};
    }
  }
  if (event.foot >= 0) settle(contact);
  return event;
}

// Feet that came down with this one, or shortly before it, are no others: they take over with it.
void StepCounter::note_others(Foot& foot, const bool* contact) const noexcept {
  for (int g = 0; g < feet_; ++g) {
    const std::size_t other = static_cast<std::size_t>(g);
    foot.others[other] = contact[g] && !feet_state_[other].pending;
  }
}

bool StepCounter::took_over(const Foot& foot, const bool* contact) const noexcept {
  int standing = 0;
  for (int g = 0; g < feet_; ++g) {
    if (!contact[g]) continue;
    if (foot.others[static_cast<std::size_t>(g)]) return false;
    ++standing;
  }
  return standing < feet_;  // a landing on all feet is no step until some of them leave
}

// A step is counted: once for all feet that took over.
void StepCounter::settle(const bool* contact) noexcept {
  ++steps_;
  for (int f = 0; f < feet_; ++f) {
    Foot& foot = feet_state_[static_cast<std::size_t>(f)];
    if (!foot.pending || !contact[f]) continue;
    foot.pending = false;
    worst_clearance_ = std::min(worst_clearance_, foot.swing_rise);
  }
}

}  // namespace footfall::lab
