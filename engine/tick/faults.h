// Faults of a run: which are present, how often each appeared, where it was worst, and the robot
// file's reaction to each. Every check of a tick reports here; nothing else reacts.
#pragma once

#include <array>

#include "behaviors/machine/machine.h"
#include "core/fault.h"

namespace footfall::engine {

// Where and how much, for faults of a joint: torque.limit (torque asked for, N m), torque.step
// (change since the last tick, N m), joint.limit (position, rad); of a contact: swing.long (time in
// the air, s), swing.contact (time under load, s), load.air (time since its
// release, s), slip (way along the ground, m); of a task instance: condition (ratio).
struct FaultPlace {
  int joint;  // or contact, or task instance; -1: the fault has no place
  double value;
  double excess;  // beyond the limit; the largest is kept
};
inline constexpr FaultPlace kWithoutPlace{-1, 0.0, 0.0};

// What one check found in one tick, as a set of faults. Six of them are made in a tick: only places
// of faults that were found have a value.
class FaultFindings {
 public:
  FaultFindings() noexcept {}  // NOLINT: place_ on purpose without a value

  void add(core::Fault fault, const FaultPlace& where = kWithoutPlace) noexcept {
    const auto f = static_cast<std::size_t>(fault);
    if (!found_[f] || where.excess > place_[f].excess) place_[f] = where;
    found_[f] = any_ = true;
  }
  bool any() const noexcept { return any_; }
  bool has(core::Fault fault) const noexcept { return found_[static_cast<std::size_t>(fault)]; }
  // Only of a fault that it has.
  const FaultPlace& place(core::Fault fault) const noexcept {
    return place_[static_cast<std::size_t>(fault)];
  }

 private:
  std::array<bool, core::kFaultCount> found_{};
  bool any_ = false;
  std::array<FaultPlace, core::kFaultCount> place_;
};

enum class LoopState : std::uint8_t {
  running,
  finished,  // the behavior reached a final state of its root
  fallen,
  stopped,  // a fault whose reaction is safe_stop
};

class FaultMonitor {
 public:
  explicit FaultMonitor(const behaviors::Behavior& behavior) : behavior_(behavior) {
    last_place_.fill(kWithoutPlace);
    worst_place_.fill(kWithoutPlace);
  }

  void begin_tick() noexcept;
  // A fault is counted and raised when it appears; it must go away before it counts again. Several
  // checks of a tick may find the same one.
  void take(const FaultFindings& findings, behaviors::Machine& machine) noexcept;

  // What the machine counted since the last tick: each one counts, a tick with any has one
  // reaction.
  void take_counts(behaviors::Machine& machine) noexcept;
  // Whether this tick began late. Each late one counts; as many in a row as the robot's
  // `limits.overruns` have the reaction of tick.overrun.
  void take_late(bool late, behaviors::Machine& machine) noexcept;

  // While on probation, a fault with a reaction, or an error.execution, is remembered and not
  // reacted to.
  void set_probation(bool on) noexcept;
  core::Fault failed_by() const noexcept { return failed_by_; }  // Fault::count: none yet

  // Goes on from the monitor of another loop on the same robot. forgive: grave faults that are
  // present count as new, so that they are reacted to if they stay.
  void take_over(const FaultMonitor& old, bool forgive) noexcept;

  LoopState state() const noexcept { return state_; }  // never finished: that is the machine's
  // The fault that made the state fallen or stopped; Fault::count: none did.
  core::Fault ended_by() const noexcept { return ended_by_; }
  const core::FaultCounters& counters() const noexcept { return counters_; }
  // Where a fault appeared last, and where it was worst; joint -1: no joint's, or none yet.
  const FaultPlace& last_place(core::Fault fault) const noexcept {
    return last_place_[static_cast<std::size_t>(fault)];
  }
  const FaultPlace& worst_place(core::Fault fault) const noexcept {
    return worst_place_[static_cast<std::size_t>(fault)];
  }

 private:
  bool is_grave(std::size_t fault) const noexcept;  // it ends the run or has a reaction
  core::Reaction reaction_to(core::Fault fault) const noexcept;
  void react(core::Fault fault, behaviors::Machine& machine) noexcept;

  const behaviors::Behavior& behavior_;
  core::FaultCounters counters_;
  core::FaultCounters of_machine_;                // known so far
  std::array<bool, core::kFaultCount> active_{};  // faults present in the previous tick
  std::array<bool, core::kFaultCount> seen_{};    // faults present in this one so far
  std::array<FaultPlace, core::kFaultCount> last_place_, worst_place_;
  core::Fault ended_by_ = core::Fault::count;
  core::Fault failed_by_ = core::Fault::count;
  LoopState state_ = LoopState::running;
  int overruns_ = 0;  // late ticks in a row
  bool probation_ = false;
};

}  // namespace footfall::engine
