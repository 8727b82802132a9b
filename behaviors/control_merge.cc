// Tasks in force and their references; see control_merge.h. Contact transitions:
// control_transition.cc.
#include "behaviors/control_merge.h"

#include <algorithm>
#include <cmath>

namespace footfall::behaviors {
namespace {

std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

}  // namespace

ControlMerge::ControlMerge(const Behavior& behavior, Statechart& statechart)
    : behavior_(behavior),
      statechart_(statechart),
      primary_(std::make_unique<Bank>()),
      other_(std::make_unique<Bank>()),
      old_primary_(std::make_unique<Bank>()),
      old_other_(std::make_unique<Bank>()),
      old_set_(std::make_unique<tasks::ControlSet>()),
      old_other_set_(std::make_unique<tasks::ControlSet>()) {}

void ControlMerge::update(const Measure& measure, bool moved) noexcept {
  control_.transition_entered = false;
  if (moved) {
    rebuild(measure);
  } else {
    for (int i = 0; i < control_.primary.task_count; ++i)
      control_.primary.tasks[at(i)].fresh = false;
    for (int i = 0; i < control_.other.task_count; ++i) control_.other.tasks[at(i)].fresh = false;
  }
  advance(*primary_, control_.primary);
  if (control_.has_other) advance(*other_, control_.other);
  weigh_transition();
}

void ControlMerge::rebuild(const Measure& measure) noexcept {
  other_first_ = control_.has_other && control_.other_weight > 0.5;
  old_has_other_ = control_.has_other;
  std::swap(primary_, old_primary_);
  std::swap(other_, old_other_);
  std::swap(*old_set_, control_.primary);
  if (old_has_other_) std::swap(*old_other_set_, control_.other);
  const ControlSpec& spec = behavior_.controls[at(statechart_.control())];
  fill(*primary_, control_.primary, spec, measure);
  update_transition(spec, measure);
}

// The task as it was in force before: in the set with the greater weight first.
ControlMerge::Kept ControlMerge::find_kept(int instance) const noexcept {
  for (const bool other : {other_first_, !other_first_}) {
    if (other && !old_has_other_) continue;
    const Bank& bank = other ? *old_other_ : *old_primary_;
    if (bank.spec == nullptr) continue;
    for (int k = 0; k < bank.task_count; ++k) {
      if (bank.tasks[at(k)].spec->instance == instance) {
        return {&bank, other ? old_other_set_.get() : old_set_.get(), k};
      }
    }
  }
  return {};
}

void ControlMerge::fill(Bank& bank, tasks::ControlSet& set, const ControlSpec& spec,
                        const Measure& measure) noexcept {
  bank.spec = &spec;
  bank.frozen = false;
  bank.reported = false;
  bank.task_count = spec.tasks.count;
  set.contact_count = static_cast<int>(spec.contacts.size());
  std::copy(spec.contacts.begin(), spec.contacts.end(), set.contacts.begin());
  set.task_count = spec.tasks.count;
  set.axis_count = 0;
  for (int k = 0; k < spec.tasks.count; ++k) {
    fill_task(bank, set, behavior_.tasks[at(spec.tasks.first + k)], k, measure);
  }
  set.internal_count = spec.internals.count;
  for (int k = 0; k < spec.internals.count; ++k) {
    const InternalSpec& internal = behavior_.internals[at(spec.internals.first + k)];
    set.internals[at(k)] = {internal.instance, internal.contact_a, internal.contact_b, 0.0, 0.0};
  }
}

void ControlMerge::fill_task(Bank& bank, tasks::ControlSet& set, const TaskSpec& spec, int index,
                             const Measure& measure) noexcept {
  const Kept kept = find_kept(spec.instance);
  TaskState& task = bank.tasks[at(index)];
  task = {&spec, statechart_.entry_serial(spec.reference.owner), statechart_.context().tick};
  tasks::TaskCommand& command = set.tasks[at(index)];
  command = {};
  command.instance = spec.instance;
  command.type = spec.type;
  command.point = spec.point;
  command.frame = spec.frame;
  command.priority = spec.priority;
  command.first_axis = set.axis_count;
  command.axis_count = spec.axes.count;
  command.fresh = kept.task < 0;
  set.axis_count += spec.axes.count;
  const TaskState* before = kept.task < 0 ? nullptr : &kept.bank->tasks[at(kept.task)];
  const int before_first = before == nullptr ? 0 : kept.set->tasks[at(kept.task)].first_axis;
  const bool same = before != nullptr && before->spec->axes.first == spec.axes.first &&
                    before->owner_serial == task.owner_serial;
  for (int k = 0; k < spec.axes.count; ++k) {
    const int axis = behavior_.axes[at(spec.axes.first + k)].axis;
    const int slot = command.first_axis + k;
    set.axes[at(slot)] = {};
    set.axes[at(slot)].axis = axis;
    AxisState& state = bank.axes[at(slot)];
    if (same) {  // the reference goes on as it was
      state = kept.bank->axes[at(before_first + k)];
      bank.entry[at(slot)] = kept.bank->entry[at(before_first + k)];
      continue;
    }
    state = {};
    state.motion.pos = measure.position(spec.type, spec.point, axis);
    for (int j = 0; before != nullptr && j < before->spec->axes.count; ++j) {
      if (behavior_.axes[at(before->spec->axes.first + j)].axis == axis) {
        state.motion = kept.bank->axes[at(before_first + j)].motion;
      }
    }
    bank.entry[at(slot)] = state.motion.pos;
  }
  if (same) {
    task.start_tick = before->start_tick;
  } else {
    start_reference(bank, command, spec);
  }
}

// `over` and `to` are read here, at entry; a value that is not finite makes the axis stay.
void ControlMerge::start_reference(Bank& bank, const tasks::TaskCommand& command,
                                   const TaskSpec& spec) noexcept {
  if (spec.reference.kind != ReferenceSpec::Kind::trajectory) return;
  const double* entry = &bank.entry[at(command.first_axis)];
  const double over = value_or(spec.reference.over, 0.0, bank, entry);
  for (int k = 0; k < spec.axes.count; ++k) {
    const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
    AxisState& state = bank.axes[at(command.first_axis + k)];
    const double to = value_or(axis.value, state.motion.pos, bank, entry);
    const double end = value_or(axis.end_velocity, 0.0, bank, entry);
    state.start_tick = statechart_.context().tick;
    state.over = over;
    state.segment = make_segment(spec.reference.shape, state.motion, to, end, over);
  }
}

void ControlMerge::advance(Bank& bank, tasks::ControlSet& set) noexcept {
  for (int k = 0; k < bank.task_count; ++k) advance_task(bank, set, k);
  const ControlSpec& spec = *bank.spec;
  for (int k = 0; k < spec.internals.count; ++k) {
    const InternalSpec& internal = behavior_.internals[at(spec.internals.first + k)];
    tasks::InternalCommand& command = set.internals[at(k)];
    command.reference =
        internal.scale *
        value_or(internal.reference, command.reference / internal.scale, bank, nullptr);
    command.feedback = value_or(internal.feedback, command.feedback, bank, nullptr);
  }
}

void ControlMerge::advance_task(Bank& bank, tasks::ControlSet& set, int index) noexcept {
  const TaskSpec& spec = *bank.tasks[at(index)].spec;
  tasks::TaskCommand& command = set.tasks[at(index)];
  const double* entry = &bank.entry[at(command.first_axis)];
  const double* values = statechart_.context().parameters;
  const auto gain = [values](int slot) { return slot < 0 ? 0.0 : values[slot]; };
  command.weight = value_or(spec.weight, 1.0, bank, entry);
  command.acceleration_limit = value_or(spec.acceleration_limit, 0.0, bank, entry);
  command.integral_limit = value_or(spec.integral_limit, 0.0, bank, entry);
  if (spec.reference.retarget > 0.0 && !bank.frozen) retarget(bank, spec, command);
  for (int k = 0; k < spec.axes.count; ++k) {
    const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
    AxisState& state = bank.axes[at(command.first_axis + k)];
    if (!bank.frozen && spec.reference.kind == ReferenceSpec::Kind::value) {
      state.motion = {value_or(axis.value, state.motion.pos, bank, entry), 0.0, 0.0};
    } else if (!bank.frozen && spec.reference.kind == ReferenceSpec::Kind::trajectory) {
      const EvaluationContext& context = statechart_.context();
      state.motion = sample(state.segment,
                            static_cast<double>(context.tick - state.start_tick) * context.period);
    }
    tasks::AxisCommand& out = set.axes[at(command.first_axis + k)];
    out.kp = gain(axis.kp);
    out.ki = gain(axis.ki);
    out.kd = gain(axis.kd);
    const bool free = spec.reference.kind == ReferenceSpec::Kind::none;  // damping: velocity 0
    out.ref = free ? 0.0 : state.motion.pos;
    out.ref_vel = free ? 0.0 : state.motion.vel;
    out.ref_acc = free ? 0.0 : state.motion.acc;
  }
}

// A changed `to` starts a new segment from where the reference is, for the time that is left.
void ControlMerge::retarget(Bank& bank, const TaskSpec& spec,
                            const tasks::TaskCommand& command) noexcept {
  const EvaluationContext& context = statechart_.context();
  const double* entry = &bank.entry[at(command.first_axis)];
  for (int k = 0; k < spec.axes.count; ++k) {
    const AxisSpec& axis = behavior_.axes[at(spec.axes.first + k)];
    AxisState& state = bank.axes[at(command.first_axis + k)];
    if (axis.value < 0 || state.segment.shape == Shape::hold) continue;
    const double to = value_or(axis.value, state.segment.to, bank, entry);
    const double t = static_cast<double>(context.tick - state.start_tick) * context.period;
    const double left = state.segment.duration - t;
    if (to == state.segment.to || left < (1.0 - spec.reference.retarget) * state.over) continue;
    const Shape shape =
        spec.reference.shape == Shape::polynomial3 ? Shape::polynomial3 : Shape::polynomial5;
    const Motion now = sample(state.segment, t);
    state.segment = make_segment(shape, now, to, state.segment.end_velocity, left);
    state.start_tick = context.tick;
  }
}

double ControlMerge::value_or(int expression, double fallback, Bank& bank,
                              const double* entry) noexcept {
  if (expression < 0) return fallback;
  EvaluationContext context = statechart_.context();
  context.entry = entry;
  const double value = evaluate(behavior_.expressions, expression, context);
  if (std::isfinite(value)) return value;
  if (!bank.reported) statechart_.report_execution_error();
  bank.reported = true;
  return fallback;
}

}  // namespace footfall::behaviors
