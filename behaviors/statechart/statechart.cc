// Exit, actions and entry of one micro step, and the order of a tick; see statechart.h.
#include "behaviors/statechart/statechart.h"

#include <algorithm>
#include <cmath>

namespace footfall::behaviors {
namespace {
constexpr int kQueueCapacity = 256;
constexpr std::size_t kRecordCapacity = 256;  // of marks, transitions, texts in one tick
}  // namespace

bool EventQueue::push(int event) noexcept {
  const int capacity = static_cast<int>(items_.size());
  if (count_ == capacity) return false;
  items_[static_cast<std::size_t>((first_ + count_++) % capacity)] = event;
  return true;
}

int EventQueue::pop() noexcept {
  const int event = items_[static_cast<std::size_t>(first_)];
  first_ = (first_ + 1) % static_cast<int>(items_.size());
  --count_;
  return event;
}

Statechart::Statechart(const Chart& chart, const double* signals, std::span<double> parameters)
    : chart_(chart),
      index_(chart),
      parameters_(parameters),
      active_(chart.states.size()),
      configuration_(chart.states.size()),
      entering_(chart.states.size()),
      leaving_(chart.states.size()),
      asked_(chart.states.size()),
      entry_ticks_(chart.states.size()),
      entry_serials_(chart.states.size()),
      control_before_(chart.states.size()),
      deadlines_(chart.transitions.size(), -1),
      timer_taken_(chart.transitions.size()),
      history_values_(idx(chart.history_count) * chart.states.size()),
      history_counts_(idx(chart.history_count)),
      target_scratch_(chart.states.size() * 2 + chart.targets.size()),
      internal_(kQueueCapacity),
      external_(kQueueCapacity),
      guard_outcomes_(chart.transitions.size()) {
  active_list_.reserve(chart.states.size());
  atomic_list_.reserve(chart.states.size());
  candidates_.reserve(chart.states.size() + 1);
  selected_.reserve(chart.states.size() + 1);
  marks_.reserve(kRecordCapacity);
  taken_.reserve(kRecordCapacity);
  events_.reserve(kRecordCapacity);
  logs_.reserve(kRecordCapacity);
  script_requests_.reserve(kRecordCapacity);
  context_.signals = signals;
  context_.parameters = parameters.data();
  context_.entry_ticks = entry_ticks_.data();
  context_.active = active_.data();
  context_.period = chart.period();
}

void Statechart::start(std::int64_t tick) noexcept {
  context_.tick = tick;
  add_descendants(0);
  enter_states();
  recorded_start_ = true;
}

void Statechart::begin_tick(std::int64_t tick) noexcept {
  context_.tick = tick;
  if (!recorded_start_) {
    marks_.clear();
    logs_.clear();
    script_requests_.clear();
  }
  recorded_start_ = false;
  taken_.clear();
  events_.clear();
  steps_ = 0;
}

bool Statechart::raise(int event) noexcept {
  if (event < 0 || finished_) return true;  // no transition listens to it
  if (external_.push(event)) return true;
  faults_.add(core::Fault::event_overflow);
  return false;
}

void Statechart::raise_internal(int event) noexcept {
  if (event < 0 || internal_.push(event)) return;
  faults_.add(core::Fault::event_overflow);
}

void Statechart::execution_error(const ExecutionProblem& problem) noexcept {
  if (problem_tick_ != context_.tick) problem_ = problem;
  problem_tick_ = context_.tick;
  faults_.add(core::Fault::execution);
  raise_internal(chart_.error_execution);
}

void Statechart::run() noexcept {
  if (safe_requested_ && chart_.safe_transition >= 0) {
    const Range safe = chart_.transitions[idx(chart_.safe_transition)].targets;
    if (!is_active(chart_.targets[idx(safe.first)])) {
      selected_.clear();
      selected_.push_back(chart_.safe_transition);
      micro_step();
    }
  }
  safe_requested_ = false;
  while (!finished_) {
    EventQueue* queue = nullptr;
    select(-1);
    while (selected_.empty()) {
      queue = !internal_.empty() ? &internal_ : &external_;
      if (queue->empty()) return;
      select(queue->front());
      if (selected_.empty()) take_event(*queue);  // an event that enables no transition is dropped
    }
    if (steps_++ >= chart_.micro_steps) {  // the rest is postponed to the next tick
      execution_error({ExecutionProblem::Kind::micro_steps});
      return;
    }
    if (queue != nullptr) take_event(*queue);
    micro_step();
  }
}

// Takes the next event from a queue; requests the calls of scripts that handle it.
void Statechart::take_event(EventQueue& queue) noexcept {
  const int event = queue.pop();
  if (events_.size() < kRecordCapacity) events_.push_back(event);
  if (chart_.script_events.empty() || chart_.script_events[idx(event)] == 0) return;
  if (script_requests_.size() < kRecordCapacity) {
    script_requests_.push_back({true, event});
  } else {
    faults_.add(core::Fault::event_overflow);
  }
}

// SCXML's microstep: exits all states, then runs the transitions' actions, then enters all states.
void Statechart::micro_step() noexcept {
  const int before = control_;
  for (const int t : selected_) {
    const TransitionInfo& info = chart_.transitions[idx(t)];
    if (info.after >= 0 && !info.has_event) timer_taken_[idx(t)] = 1;
    if (info.targets.count > 0) mark_exits(domain(t));
  }
  // Records histories before the exits, and thus before the entries read them, as in Appendix D.
  leaving_.for_each([this](int s) {
    const Range own = index_.own_histories[idx(s)];
    for (int k = own.first; k < own.end(); ++k) record_history(index_.histories[idx(k)]);
  });
  exit_states();
  for (const int t : selected_) {
    if (taken_.size() < kRecordCapacity) taken_.push_back(t);
    run_actions(chart_.transitions[idx(t)].actions);
  }
  for (const int t : selected_) compute_entries(t);
  entering_.for_each([this, before](int s) { control_before_[idx(s)] = before; });
  enter_states();
}

void Statechart::mark_exits(int domain) noexcept {
  leaving_.insert_range(configuration_, domain + 1, state(domain).end);
}

void Statechart::record_history(int history) noexcept {
  const StateInfo& info = state(history);
  const std::size_t base = idx(info.history) * chart_.states.size();
  int count = 0;
  for (const int s : active_list_) {
    const StateInfo& candidate = state(s);
    const bool wanted = info.kind == StateKind::history_deep
                            ? chart_.is_descendant(s, info.parent) && candidate.end == s + 1
                            : candidate.parent == info.parent;
    if (wanted) history_values_[base + idx(count++)] = s;
  }
  history_counts_[idx(info.history)] = count;
}

void Statechart::exit_states() noexcept {
  leaving_.for_each_reverse([this](int s) {
    run_actions(state(s).on_exit);
    active_[idx(s)] = 0;
    configuration_.erase(s);
  });
  leaving_.clear();
}

void Statechart::enter_states() noexcept {
  entering_.for_each([this](int s) { enter_state(s); });
  entering_.clear();
  refresh_lists();
}

void Statechart::enter_state(int s) noexcept {
  const StateInfo& info = state(s);
  active_[idx(s)] = 1;
  configuration_.insert(s);
  entry_ticks_[idx(s)] = context_.tick;
  ++entry_serials_[idx(s)];
  run_actions(info.on_entry);
  const Range timers = index_.state_timers[idx(s)];
  for (int k = timers.first; k < timers.end(); ++k) {
    const std::size_t t = idx(index_.timers[idx(k)]);
    timer_taken_[t] = 0;
    const int after = chart_.transitions[t].after;
    const double seconds = evaluate(chart_.expressions, after, context_);
    const std::int64_t periods = periods_of(seconds, chart_.rate_mhz);
    deadlines_[t] = periods < 0 ? -1 : context_.tick + periods;
    if (periods < 0) execution_error(no_time(after, seconds));
  }
  if (info.kind == StateKind::final) after_final(s);
}

void Statechart::after_final(int s) noexcept {
  const int parent = state(s).parent;
  if (parent == 0) {
    finished_ = true;
    return;
  }
  raise_internal(state(parent).done_event);
  const int grandparent = state(parent).parent;
  if (grandparent < 0 || state(grandparent).kind != StateKind::parallel) return;
  int regions = 0, done = 0;
  for (int c = grandparent + 1; c < state(grandparent).end; c = state(c).end) {
    if (state(c).history >= 0) continue;
    ++regions;
    if (in_final(c)) ++done;
  }
  const DoneRule rule = state(grandparent).done;
  const bool holds = rule == DoneRule::all   ? done == regions
                     : rule == DoneRule::any ? done == 1
                                             : parent == state(grandparent).done_region;
  if (holds) raise_internal(state(grandparent).done_event);
}

bool Statechart::in_final(int s) const noexcept {
  for (int c = s + 1; c < state(s).end; c = state(c).end) {
    if (state(s).kind == StateKind::parallel) {
      if (state(c).history < 0 && !in_final(c)) return false;
    } else if (active_[idx(c)] != 0 && state(c).kind == StateKind::final) {
      return true;
    }
  }
  return state(s).kind == StateKind::parallel;
}

void Statechart::refresh_lists() noexcept {
  active_list_.clear();
  atomic_list_.clear();
  control_ = 0;
  configuration_.for_each([this](int s) {
    active_list_.push_back(s);
    const StateKind kind = state(s).kind;
    if (kind == StateKind::atomic || kind == StateKind::final) atomic_list_.push_back(s);
    control_ += state(s).control_weight;
  });
}

void Statechart::run_actions(Range actions) noexcept {
  for (int k = actions.first; k < actions.end(); ++k) {
    const ExecutionProblem problem = run_action(chart_.actions[idx(k)]);
    if (problem.kind == ExecutionProblem::Kind::none) continue;
    execution_error(problem);
    return;  // skip the rest of the list
  }
}

ExecutionProblem Statechart::run_action(const ActionInfo& action) noexcept {
  switch (action.kind) {
    case ActionKind::raise:
      raise_internal(action.index);
      break;
    case ActionKind::mark:
      if (marks_.size() < kRecordCapacity) marks_.push_back(action.index);
      break;
    case ActionKind::set:
      return run_set(action);
    case ActionKind::log:
      return run_log(action);
    case ActionKind::call:
      return call(action.index);
  }
  return {};
}

ExecutionProblem Statechart::run_set(const ActionInfo& action) noexcept {
  const double value = evaluate(chart_.expressions, action.expression, context_);
  const bool inside = action.min >= action.max || (value >= action.min && value <= action.max);
  if (!std::isfinite(value) || !inside) {
    return bad_value(action.expression, value, action.min, action.max);
  }
  parameters_[idx(action.index)] = value;
  return {};
}

ExecutionProblem Statechart::run_log(const ActionInfo& action) noexcept {
  if (logs_.size() == kRecordCapacity) return {};
  LogRecord record{action.index, {}};
  const LogText& text = chart_.logs[idx(action.index)];
  for (std::size_t k = 0; k < text.expressions.size(); ++k) {
    record.values[k] = evaluate(chart_.expressions, text.expressions[k], context_);
    if (!std::isfinite(record.values[k])) return bad_value(text.expressions[k], record.values[k]);
  }
  logs_.push_back(record);
  return {};
}

ExecutionProblem Statechart::call(int index) noexcept {
  const CallInfo& info = chart_.calls[idx(index)];
  if (info.native != nullptr) {
    NativeCall native{context_.signals, parameters_,
                      static_cast<double>(context_.tick) * context_.period};
    if (info.native(native)) return {};
    return {ExecutionProblem::Kind::call, index};
  }
  if (script_requests_.size() == kRecordCapacity) return {ExecutionProblem::Kind::requests, index};
  script_requests_.push_back({false, index});
  return {};
}

}  // namespace footfall::behaviors
