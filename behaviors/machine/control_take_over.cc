// Bumpless transfer of the control to another behavior; see behaviors/compiled/take_over_map.h. The
// old sets are kept in their layout; the next update merges them into the new control, as after a
// transition.
#include <algorithm>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/machine/control_merge.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

const ControlSpec kOther;  // represents a control of another behavior

// A running trajectory continues with changed parameters if its kind is the same.
bool goes_on(const TaskSpec& old, const TaskSpec& now) noexcept {
  const ReferenceSpec& a = old.reference;
  const ReferenceSpec& b = now.reference;
  return a.kind == b.kind && a.shape == b.shape && a.waypoints.count == b.waypoints.count;
}

}  // namespace

// The task of a control spec that continues `old`; nullptr if absent.
const TaskSpec* ControlMerge::successor(const TaskSpec& old, const ControlSpec& spec,
                                        const TakeOverMap& map) const noexcept {
  const int instance = map.instances[at(old.instance)];
  for (int k = 0; instance >= 0 && k < spec.tasks.count; ++k) {
    const TaskSpec& task = behavior_.tasks[at(spec.tasks.first + k)];
    if (task.instance == instance) return task.frame == old.frame ? &task : nullptr;
  }
  return nullptr;
}

void ControlMerge::take_over(const ControlMerge& old, const TakeOverMap& map,
                             bool same_configuration) noexcept {
  const ControlSpec& spec = behavior_.controls[at(statechart_.control())];
  control_ = old.control_;
  control_.has_other = false;
  control_.transition_entered = false;
  control_.other_weight = 0.0;
  control_.moving_contact_count = 0;
  taken_over_ = true;
  stays_ = same_configuration;
  primary_->spec = nullptr;
  if (old.primary_->spec != nullptr) {
    const bool whole = take_bank(*primary_, control_.primary, old, *old.primary_, spec, map);
    primary_->spec = whole ? &spec : &kOther;
  }
  // A contact transition that is already complete in its state does not begin again.
  transition_ = spec.transition;
  if (transition_ < 0) return;
  const TransitionSpec& transition = behavior_.contact_transitions[at(transition_)];
  transition_serial_ = statechart_.entry_serial(transition.owner);
  if (!old.control_.has_other || !map.same_controls || !stays_) return;
  const auto index = old.other_->spec - old.behavior_.controls.data();
  const ControlSpec& other = behavior_.controls[static_cast<std::size_t>(index)];
  control_.other = old.control_.other;
  if (!take_bank(*other_, control_.other, old, *old.other_, other, map)) return;
  other_->spec = &other;
  control_.has_other = true;
  control_.other_weight = old.control_.other_weight;
  control_.moving_contact_count = old.control_.moving_contact_count;
  transition_periods_ = old.transition_periods_;
}

// Whether every task found its successor, so that the reference set is complete.
bool ControlMerge::take_bank(Bank& bank, tasks::ControlSet& set, const ControlMerge& from,
                             const Bank& old, const ControlSpec& spec,
                             const TakeOverMap& map) noexcept {
  bool whole = take_forces(bank, set, from, old, spec, map);
  whole &= spec.tasks.count == old.task_count;
  bank.frozen = old.frozen;
  bank.reported = false;
  bank.task_count = old.task_count;
  std::copy_n(old.axes.begin(), set.axis_count, bank.axes.begin());
  std::copy_n(old.entry.begin(), set.axis_count, bank.entry.begin());
  const bool room = at(old.knot_count) <= bank.knots.size();
  bank.knot_count = room ? old.knot_count : 0;
  std::copy_n(old.knots.begin(), bank.knot_count, bank.knots.begin());
  for (int k = 0; k < old.task_count; ++k) {
    const TaskSpec& before = *old.tasks[at(k)].spec;
    const TaskSpec* now = successor(before, spec, map);
    whole &= now != nullptr && now == &behavior_.tasks[at(spec.tasks.first + k)] &&
             now->axes.count == before.axes.count;
    set.tasks[at(k)].instance = now == nullptr ? -1 : now->instance;
    if (now == nullptr) continue;
    const std::uint32_t serial = statechart_.entry_serial(now->reference.owner);
    const bool same_stay = stays_ && old.tasks[at(k)].owner_serial ==
                                         from.statechart_.entry_serial(before.reference.owner);
    const bool points = before.reference.waypoints.count > 0;
    const bool on = same_stay && goes_on(before, *now) && (room || !points);
    bank.tasks[at(k)] = {now, on ? serial : serial - 1};
  }
  return whole;
}

}  // namespace footfall::behaviors
