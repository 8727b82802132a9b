// The statechart at run time: W3C SCXML 1.0 semantics (section 3.13 and Appendix D) on the flat
// arrays of a Chart. It uses ticks, signals and parameters, but is independent of robots and
// control. Everything is allocated by the constructor; all other functions are noexcept and
// allocation-free.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "behaviors/compiled/chart.h"
#include "behaviors/statechart/execution_problem.h"
#include "behaviors/statechart/index.h"
#include "core/fault.h"

namespace footfall::behaviors {

struct TakeOverMap;

// One executed `log:` action.
struct LogRecord {
  int text = 0;  // index into Chart::logs
  std::array<double, kMaxLogValues> values{};
};

// FIFO queue of fixed capacity.
class EventQueue {
 public:
  explicit EventQueue(int capacity) : items_(static_cast<std::size_t>(capacity)) {}
  bool empty() const noexcept { return count_ == 0; }
  std::size_t room() const noexcept { return items_.size() - static_cast<std::size_t>(count_); }
  bool push(int event) noexcept;
  void clear() noexcept { count_ = 0; }
  // Takes the waiting events of another queue; `events` maps their ids (-1: dropped).
  void take_over(const EventQueue& old, const std::vector<int>& events) noexcept;
  int front() const noexcept { return items_[static_cast<std::size_t>(first_)]; }
  int pop() noexcept;
  int size() const noexcept { return count_; }
  int at(int i) const noexcept {  // the i-th from the front
    return items_[static_cast<std::size_t>(first_ + i) % items_.size()];
  }

 private:
  std::vector<int> items_;
  int first_ = 0;
  int count_ = 0;
};

class Statechart {
 public:
  // `signals` and `parameters` are read in every tick; actions write parameters. All must outlive
  // it.
  Statechart(const Chart& chart, const double* signals, std::span<double> parameters);

  // Enters the initial configuration; event-less transitions wait for the first tick.
  void start(std::int64_t tick) noexcept;
  // Clears the records of the last tick; call before this tick's raise().
  void begin_tick(std::int64_t tick) noexcept;
  // Appends to the external queue; false if full (counted, and fault.event.overflow is raised).
  bool raise(int event) noexcept;
  // The safe state is entered ahead of this tick's transitions (docs/behaviors.md 8.10).
  void request_safe() noexcept { safe_requested_ = true; }
  // One tick: event-less transitions, internal events, external events, until all queues are empty.
  void run() noexcept;

  // Whether the configuration of the chart to be replaced exists in this chart.
  bool has_configuration_of(const Statechart& old, const TakeOverMap& map) const noexcept;
  // Bumpless transfer from the old chart, between two ticks: continues with its configuration,
  // clocks, histories and events, without running actions. If that configuration does not exist in
  // this chart, its own last one is restored with new clocks.
  void take_over(const Statechart& old, const TakeOverMap& map) noexcept;

  std::span<const int> active_states() const noexcept { return active_list_; }
  std::span<const int> active_atomic() const noexcept { return atomic_list_; }
  bool is_active(int state) const noexcept { return active_[idx(state)] != 0; }
  std::int64_t entry_tick(int state) const noexcept { return entry_ticks_[idx(state)]; }
  // Incremented at each entry of the state, to distinguish a re-entry from staying.
  std::uint32_t entry_serial(int state) const noexcept { return entry_serials_[idx(state)]; }
  // Sum of control weights of the configuration that was active before `state` was last entered.
  int control_before(int state) const noexcept { return control_before_[idx(state)]; }
  int control() const noexcept { return control_; }
  bool finished() const noexcept { return finished_; }
  std::span<const int> marks() const noexcept { return marks_; }
  std::span<const int> transitions_taken() const noexcept { return taken_; }
  // Events processed in this tick, in order, including those that enabled no transition.
  std::span<const int> events_taken() const noexcept { return events_; }
  // The tick at which a transition's `after` expires, -1 if it is not running.
  std::int64_t deadline(int transition) const noexcept {
    return timer_taken_[idx(transition)] != 0 ? -1 : deadlines_[idx(transition)];
  }
  // Values of a transition's guard so far: bit 0 false, bit 1 true.
  std::uint8_t guard_outcomes(int transition) const noexcept {
    return guard_outcomes_[idx(transition)];
  }
  std::span<const LogRecord> logs() const noexcept { return logs_; }
  // Requests to scripts in this tick, in order.
  std::span<const ScriptRequest> script_requests() const noexcept { return script_requests_; }
  const core::FaultCounters& faults() const noexcept { return faults_; }
  void count_fault(core::Fault fault) noexcept { faults_.add(fault); }
  // Raises error.execution as an internal event of the next tick. The first problem of a tick is
  // kept.
  void report_execution_error(const ExecutionProblem& problem) noexcept {
    execution_error(problem);
  }
  // The first problem of the last tick that had one.
  const ExecutionProblem& execution_problem() const noexcept { return problem_; }
  const EvaluationContext& context() const noexcept { return context_; }

 private:
  static std::size_t idx(int i) noexcept { return static_cast<std::size_t>(i); }
  const StateInfo& state(int s) const noexcept { return chart_.states[idx(s)]; }

  // Selection (select.cc).
  void select(int event) noexcept;  // -1: event-less
  void consider(int s, int event) noexcept;
  bool enabled(const Trigger& trigger, int event) const noexcept;
  int domain(int transition) const noexcept;
  void remove_conflicting() noexcept;
  int effective_targets(const TransitionInfo& transition, int* out) const noexcept;

  // Execution (statechart.cc).
  void micro_step() noexcept;
  void mark_exits(int domain) noexcept;
  void exit_states() noexcept;
  void record_history(int history) noexcept;
  void enter_states() noexcept;
  void enter_state(int s) noexcept;
  void after_final(int s) noexcept;
  bool in_final(int s) const noexcept;
  void refresh_lists() noexcept;
  void run_actions(Range actions) noexcept;
  // A problem of the kind `none`: done.
  ExecutionProblem run_action(const ActionInfo& action) noexcept;
  ExecutionProblem run_set(const ActionInfo& action) noexcept;
  ExecutionProblem run_log(const ActionInfo& action) noexcept;
  ExecutionProblem call(int index) noexcept;
  void take_event(EventQueue& queue) noexcept;
  void raise_internal(int event) noexcept;
  void execution_error(const ExecutionProblem& problem) noexcept;

  // Bumpless transfer (take_over.cc).
  void take_configuration(const Statechart& old, const TakeOverMap& map) noexcept;
  void enter_again(std::int64_t tick) noexcept;
  void find_deadlines(int s, std::int64_t unknown) noexcept;
  void take_histories(const Statechart& old, const TakeOverMap& map) noexcept;

  // Entry sets, Appendix D (entry.cc).
  void compute_entries(int transition) noexcept;
  void add_descendants(int s) noexcept;
  void add_ancestors(int s, int ancestor) noexcept;
  void add_regions(int parallel) noexcept;
  void add_targets(Range targets, int ancestor) noexcept;

  const Chart& chart_;
  const ChartIndex index_;
  std::span<double> parameters_;
  EvaluationContext context_;
  std::vector<std::uint8_t> active_;  // by state
  StateSet configuration_, entering_, leaving_;
  std::vector<std::uint64_t> asked_;  // by state: number of the selection that tested it last
  std::uint64_t selection_ = 0;
  std::vector<std::int64_t> entry_ticks_;
  std::vector<std::uint32_t> entry_serials_;
  std::vector<int> control_before_;
  std::vector<std::int64_t> deadlines_;    // by transition with `after`; tick at which it expires
  std::vector<std::uint8_t> timer_taken_;  // by transition: event-less timer already taken
  std::vector<int> active_list_, atomic_list_;
  std::vector<int> candidates_;      // enabled transitions, including conflicting ones
  std::vector<int> selected_;        // transitions of this micro step
  std::vector<int> history_values_;  // by slot, states.size() each
  std::vector<int> history_counts_;  // by slot, 0: never exited
  mutable std::vector<int> target_scratch_;
  EventQueue internal_, external_;
  std::vector<int> marks_, taken_, events_;
  mutable std::vector<std::uint8_t> guard_outcomes_;  // by transition
  std::vector<LogRecord> logs_;
  std::vector<ScriptRequest> script_requests_;
  core::FaultCounters faults_;
  ExecutionProblem problem_;
  std::int64_t problem_tick_ = -1;
  int control_ = 0;
  int steps_ = 0;  // micro steps in this tick
  bool finished_ = false;
  bool safe_requested_ = false;
  bool recorded_start_ = false;  // start()'s marks are still to be shown
};

}  // namespace footfall::behaviors
