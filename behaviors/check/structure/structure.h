// What `footfall check` says about the structure of a behavior that compiled: states and
// transitions that cannot play a part, loops in no time, phases too short, names that nothing uses.
// Load time only; one small file for each kind of finding.
//
// Every check is sound, not complete: it is silent where it cannot be sure. Conditions on signals
// count as possible, events as possible. Called for a behavior without errors only: a mistake that
// is an error has consequences that are none of their own.
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

// The states that one entry enters, descendants and ancestors below `ancestor` included, as W3C
// SCXML's computeEntrySet; a history state stands for itself and its default.
class EntrySet {
 public:
  explicit EntrySet(const Chart& chart) : chart_(chart), entered_(chart.states.size()) {}
  const std::vector<int>& of(Range targets, int ancestor);
  // Of a transition with targets, from its domain.
  const std::vector<int>& of(const TransitionInfo& transition);
  // Of the run's start.
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

// The states that can be entered: from the start, and from the root's `safe` too.
struct Reach {
  std::vector<char> from_start;
  std::vector<char> with_safe;
};
Reach find_reach(const LoadContext& context);

// The state that a transition with targets exits everything below; a history target stands for
// itself, so that at run time it is this state or one inside it.
int exit_domain(const Chart& chart, const TransitionInfo& transition);
// The `when` of this transition is a constant that is false.
bool never_true(const LoadContext& context, int transition);
// Nothing holds this transition back once its event and time have come.
bool always_true(const LoadContext& context, int transition);
// Both expressions are the same code; -1 is the same as -1 only.
bool same_expression(const Chart& chart, int a, int b);
// The value of an expression of numbers and parameters, as the file has them; nothing if an action
// sets one of them.
std::optional<double> planned_value(const LoadContext& context, int expression);
// A time as planned_value, in ticks.
std::optional<std::int64_t> planned_ticks(const LoadContext& context, int expression);
// `file:line:column` of a mark, for a message that points to a second place.
std::string place_of(const LoadContext& context, core::Mark mark);

// Findings by place. A template's text stands for several states: what is said about the text must
// hold for all of them.
class Findings {
 public:
  // What was looked at, at its place, and whether the check found it.
  void look(core::Mark mark, bool found, std::string text);
  struct Finding {
    core::Mark mark;
    bool found = false;
    std::string text;  // of the first
  };
  // One for each place where everything was found, in the order they were looked at.
  std::vector<Finding> found() const;

 private:
  std::vector<Finding> findings_;
  std::map<std::tuple<int, int, int>, std::size_t> by_place_;
};

// The YAML of a transition: its map, the keys of its state for the timed one.
const core::YamlNode& transition_keys(const LoadContext& context, int transition);
// Whether a transition was made by `mirror`, not written.
bool made_by_mirror(const LoadContext& context, int transition);

// The checks, with the ids they report under; warnings, but for a loop that is certain.
void check_reachability(LoadContext& context, const Reach& reach);  // unreachable, dead-end
void check_transitions(LoadContext& context, const Reach& reach);   // never-true, re-entry
void check_shadowed(LoadContext& context, const Reach& reach);      // shadowed
void check_loops(LoadContext& context, const Reach& reach);         // zero-time-loop, possible-loop
void check_event_loops(LoadContext& context, const Reach& reach);   // possible-loop
void check_contacts(LoadContext& context, const Reach& reach);      // contact-before
void check_timing(LoadContext& context);  // too-short, cut-off, never-asked
void check_events(LoadContext& context);  // never-raised, unheard
void check_unused(LoadContext& context);  // unused
void check_mirror(LoadContext& context);  // not-mirrored

// All of them, reported into the context.
void check_structure(LoadContext& context);

}  // namespace footfall::behaviors
