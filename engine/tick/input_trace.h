// What reaches a tick from outside besides the sensors: parameters written and whether that limits
// the torque's steps, events raised, planners' answers, whether it began late. A trace records it
// for the log; replay puts it back at the same place in the tick.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "behaviors/machine/machine.h"

namespace footfall::engine {

// Of one tick; room for everything is made once, by size_for().
struct InputTrace {
  std::vector<behaviors::SlotValue> writes;  // since the machine's last tick, whoever wrote
  std::vector<int> events;                   // raised from outside, in order
  std::vector<behaviors::PlanAnswer> plans;  // handed to the machine in this tick
  bool limit_steps = false;                  // torque steps are limited in this tick
  bool late = false;                         // the tick began late
  bool requests_lost = false;                // of scripts, whose queue was full
  bool scripts_stuck = false;                // one does not come back
  // Of a replay:
  std::vector<behaviors::PlanAnswer> planned;  // what the planners themselves gave
  std::function<void()> inspect;               // called just before the machine's tick, if there

  void size_for(const behaviors::Behavior& behavior);
  void clear() noexcept;
  bool empty() const noexcept {
    return writes.empty() && events.empty() && plans.empty() && !limit_steps && !late &&
           !requests_lost && !scripts_stuck;
  }
};

// Notices every write to the parameters from outside of the machine by comparing bit for bit, so
// that no way in can be forgotten.
class WriteWatch {
 public:
  explicit WriteWatch(const behaviors::Behavior& behavior) : known_(behavior.values) {}
  // Just before the machine's tick: what differs from what is known goes to `writes`.
  void find(std::span<const double> parameters, std::vector<behaviors::SlotValue>& writes) noexcept;
  // Just after it.
  void remember(std::span<const double> parameters) noexcept;

 private:
  std::vector<double> known_;
};

}  // namespace footfall::engine
