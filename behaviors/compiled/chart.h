// A statechart as flat arrays, built at load and immutable in the tick. States are numbered in
// document order (a state, then its children): the descendants of `s` are exactly the indices s+1
// .. states[s].end-1.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "behaviors/expression/expression.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// A range of another flat array.
struct Range {
  int first = 0;
  int count = 0;
  int end() const { return first + count; }
};

enum class StateKind : std::uint8_t {
  atomic,
  compound,
  parallel,
  final,
  history_shallow,
  history_deep,
};

// When a parallel state raises its `done.state` (region: index of a state in StateInfo).
enum class DoneRule : std::uint8_t { all, any, region };

struct StateInfo {
  std::string name;
  std::string path;  // dotted, without the root; for the root its own name
  std::string doc;
  core::Mark mark;
  int parent = -1;
  int end = 0;    // one past its last descendant
  int depth = 0;  // 0 for the root
  StateKind kind = StateKind::atomic;
  Range initial;      // into Chart::targets: default entry; `default` of a history state
  Range transitions;  // into Chart::transitions, in document order
  Range on_entry;     // into Chart::actions
  Range on_exit;
  Range invokes;        // into Behavior::invokes
  int done_event = -1;  // id of done.state.PATH
  DoneRule done = DoneRule::all;
  int done_region = -1;
  int history = -1;        // slot of a history state
  int control_weight = 0;  // the sum over active states is an index into Behavior::controls
  bool reload = false;     // a changed file may be loaded while it is active
};

struct TransitionInfo {
  core::Mark mark;
  int source = 0;
  Range targets;           // into Chart::targets; empty: actions only, no exit, no entry
  bool has_event = false;  // false: event-less
  int guard = -1;          // expression, -1: none
  int after = -1;          // expression of a time, -1: none
  bool internal = false;
  int domain = -1;  // precomputed; -1: no targets, or a history target (computed at run time)
  Range actions;
  std::string reason;
};

enum class ActionKind : std::uint8_t { raise, set, log, mark, call };

// Interface of a registered C++ function in the tick: it reads signals and reads and writes
// parameters. It must be realtime-safe. False raises error.execution and skips the rest of the
// list.
struct NativeCall {
  const double* signals = nullptr;
  std::span<double> parameters;
  double time = 0.0;  // s
};
using NativeFunction = bool (*)(NativeCall& call) noexcept;

// A function named by `call:`: in C++, run at once; otherwise a script function, run outside of the
// tick.
struct CallInfo {
  std::string name;
  NativeFunction native = nullptr;
};

// A request of a tick to the scripts: to call a function, or to handle an event.
struct ScriptRequest {
  bool is_event = false;
  int index = 0;  // into Chart::events or Chart::calls
};

struct ActionInfo {
  ActionKind kind = ActionKind::raise;
  int index = 0;        // of the event, parameter slot, text, mark or call
  int expression = -1;  // for `set`
  double min = 0.0;     // for `set`: range; equal: unlimited
  double max = 0.0;
};

// `log: TEXT`: literal pieces between the values of expressions.
struct LogText {
  std::vector<std::string> pieces;  // one more than expressions
  std::vector<int> expressions;
};

inline constexpr int kMaxLogValues = 8;

// An event or prefix that a transition listens to, in the form of docs/behaviors.md 8.7.
struct EventPattern {
  int transition = 0;
  std::string text;
  core::Mark mark;
};

struct Chart {
  std::int64_t rate_mhz = 1'000'000;  // ticks per second, in millihertz
  int micro_steps = 64;               // limit in one tick
  ExpressionPool expressions;
  std::vector<std::string> expression_places;  // FILE:LINE:COLUMN; empty or absent: unknown
  std::vector<StateInfo> states;               // [0] is the root
  std::vector<TransitionInfo> transitions;
  std::vector<int> targets;
  std::vector<ActionInfo> actions;
  std::vector<LogText> logs;
  std::vector<std::string> marks;
  std::vector<CallInfo> calls;
  std::vector<std::string> events;
  std::vector<EventPattern> patterns;
  // Which events enable which transition. In the order of event_ranks the events of a pattern are
  // contiguous: one range of ranks for each pattern, and for each transition its ranges.
  std::vector<int> event_ranks;             // by event
  std::vector<Range> heard_ranks;           // ranges of ranks, transition by transition
  std::vector<Range> heard_events;          // by transition: range of heard_ranks
  std::vector<std::uint8_t> script_events;  // by event: whether a script handles it; empty: none
  int safe_transition = -1;                 // to the root's `safe` state, -1: none
  int history_count = 0;
  int error_execution = -1;  // event id
  int event_overflow = -1;   // event id

  double period() const { return 1e3 / static_cast<double>(rate_mhz); }
  bool is_descendant(int state, int ancestor) const {
    return state > ancestor && state < states[static_cast<std::size_t>(ancestor)].end;
  }
  bool matches(int transition, int event) const {
    const int rank = event_ranks[static_cast<std::size_t>(event)];
    const Range own = heard_events[static_cast<std::size_t>(transition)];
    for (int k = own.first; k < own.end(); ++k) {
      const Range heard = heard_ranks[static_cast<std::size_t>(k)];
      if (rank >= heard.first && rank < heard.end()) return true;
    }
    return false;
  }
  // Computes event_ranks and the heard_ arrays from the patterns, for all known events.
  void match_events();
  // The innermost compound state, or the root, that properly contains `source` and all targets.
  // Source: W3C SCXML 1.0, Appendix D, getTransitionDomain and findLCCA.
  int domain_of(const TransitionInfo& transition, const int* first_target, int count) const;
  // Whether `event` equals `pattern`, or is matched by a prefix (`fault.*`: `fault` and all below),
  // or it is `*`.
  static bool event_matches(std::string_view pattern, std::string_view event);
};

// Whether two states can be active at once, and neither contains the other.
bool active_together(const Chart& chart, int a, int b);

inline constexpr double kLongestTime = 1e6;  // s, of an `after` and the like

// Duration of `seconds` in whole periods: ceil(D * rate) with D rounded to nanoseconds, in integer
// arithmetic, so that 16 ms at 1500 Hz is always 24. -1 if D is negative, not finite or above 10^6
// s.
std::int64_t periods_of(double seconds, std::int64_t rate_mhz) noexcept;

}  // namespace footfall::behaviors
