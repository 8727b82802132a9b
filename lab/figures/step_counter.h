// Counts steps as docs/architecture.md defines them: a foot is without ground contact for at least
// 60 ms, rises at least 2 cm, and then carries the robot without any of the feet that stood when it
// came down. Feet that take over together, as the two of a trot, make one step. Fed once a tick, or
// with the rows of a log.
#pragma once

#include <array>
#include <cstdint>

#include "core/capacities.h"

namespace footfall::lab {

struct StepEvent {
  int foot = -1;             // contact index of a foot that took over; -1: no step
  double flight_time = 0.0;  // s without ground contact
  double clearance = 0.0;    // m, highest above where it left the ground
};

class StepCounter {
 public:
  static constexpr double kMinFlight = 0.06;  // s
  static constexpr double kMinRise = 0.02;    // m

  StepCounter(int feet, double period) : feet_(feet), period_(period) {}

  // time: s; contact: ground contact per foot; height: z of each foot's contact point, m.
  StepEvent observe(double time, const bool* contact, const double* height) noexcept;

  std::int64_t steps() const noexcept { return steps_; }
  // True in the tick in which this foot came down after a counted flight.
  bool touched_down(int foot) const noexcept {
    return feet_state_[static_cast<std::size_t>(foot)].landed;
  }
  double worst_clearance() const noexcept { return worst_clearance_; }  // m, over counted steps

 private:
  struct Foot {
    bool in_contact = true;
    bool pending = false;  // came down after a real swing, a foot of `others` still stands
    bool landed = false;
    std::array<bool, core::kMaxContacts> others{};  // stood when it came down
    double left_at = 0.0;                           // s, first tick without contact
    double lift_height = 0.0;
    double rise = 0.0;
    double swing_time = 0.0, swing_rise = 0.0;  // of the last real swing
  };
  void note_others(Foot& foot, const bool* contact) const noexcept;
  bool took_over(const Foot& foot, const bool* contact) const noexcept;
  void settle(const bool* contact) noexcept;

  int feet_;
  double period_;
  std::array<Foot, core::kMaxContacts> feet_state_{};
  std::int64_t steps_ = 0;
  double worst_clearance_ = 1e9;
  bool first_ = true;
};

}  // namespace footfall::lab
