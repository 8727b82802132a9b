// References of internal forces: start, current values, gains; see control_merge.h.
#include <algorithm>
#include <cmath>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/machine/control_merge.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

bool same_force(const tasks::InternalCommand& a, const tasks::InternalCommand& b) noexcept {
  return a.instance == b.instance && a.contact_count == b.contact_count && a.contacts == b.contacts;
}

}  // namespace

// The same force before this tick, searched first in the set with the greater weight; nullptr:
// none.
const ControlMerge::ForceState* ControlMerge::find_kept_force(
    const tasks::InternalCommand& command) const noexcept {
  for (const bool other : {other_first_, !other_first_}) {
    if (other && !old_has_other_) continue;
    const Bank& bank = other ? *old_other_ : *old_primary_;
    const tasks::ControlSet& set = other ? *old_other_set_ : *old_set_;
    if (bank.spec == nullptr) continue;
    for (int k = 0; k < set.internal_count; ++k) {
      if (same_force(set.internals[at(k)], command)) return &bank.forces[at(k)];
    }
  }
  return nullptr;
}

// As with tasks: a trajectory goes on if its source and its state's entry are unchanged; otherwise
// it starts from the last reference, or from 0 N.
void ControlMerge::fill_forces(Bank& bank, tasks::ControlSet& set,
                               const ControlSpec& spec) noexcept {
  set.internal_count = spec.internals.count;
  for (int k = 0; k < spec.internals.count; ++k) {
    const InternalSpec& force = behavior_.internals[at(spec.internals.first + k)];
    tasks::InternalCommand& command = set.internals[at(k)];
    command = {};
    command.instance = force.instance;
    command.contact_count = force.contact_count;
    command.contacts = force.contacts;
    command.bandwidth = kInternalBandwidth;
    command.scale = force.scale;
    ForceState& state = bank.forces[at(k)];
    const ForceState* kept = find_kept_force(command);
    const std::uint32_t serial = statechart_.entry_serial(force.reference.owner);
    const bool goes_on =
        kept != nullptr && kept->source == force.reference.source && kept->owner_serial == serial;
    state = kept == nullptr ? ForceState{} : *kept;
    state.source = force.reference.source;
    state.owner_serial = serial;
    if (state.by_statics) {  // the controller's, of the last tick
      const double last =
          statechart_.context().signals[behavior_.layout.internal[at(force.instance)].reference];
      if (std::isfinite(last)) state.value = state.scale * last;
    }
    state.by_statics = force.statics >= 0;
    state.scale = force.scale;
    if (!goes_on) start_force(bank, state, force);
  }
}

void ControlMerge::start_force(Bank& bank, ForceState& state, const InternalSpec& spec) noexcept {
  state.entry = state.value;
  if (spec.reference.kind != ReferenceSpec::Kind::trajectory) return;
  state.start_tick = statechart_.context().tick;
  const double entry = state.entry / spec.scale;
  const double over = value_or(spec.reference.over, 0.0, bank, &entry);
  const double to = value_or(spec.value, entry, bank, &entry);
  const double end = value_or(spec.end_velocity, 0.0, bank, &entry);
  state.segment = make_segment(spec.reference.shape, {state.entry, 0.0, 0.0}, spec.scale * to,
                               spec.scale * end, over);
}

void ControlMerge::advance_forces(Bank& bank, tasks::ControlSet& set) noexcept {
  const EvaluationContext& context = statechart_.context();
  for (int k = 0; k < bank.spec->internals.count; ++k) {
    const InternalSpec& spec = behavior_.internals[at(bank.spec->internals.first + k)];
    tasks::InternalCommand& command = set.internals[at(k)];
    ForceState& state = bank.forces[at(k)];
    const double entry = state.entry / spec.scale;
    const auto value = [&](int expression, double before) {
      return value_or(expression, before, bank, &entry);
    };
    if (spec.reference.kind == ReferenceSpec::Kind::trajectory) {
      const auto ticks = static_cast<double>(context.tick - state.start_tick);
      if (!bank.frozen) state.value = sample(state.segment, ticks * context.period).pos;
    } else if (spec.statics >= 0) {
      command.statics = value(spec.statics, command.statics);
    } else if (!bank.frozen) {
      state.value = spec.scale * value(spec.value, state.value / spec.scale);
    }
    command.reference = state.value;
    command.feedback = value(spec.feedback, command.feedback);
    command.integral = value(spec.integral, command.integral);
    if (spec.integral_limit >= 0) {
      command.integral_limit =
          spec.scale * value(spec.integral_limit, command.integral_limit / spec.scale);
    }
    command.bandwidth = value(spec.bandwidth, command.bandwidth);
    command.ramp = value(spec.ramp, command.ramp);
  }
}

// Whether every force found its successor in its place.
bool ControlMerge::take_forces(Bank& bank, tasks::ControlSet& set, const ControlMerge& from,
                               const Bank& old, const ControlSpec& spec,
                               const TakeOverMap& map) noexcept {
  bool whole = spec.internals.count == set.internal_count;
  bank.forces = old.forces;
  for (int k = 0; k < set.internal_count; ++k) {
    tasks::InternalCommand& command = set.internals[at(k)];
    command.instance = map.internals[at(command.instance)];
    if (!whole) continue;
    const InternalSpec& now = behavior_.internals[at(spec.internals.first + k)];
    whole = now.instance == command.instance && now.contacts == command.contacts &&
            now.contact_count == command.contact_count;
    if (!whole || old.spec == nullptr || k >= old.spec->internals.count) continue;
    const ReferenceSpec& before =
        from.behavior_.internals[at(old.spec->internals.first + k)].reference;
    const bool on = stays_ && before.kind == now.reference.kind &&
                    before.shape == now.reference.shape &&
                    old.forces[at(k)].owner_serial == from.statechart_.entry_serial(before.owner);
    const std::uint32_t serial = statechart_.entry_serial(now.reference.owner);
    bank.forces[at(k)].source = now.reference.source;
    bank.forces[at(k)].owner_serial = on ? serial : serial - 1;
    command.scale = now.scale;
  }
  return whole;
}

}  // namespace footfall::behaviors
