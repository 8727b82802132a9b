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
// release, s); of a task instance: condition (ratio).
struct FaultPlace {
  int joint = -1;  // or contact, or task instance; -1: the fault has no place
  double value = 0.0;
  double excess = 0.0;  // beyond the limit; the largest is kept
};

// What one check found in one tick, as a set of faults.
struct FaultFindings {
  std::array<bool, core::kFaultCount> found{};
  std::array<FaultPlace, core::kFaultCount> place{};
  bool any = false;
  void add(core::Fault fault) noexcept {
    found[static_cast<std::size_t>(fault)] = true;
    any = true;
  }
  void add(core::Fault fault, const FaultPlace& where) noexcept {
    add(fault);
    FaultPlace& kept = place[static_cast<std::size_t>(fault)];
    if (kept.joint < 0 || where.excess > kept.excess) kept = where;
  }
  bool has(core::Fault fault) const noexcept { return found[static_cast<std::size_t>(fault)]; }
};

enum class LoopState : std::uint8_t {
  running,
  finished,  // the behavior reached a final state of its root
  fallen,
  stopped,  // a fault whose reaction is safe_stop
};

class FaultMonitor {
 public:
  explicit FaultMonitor(const behaviors::Behavior& behavior) : behavior_(behavior) {}

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
  std::array<FaultPlace, core::kFaultCount> last_place_{}, worst_place_{};
  core::Fault ended_by_ = core::Fault::count;
  core::Fault failed_by_ = core::Fault::count;
  LoopState state_ = LoopState::running;
  int overruns_ = 0;  // late ticks in a row
  bool probation_ = false;
};

}  // namespace footfall::engine
