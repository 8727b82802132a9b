// The control that the active configuration asks for: contacts, tasks with references and gains,
// internal forces, and the other control law while a contact transition is under way. Rebuilt when
// states change, evaluated in every tick; allocates nothing after construction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "behaviors/behavior.h"
#include "behaviors/machine.h"
#include "behaviors/statechart.h"

namespace footfall::behaviors {

class ControlMerge {
 public:
  ControlMerge(const Behavior& behavior, Statechart& statechart);

  // After the statechart's tick; `moved`: a transition was taken (or this is the first tick).
  void update(const Measure& measure, bool moved) noexcept;
  const tasks::ActiveControl& control() const noexcept { return control_; }

 private:
  // One task in force: whose reference it follows since when.
  struct TaskState {
    const TaskSpec* spec = nullptr;
    std::uint32_t owner_serial = 0;
    std::int64_t start_tick = 0;
  };
  struct AxisState {
    Segment segment;
    std::int64_t start_tick = 0;  // of the segment; later than the task's after a new `to`
    double over = 0.0;            // s, of the whole trajectory
    Motion motion;                // the reference in force
  };
  // One set of tasks in force, with the same numbering as its tasks::ControlSet.
  struct Bank {
    const ControlSpec* spec = nullptr;
    bool frozen = false;    // references stay as they are
    bool reported = false;  // a value that is not finite was reported
    int task_count = 0;
    std::array<TaskState, core::kMaxTasks> tasks{};
    std::array<AxisState, core::kMaxAxes> axes{};
    std::array<double, core::kMaxAxes> entry{};  // what each reference started from
  };
  struct Kept {
    const Bank* bank = nullptr;
    const tasks::ControlSet* set = nullptr;
    int task = -1;
  };

  void rebuild(const Measure& measure) noexcept;
  void update_transition(const ControlSpec& spec, const Measure& measure) noexcept;
  void begin_transition(const TransitionSpec& transition, const Measure& measure) noexcept;
  void fill(Bank& bank, tasks::ControlSet& set, const ControlSpec& spec,
            const Measure& measure) noexcept;
  void fill_task(Bank& bank, tasks::ControlSet& set, const TaskSpec& spec, int index,
                 const Measure& measure) noexcept;
  void start_reference(Bank& bank, const tasks::TaskCommand& command,
                       const TaskSpec& spec) noexcept;
  Kept find_kept(int instance) const noexcept;
  void advance(Bank& bank, tasks::ControlSet& set) noexcept;
  void advance_task(Bank& bank, tasks::ControlSet& set, int index) noexcept;
  void retarget(Bank& bank, const TaskSpec& spec, const tasks::TaskCommand& command) noexcept;
  void weigh_transition() noexcept;
  double value_or(int expression, double fallback, Bank& bank, const double* entry) noexcept;

  const Behavior& behavior_;
  Statechart& statechart_;
  std::unique_ptr<Bank> primary_, other_, old_primary_, old_other_;
  std::unique_ptr<tasks::ControlSet> old_set_, old_other_set_;
  tasks::ActiveControl control_;
  bool old_has_other_ = false;
  bool other_first_ = false;  // the other law has the greater weight: what it holds is kept
  int transition_ = -1;       // into Behavior::contact_transitions
  std::uint32_t transition_serial_ = 0;
  std::int64_t transition_periods_ = 0;
};

}  // namespace footfall::behaviors
