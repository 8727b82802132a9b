// The control defined by the active configuration: contacts, tasks with references and gains,
// internal forces, and the second control law during a contact transition. Rebuilt when states with
// control change or are entered again, evaluated in every tick; allocates nothing after
// construction.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/machine/machine.h"
#include "behaviors/statechart/statechart.h"
#include "model/height_surface.h"

namespace footfall::behaviors {

struct TakeOverMap;

class ControlMerge {
 public:
  // model: what tasks measure; nullptr: every task measures 0.
  ControlMerge(const Behavior& behavior, Statechart& statechart, const model::ControlModel* model);

  // After the statechart's tick; `moved`: a transition was taken (or this is the first tick).
  void update(bool moved) noexcept;
  const tasks::ActiveControl& control() const noexcept { return control_; }
  // Bumpless transfer from the control of another behavior (control_take_over.cc), after that of
  // the statechart. same_configuration: the configuration is unchanged; otherwise active references
  // start anew.
  void take_over(const ControlMerge& old, const TakeOverMap& map, bool same_configuration) noexcept;
  // The world's walking surface, flat by default; set before the first update.
  void set_surface(const model::HeightSurface& surface) { surface_ = surface; }

 private:
  // One active task: the source of its reference and its start.
  struct TaskState {
    const TaskSpec* spec = nullptr;
    std::uint32_t owner_serial = 0;
  };
  struct AxisState {
    Segment segment;
    std::int64_t start_tick = 0;         // of the segment; changes with a new `to`
    double over = 0.0;                   // s, duration of the whole trajectory
    Motion motion;                       // current reference
    bool begins = false;                 // the reference starts in this tick
    int first_knot = 0, knot_count = 0;  // waypoints: indices into Bank::knots
    double angle = 0.0, rate = 0.0;      // ellipse: rad since entry, rad/s
    double ramp = 0.0;                   // ellipse: s
    std::int64_t last_tick = 0;          // ellipse: of the angle
  };
  // An internal force's reference, N at each contact.
  struct ForceState {
    int source = -1;  // ReferenceSpec::source
    std::uint32_t owner_serial = 0;
    Segment segment;
    std::int64_t start_tick = 0;
    double entry = 0.0;  // at the start of the reference
    double value = 0.0;  // in force; by statics: of the last tick that was not
    bool by_statics = false;
    double scale = 1.0;  // mean force over what the behavior writes, of the last tick
  };
  // One set of active tasks, with the same numbering as its tasks::ControlSet.
  struct Bank {
    const ControlSpec* spec = nullptr;
    bool frozen = false;    // references are kept constant
    bool reported = false;  // a non-finite value was reported
    int task_count = 0;
    std::array<TaskState, core::kMaxTasks> tasks{};
    std::array<AxisState, core::kMaxAxes> axes{};
    std::array<double, core::kMaxAxes> entry{};  // start values of the references
    std::array<ForceState, core::kMaxInternal> forces{};
    std::vector<Knot> knots;  // sized at load
    int knot_count = 0;
  };
  // A task, or one of its axes (slot), before this tick.
  struct Kept {
    const Bank* bank = nullptr;
    const tasks::ControlSet* set = nullptr;
    int task = -1;
    int slot = -1;
  };

  // Whether this tick's transitions may have changed the merged control; otherwise rebuild() is
  // skipped.
  bool changed() const noexcept;
  void rebuild() noexcept;
  // The contact transition under way is still the one that is asked for.
  bool transition_goes_on(const ControlSpec& spec) const noexcept;
  const TaskSpec* successor(const TaskSpec& old, const ControlSpec& spec,
                            const TakeOverMap& map) const noexcept;
  bool take_bank(Bank& bank, tasks::ControlSet& set, const ControlMerge& from, const Bank& old,
                 const ControlSpec& spec, const TakeOverMap& map) noexcept;
  void update_transition(const ControlSpec& spec) noexcept;
  void begin_transition(const TransitionSpec& transition) noexcept;
  void fill(Bank& bank, tasks::ControlSet& set, const ControlSpec& spec) noexcept;
  // References of internal forces (force_reference.cc).
  void fill_forces(Bank& bank, tasks::ControlSet& set, const ControlSpec& spec) noexcept;
  void start_force(Bank& bank, ForceState& state, const InternalSpec& spec) noexcept;
  void advance_forces(Bank& bank, tasks::ControlSet& set) noexcept;
  const ForceState* find_kept_force(const tasks::InternalCommand& command) const noexcept;
  bool take_forces(Bank& bank, tasks::ControlSet& set, const ControlMerge& from, const Bank& old,
                   const ControlSpec& spec, const TakeOverMap& map) noexcept;
  void fill_task(Bank& bank, tasks::ControlSet& set, const TaskSpec& spec, int index) noexcept;
  void fill_axis(Bank& bank, const tasks::ControlSet& set, const tasks::TaskCommand& command,
                 const TaskSpec& spec, int k, const Kept& kept) noexcept;
  double origin_moved(const tasks::ControlSet& set, const TaskSpec& spec, int axis,
                      const Kept& kept) const noexcept;
  Kept find_kept(int instance, int axis) const noexcept;
  void advance(Bank& bank, tasks::ControlSet& set) noexcept;
  void advance_task(Bank& bank, tasks::ControlSet& set, int index) noexcept;
  // References (reference.cc). `k`: which axis of the task. Position (m or rad) of one axis of a
  // task type, in the world; velocity (m/s): of those that are positions.
  double position(tasks::TaskType type, int point, int axis) const noexcept;
  double velocity(tasks::TaskType type, int point, int axis) const noexcept;
  double measured(const TaskSpec& spec, const tasks::ControlSet& set, int axis) const noexcept;
  void start_axis(Bank& bank, const tasks::TaskCommand& command, const TaskSpec& spec,
                  int k) noexcept;
  void start_waypoints(Bank& bank, const tasks::TaskCommand& command, const TaskSpec& spec, int k,
                       double over) noexcept;
  void advance_axis(Bank& bank, const tasks::TaskCommand& command, const TaskSpec& spec, int k,
                    tasks::AxisCommand& out) noexcept;
  Motion sample_axis(Bank& bank, const tasks::TaskCommand& command, const TaskSpec& spec, int k,
                     tasks::AxisCommand& out) noexcept;
  double checked_gain(const AxisSpec& axis, int slot, std::size_t gain, double before, Bank& bank,
                      const double* entry) noexcept;
  void retarget(Bank& bank, const TaskSpec& spec, const tasks::TaskCommand& command) noexcept;
  void weigh_transition() noexcept;
  double value_or(int expression, double fallback, Bank& bank, const double* entry) noexcept;

  const Behavior& behavior_;
  Statechart& statechart_;
  const model::ControlModel* model_;
  std::unique_ptr<Bank> primary_, other_, old_primary_, old_other_;
  std::unique_ptr<tasks::ControlSet> old_set_, old_other_set_;
  tasks::ActiveControl control_;
  model::HeightSurface surface_;
  bool old_has_other_ = false;
  bool taken_over_ = false;   // the sets still have the layout of another behavior
  bool stays_ = false;        // after a transfer: the configuration is the same
  bool other_first_ = false;  // the second law has the greater weight: its references are kept
  int transition_ = -1;       // into Behavior::contact_transitions
  std::uint32_t transition_serial_ = 0;
  std::int64_t transition_periods_ = 0;
};

}  // namespace footfall::behaviors
