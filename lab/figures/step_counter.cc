// Steps from contacts and foot heights; see step_counter.h.
#include "lab/figures/step_counter.h"

#include <algorithm>

namespace footfall::lab {

StepEvent StepCounter::observe(double time, const bool* contact, const double* height) noexcept {
  StepEvent event;
  int standing = 0;
  for (int f = 0; f < feet_; ++f) standing += contact[f] ? 1 : 0;
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
    if (foot.pending && contact[f] && standing == 1) {
      foot.pending = false;
      ++steps_;
      worst_clearance_ = std::min(worst_clearance_, foot.swing_rise);
      event = {f, foot.swing_time, foot.swing_rise};
    }
  }
  first_ = false;
  return event;
}

}  // namespace footfall::lab
