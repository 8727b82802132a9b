// Active tasks and their references; see control_merge.h. Contact transitions:
// contact_transition.cc.
#include "behaviors/machine/control_merge.h"

#include <algorithm>
#include <cmath>

#include "core/index.h"

namespace footfall::behaviors {
namespace {

// Maximum number of knots needed by the tasks of one control spec: the entry and the points of each
// axis.
std::size_t knot_capacity(const Behavior& behavior) {
  std::size_t most = 0;
  for (const ControlSpec& control : behavior.controls) {
    std::size_t knots = 0;
    for (int t = 0; t < control.tasks.count; ++t) {
      const TaskSpec& task = behavior.tasks[at(control.tasks.first + t)];
      const int points = task.reference.waypoints.count;
      if (points > 0) knots += at(task.axes.count * (points + 1));
    }
    most = std::max(most, knots);
  }
  return most;
}

// Copies only the used part of the arrays, which have room for far more.
void copy_in_force(const tasks::ControlSet& from, tasks::ControlSet& to) noexcept {
  to.contact_count = from.contact_count;
  to.task_count = from.task_count;
  to.axis_count = from.axis_count;
  to.internal_count = from.internal_count;
  std::copy_n(from.contacts.begin(), from.contact_count, to.contacts.begin());
  std::copy_n(from.tasks.begin(), from.task_count, to.tasks.begin());
  std::copy_n(from.axes.begin(), from.axis_count, to.axes.begin());
  std::copy_n(from.internals.begin(), from.internal_count, to.internals.begin());
}

void clear_fresh(tasks::ControlSet& set) noexcept {
  for (int i = 0; i < set.task_count; ++i) set.tasks[at(i)].fresh = false;
  for (int i = 0; i < set.axis_count; ++i) set.axes[at(i)].fresh = false;
}

}  // namespace

ControlMerge::ControlMerge(const Behavior& behavior, Statechart& statechart,
                           const model::ControlModel* model)
    : behavior_(behavior),
      statechart_(statechart),
      model_(model),
      primary_(std::make_unique<Bank>()),
      other_(std::make_unique<Bank>()),
      old_primary_(std::make_unique<Bank>()),
      old_other_(std::make_unique<Bank>()),
      old_set_(std::make_unique<tasks::ControlSet>()),
      old_other_set_(std::make_unique<tasks::ControlSet>()) {
  const std::size_t knots = knot_capacity(behavior);
  for (Bank* bank : {primary_.get(), other_.get(), old_primary_.get(), old_other_.get()}) {
    bank->knots.resize(knots);
  }
}

void ControlMerge::update(bool moved) noexcept {
  control_.transition_entered = false;
  clear_fresh(control_.primary);
  clear_fresh(control_.other);
  if (moved && changed()) rebuild();
  advance(*primary_, control_.primary);
  if (control_.has_other) advance(*other_, control_.other);
  weigh_transition();
}

// Whether the merged control belongs to another configuration, or a state that starts a reference
// or a contact transition was entered again.
bool ControlMerge::changed() const noexcept {
  if (taken_over_) return true;
  const ControlSpec& spec = behavior_.controls[at(statechart_.control())];
  if (primary_->spec != &spec) return true;
  for (int k = 0; k < primary_->task_count; ++k) {
    const TaskState& task = primary_->tasks[at(k)];
    if (task.owner_serial != statechart_.entry_serial(task.spec->reference.owner)) return true;
  }
  for (int k = 0; k < spec.internals.count; ++k) {
    const ReferenceSpec& reference = behavior_.internals[at(spec.internals.first + k)].reference;
    if (reference.kind == ReferenceSpec::Kind::trajectory &&
        primary_->forces[at(k)].owner_serial != statechart_.entry_serial(reference.owner)) {
      return true;
    }
  }
  return spec.transition >= 0 && !transition_goes_on(spec);
}

void ControlMerge::rebuild() noexcept {
  taken_over_ = false;
  const ControlSpec& spec = behavior_.controls[at(statechart_.control())];
  other_first_ = control_.has_other && control_.other_weight > 0.5 && !transition_goes_on(spec);
  old_has_other_ = control_.has_other;
  std::swap(primary_, old_primary_);
  std::swap(other_, old_other_);
  copy_in_force(control_.primary, *old_set_);
  if (old_has_other_) copy_in_force(control_.other, *old_other_set_);
  fill(*primary_, control_.primary, spec);
  update_transition(spec);
}

// A task before this tick (axis < 0), or one of its axes: searched first in the set with the
// greater weight.
ControlMerge::Kept ControlMerge::find_kept(int instance, int axis) const noexcept {
  for (const bool other : {other_first_, !other_first_}) {
    if (other && !old_has_other_) continue;
    const Bank& bank = other ? *old_other_ : *old_primary_;
    const tasks::ControlSet& set = other ? *old_other_set_ : *old_set_;
    if (bank.spec == nullptr) continue;
    for (int k = 0; k < bank.task_count; ++k) {
      const tasks::TaskCommand& task = set.tasks[at(k)];
      if (task.instance != instance) continue;
      if (axis < 0) return {&bank, &set, k, -1};
      for (int slot = task.first_axis; slot < task.first_axis + task.axis_count; ++slot) {
        if (set.axes[at(slot)].axis == axis) return {&bank, &set, k, slot};
      }
    }
  }
  return {};
}

void ControlMerge::fill(Bank& bank, tasks::ControlSet& set, const ControlSpec& spec) noexcept {
  bank.spec = &spec;
  bank.frozen = false;
  bank.reported = false;
  bank.task_count = spec.tasks.count;
  bank.knot_count = 0;
  set.contact_count = static_cast<int>(spec.contacts.size());
  std::copy(spec.contacts.begin(), spec.contacts.end(), set.contacts.begin());
  set.task_count = spec.tasks.count;
  set.axis_count = 0;
  for (int k = 0; k < spec.tasks.count; ++k) {
    fill_task(bank, set, behavior_.tasks[at(spec.tasks.first + k)], k);
  }
  fill_forces(bank, set, spec);
}

void ControlMerge::fill_task(Bank& bank, tasks::ControlSet& set, const TaskSpec& spec,
                             int index) noexcept {
  bank.tasks[at(index)] = {&spec, statechart_.entry_serial(spec.reference.owner)};
  tasks::TaskCommand& command = set.tasks[at(index)];
  command = {};
  command.instance = spec.instance;
  command.type = spec.type;
  command.point = spec.point;
  command.frame = spec.frame;
  command.priority = spec.priority;
  command.first_axis = set.axis_count;
  command.axis_count = spec.axes.count;
  command.fresh = find_kept(spec.instance, -1).task < 0;
  set.axis_count += spec.axes.count;
  for (int k = 0; k < spec.axes.count; ++k) {
    const int axis = behavior_.axes[at(spec.axes.first + k)].axis;
    const Kept kept = find_kept(spec.instance, axis);
    tasks::AxisCommand& out = set.axes[at(command.first_axis + k)];
    out = kept.slot < 0 ? tasks::AxisCommand{} : kept.set->axes[at(kept.slot)];
    out.axis = axis;
    out.slope = 0.0;
    out.fresh = kept.slot < 0;
    fill_axis(bank, set, command, spec, k, kept);
  }
  for (int k = 0; k < spec.axes.count; ++k) {  // when `entry` is known of all axes
    if (bank.axes[at(command.first_axis + k)].begins) start_axis(bank, command, spec, k);
  }
}

// By how much a position grows because the task's origin is another than before: `frame` or the
// stance contacts may have changed.
double ControlMerge::origin_moved(const tasks::ControlSet& set, const TaskSpec& spec, int axis,
                                  const Kept& kept) const noexcept {
  const TaskSpec& before = *kept.bank->tasks[at(kept.task)].spec;
  if (spec.frame != tasks::Frame::stance && before.frame == spec.frame) return 0.0;
  return measured(spec, set, axis) - measured(before, *kept.set, axis);
}

// The reference continues if its source and its state's entry are unchanged, whatever else of the
// task has changed; otherwise it starts from the last reference, or from the measurement. In either
// case it stays where it is in the world.
void ControlMerge::fill_axis(Bank& bank, const tasks::ControlSet& set,
                             const tasks::TaskCommand& command, const TaskSpec& spec, int k,
                             const Kept& kept) noexcept {
  const int axis = behavior_.axes[at(spec.axes.first + k)].axis;
  const int slot = command.first_axis + k;
  AxisState& state = bank.axes[at(slot)];
  state = {};
  state.begins = true;
  if (kept.slot < 0) {
    state.motion.pos = measured(spec, set, axis);
  } else {
    const TaskState& before = kept.bank->tasks[at(kept.task)];
    const AxisState& old = kept.bank->axes[at(kept.slot)];
    const double moved = origin_moved(set, spec, axis, kept);
    if (before.spec->reference.source == spec.reference.source &&
        before.owner_serial == statechart_.entry_serial(spec.reference.owner)) {
      state = old;
      bank.entry[at(slot)] = kept.bank->entry[at(kept.slot)] + moved;
      state.motion.pos += moved;
      shift(state.segment, moved);
      state.begins = false;
      state.first_knot = bank.knot_count;
      std::copy_n(kept.bank->knots.begin() + old.first_knot, old.knot_count,
                  bank.knots.begin() + state.first_knot);
      for (int i = 0; i < old.knot_count; ++i) bank.knots[at(state.first_knot + i)].pos += moved;
      bank.knot_count += state.knot_count;
      return;
    }
    state.motion = old.motion;
    state.motion.pos += moved;
  }
  bank.entry[at(slot)] = state.motion.pos;
}

void ControlMerge::advance(Bank& bank, tasks::ControlSet& set) noexcept {
  for (int k = 0; k < bank.task_count; ++k) advance_task(bank, set, k);
  advance_forces(bank, set);
}

void ControlMerge::advance_task(Bank& bank, tasks::ControlSet& set, int index) noexcept {
  const TaskSpec& spec = *bank.tasks[at(index)].spec;
  const tasks::TaskCommand& command = set.tasks[at(index)];
  const double* entry = &bank.entry[at(command.first_axis)];
  if (spec.reference.retarget > 0.0 && !bank.frozen) retarget(bank, spec, command);
  for (int k = 0; k < spec.axes.count; ++k) {
    const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
    tasks::AxisCommand& out = set.axes[at(command.first_axis + k)];
    out.kp = checked_gain(axis, axis.kp, 0, out.kp, bank, entry);
    out.ki = checked_gain(axis, axis.ki, 1, out.ki, bank, entry);
    out.kd = checked_gain(axis, axis.kd, 2, out.kd, bank, entry);
    const tasks::AxisCommand usual;
    out.weight = axis.weight < 0 ? usual.weight : value_or(axis.weight, out.weight, bank, entry);
    out.acceleration_limit =
        axis.acceleration_limit < 0
            ? usual.acceleration_limit
            : value_or(axis.acceleration_limit, out.acceleration_limit, bank, entry);
    out.integral_limit = axis.integral_limit < 0
                             ? usual.integral_limit
                             : value_or(axis.integral_limit, out.integral_limit, bank, entry);
    advance_axis(bank, command, spec, k, out);
  }
}

// The value of a slot or of an expression; the latter must be within gains.ranges, otherwise the
// previous value is kept.
double ControlMerge::checked_gain(const AxisSpec& axis, int slot, std::size_t gain, double before,
                                  Bank& bank, const double* entry) noexcept {
  if (slot >= 0) return statechart_.context().parameters[slot];
  if (axis.computed[gain] < 0) return 0.0;
  const double value = value_or(axis.computed[gain], before, bank, entry);
  const std::array<double, 2>& limits = behavior_.gain_limits[gain];
  if (value >= limits[0] && value <= limits[1]) return value;
  if (!bank.reported) {
    statechart_.report_execution_error(bad_value(axis.computed[gain], value, limits[0], limits[1]));
  }
  bank.reported = true;
  return std::clamp(before, limits[0], limits[1]);
}

double ControlMerge::value_or(int expression, double fallback, Bank& bank,
                              const double* entry) noexcept {
  if (expression < 0) return fallback;
  EvaluationContext context = statechart_.context();
  context.entry = entry;
  const double value = evaluate(behavior_.expressions, expression, context);
  if (std::isfinite(value)) return value;
  if (!bank.reported) statechart_.report_execution_error(bad_value(expression, value));
  bank.reported = true;
  return fallback;
}

}  // namespace footfall::behaviors
