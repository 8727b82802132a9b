// Statechart, planner calls and control of one behavior; see machine.h.
#include "behaviors/machine/machine.h"

#include <algorithm>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/machine/control_merge.h"
#include "behaviors/machine/planner_calls.h"
#include "behaviors/statechart/statechart.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {
constexpr int kOutsideCapacity = 128;
}  // namespace

struct Machine::Impl {
  Impl(const Behavior& b, core::SignalTable& s, const model::ControlModel* model)
      : behavior(b),
        signals(s),
        values(b.values),
        known_values(b.values),
        statechart(b, s.values(), values),
        control(b, statechart, model),
        planners(b, statechart, s, values),
        outside(kOutsideCapacity) {
    fault_events.reserve(2 * core::kFaultCount);
    lost.reserve(kOutsideCapacity);
  }

  void raise_events() noexcept;
  void raise_contacts(bool edges) noexcept;
  void raise_parameters() noexcept;

  const Behavior& behavior;
  core::SignalTable& signals;
  std::vector<double> values;        // parameters and gains
  std::vector<double> known_values;  // at the last tick, to detect parameter.changed
  Statechart statechart;
  ControlMerge control;
  PlannerCalls planners;
  EventQueue outside;
  std::vector<int> lost;  // outside events of this tick that found the queue full
  std::vector<int> fault_events;
  std::array<bool, core::kMaxContacts> contact{};
  bool started = false;
  double steps = 0.0;
};

Machine::Machine(const Behavior& behavior, core::SignalTable& signals,
                 const model::ControlModel* model)
    : impl_(std::make_unique<Impl>(behavior, signals, model)) {}
Machine::~Machine() = default;

void Machine::set_surface(const model::HeightSurface& surface) {
  impl_->control.set_surface(surface);
}

void Machine::start() noexcept {
  impl_->raise_contacts(false);
  impl_->planners.start();
  impl_->statechart.start(0);
  impl_->started = true;
}

void Machine::tick(std::int64_t tick) noexcept {
  Impl& m = *impl_;
  m.statechart.begin_tick(tick);
  m.raise_events();
  m.lost.clear();
  m.statechart.run();
  m.planners.update();
  if (m.behavior.has_robot) {
    m.control.update(m.started || !m.statechart.transitions_taken().empty());
    const tasks::ControlSet& set = m.control.control().primary;
    m.planners.observe({set.contacts.data(), at(set.contact_count)});
  }
  m.started = false;
  for (const int mark : m.statechart.marks()) m.steps += mark == m.behavior.step ? 1.0 : 0.0;
  if (m.behavior.layout.steps >= 0) m.signals[m.behavior.layout.steps] = m.steps;
}

bool Machine::has_configuration_of(const Machine& old, const TakeOverMap& map) const noexcept {
  return impl_->statechart.has_configuration_of(old.impl_->statechart, map);
}

void Machine::take_over(const Machine& old, const TakeOverMap& map) noexcept {
  Impl& m = *impl_;
  const Impl& o = *old.impl_;
  for (std::size_t slot = 0; slot < m.values.size(); ++slot) {
    const int before = map.slots[slot];
    m.known_values[slot] = before < 0 ? m.values[slot] : o.known_values[at(before)];
    if (before >= 0) m.values[slot] = o.values[at(before)];
  }
  const bool same = has_configuration_of(old, map);
  m.statechart.take_over(o.statechart, map);
  m.control.take_over(o.control, map, same);
  m.planners.take_over(o.planners, map);
  m.outside.take_over(o.outside, map.events);
  m.fault_events.clear();
  for (const int event : o.fault_events) {
    if (map.events[at(event)] >= 0) m.fault_events.push_back(map.events[at(event)]);
  }
  m.contact = o.contact;
  m.steps = o.steps;
  m.started = true;
}

// The order of docs/behaviors.md 8.3: faults, contacts, planners, parameters, outside ones.
void Machine::Impl::raise_events() noexcept {
  for (const int event : fault_events) statechart.raise(event);
  fault_events.clear();
  raise_contacts(true);
  for (const int event : planners.events()) statechart.raise(event);
  planners.events().clear();
  if (behavior.watches_parameters) raise_parameters();
  while (!outside.empty()) statechart.raise(outside.pop());
}

void Machine::Impl::raise_contacts(bool edges) noexcept {
  for (std::size_t c = 0; c < behavior.layout.contact.size(); ++c) {
    const bool closed = signals[behavior.layout.contact[c]] > 0.5;
    if (edges && closed != contact[c]) {
      statechart.raise(closed ? behavior.touchdown_events[c] : behavior.liftoff_events[c]);
    }
    contact[c] = closed;
  }
}

// Raises events for external edits since the last tick; changes by actions do not count.
void Machine::Impl::raise_parameters() noexcept {
  for (std::size_t p = 0; p < behavior.parameters.size(); ++p) {
    const ParameterInfo& info = behavior.parameters[p];
    if (info.variable) continue;
    const auto first = values.begin() + info.slot;
    const auto known = known_values.begin() + info.slot;
    if (std::equal(first, first + info.size, known)) continue;
    std::copy(first, first + info.size, known);
    statechart.raise(behavior.changed_events[p]);
  }
}

const tasks::ActiveControl& Machine::control() const noexcept { return impl_->control.control(); }
int Machine::control_spec() const noexcept { return impl_->statechart.control(); }
bool Machine::stepping() const noexcept { return impl_->steps > 0.0; }
bool Machine::finished() const noexcept { return impl_->statechart.finished(); }

bool Machine::raise(int event) noexcept {
  if (event < 0) return true;  // no transition listens to it
  if (impl_->outside.push(event)) return true;
  if (impl_->lost.size() == impl_->lost.capacity()) return false;  // counted often enough
  impl_->lost.push_back(event);
  impl_->statechart.count_fault(core::Fault::event_overflow);
  return false;
}

void Machine::copy_outside_events(std::vector<int>& events) const noexcept {
  const EventQueue& queue = impl_->outside;
  for (int i = 0; i < queue.size() && events.size() < events.capacity(); ++i) {
    events.push_back(queue.at(i));
  }
  for (const int event : impl_->lost) {
    if (events.size() < events.capacity()) events.push_back(event);
  }
}

void Machine::raise_fault(core::Fault fault, core::Reaction reaction) noexcept {
  const int event = impl_->behavior.fault_events[at(static_cast<int>(fault))];
  auto& faults = impl_->fault_events;
  const bool waits = std::find(faults.begin(), faults.end(), event) != faults.end();
  if (!waits && faults.size() < faults.capacity()) faults.push_back(event);
  if (reaction == core::Reaction::safe_state) enter_safe();
}

void Machine::enter_safe() noexcept { impl_->statechart.request_safe(); }

std::span<const PlanRequest> Machine::plan_requests() const noexcept {
  return impl_->planners.requests();
}

void Machine::deliver(const PlanAnswer& answer) noexcept { impl_->planners.deliver(answer); }

std::span<double> Machine::parameters() noexcept { return impl_->values; }
std::span<const double> Machine::parameters() const noexcept { return impl_->values; }

std::span<const int> Machine::active_atomic() const noexcept {
  return impl_->statechart.active_atomic();
}
std::span<const int> Machine::active_states() const noexcept {
  return impl_->statechart.active_states();
}
std::span<const int> Machine::marks() const noexcept { return impl_->statechart.marks(); }
std::span<const int> Machine::transitions_taken() const noexcept {
  return impl_->statechart.transitions_taken();
}
std::span<const LogRecord> Machine::logs() const noexcept { return impl_->statechart.logs(); }
std::span<const ScriptRequest> Machine::script_requests() const noexcept {
  return impl_->statechart.script_requests();
}
std::span<const int> Machine::events_taken() const noexcept {
  return impl_->statechart.events_taken();
}
std::uint32_t Machine::entries(int state) const noexcept {
  return impl_->statechart.entry_serial(state);
}
std::uint8_t Machine::guard_outcomes(int transition) const noexcept {
  return impl_->statechart.guard_outcomes(transition);
}
std::int64_t Machine::deadline(int transition) const noexcept {
  return impl_->statechart.deadline(transition);
}
const EvaluationContext& Machine::context() const noexcept { return impl_->statechart.context(); }
std::size_t Machine::outside_room() const noexcept { return impl_->outside.room(); }
bool Machine::is_active(int state) const noexcept { return impl_->statechart.is_active(state); }
const ExecutionProblem& Machine::execution_problem() const noexcept {
  return impl_->statechart.execution_problem();
}
const core::FaultCounters& Machine::faults() const noexcept { return impl_->statechart.faults(); }

}  // namespace footfall::behaviors
