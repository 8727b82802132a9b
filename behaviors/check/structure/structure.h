// Structural checks of `footfall check` for a behavior that compiled: useless states and
// transitions, loops without delay, phases that are too short, unused names. Load time only; one
// small file for each kind of finding.
//
// Every check is sound, not complete: it reports nothing if uncertain. Conditions on signals and
// events count as possible. Called only for a behavior without errors, because an error has
// consequences that are not mistakes themselves.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// The states entered by one entry, including descendants, and ancestors below `ancestor`, as in W3C
// SCXML's computeEntrySet; a history state counts as itself and its default.
class EntrySet {
 public:
  explicit EntrySet(const Chart& chart) : chart_(chart), entered_(chart.states.size()) {}
  const std::vector<int>& of(Range targets, int ancestor);
  // For a transition with targets, from its domain.
  const std::vector<int>& of(const TransitionInfo& transition);
  // For the start of the run.
  const std::vector<int>& of_start();

 private:
  void clear();
  void add(int state);
  void add_default(int state);
  void add_targets(Range targets, int ancestor);
  bool holds_target(int state, Range targets) const;

  const Chart& chart_;
  std::vector<char> entered_;  // 1: as an ancestor, 2: with its default
  std::vector<int> list_;
};

// The reachable states: from the start, and from the root's `safe`, too.
struct Reach {
  std::vector<char> from_start;
  std::vector<char> with_safe;
};
Reach find_reach(const LoadContext& context);

// The state below which a transition with targets exits everything; a history target counts as
// itself, so that at run time the domain is this state or one inside it.
int exit_domain(const Chart& chart, const TransitionInfo& transition);
// Whether the `when` of this transition is constantly false.
bool never_true(const LoadContext& context, int transition);
// Whether this transition is always taken once its event and time have occurred.
bool always_true(const LoadContext& context, int transition);
// Whether both expressions have the same code; -1 equals only -1.
bool same_expression(const Chart& chart, int a, int b);
// The value of an expression of numbers and parameters, with the file's values; nullopt if an
// action sets one of them.
std::optional<double> planned_value(const LoadContext& context, int expression);
// planned_value of a time, in ticks.
std::optional<std::int64_t> planned_ticks(const LoadContext& context, int expression);
// `file:line:column` of a mark, for a message that refers to a second place.
std::string place_of(const LoadContext& context, core::Mark mark);

// The entry action at the start of a run that sets a parameter: its value in the file is never
// used.
struct SetAtStart {
  int state = -1;  // -1: there is none
  core::Mark mark{};
};
SetAtStart set_at_start(const LoadContext& context, int parameter);

// Findings by position. A template's text belongs to several states: a finding about the text must
// hold for all of them.
class Findings {
 public:
  // Adds a checked position, and whether the check found a problem there.
  void look(core::Mark mark, bool found, std::string text);
  struct Finding {
    core::Mark mark;
    bool found = false;
    std::string text;  // of the first finding
  };
  // One for each position at which all checks found a problem, in the order of look().
  std::vector<Finding> found() const;

 private:
  std::vector<Finding> findings_;
  std::map<std::tuple<int, int, int>, std::size_t> by_place_;
};

// The YAML of a transition: its map, or the keys of its state for the timed one.
const core::YamlNode& transition_keys(const LoadContext& context, int transition);
// Whether a transition was created by `mirror`.
bool made_by_mirror(const LoadContext& context, int transition);

// The checks and their ids; warnings, except for a certain loop and impossible times.
void check_reachability(LoadContext& context, const Reach& reach);  // unreachable, dead-end
void check_transitions(LoadContext& context, const Reach& reach);   // never-true, re-entry
void check_shadowed(LoadContext& context, const Reach& reach);      // shadowed
void check_loops(LoadContext& context, const Reach& reach);         // zero-time-loop, possible-loop
void check_event_loops(LoadContext& context, const Reach& reach);   // possible-loop
void check_contacts(LoadContext& context, const Reach& reach);      // contact-before
void check_times(LoadContext& context);                             // out-of-range, no-time
void check_timing(LoadContext& context);  // too-short, cut-off, never-asked
void check_events(LoadContext& context);  // never-raised, unheard
void check_unused(LoadContext& context);  // unused
void check_mirror(LoadContext& context);  // not-mirrored

// Runs all checks; they report to the context.
void check_structure(LoadContext& context);

}  // namespace footfall::behaviors
