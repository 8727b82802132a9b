// Events that are never raised, and events that no transition listens to.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "behaviors/check/structure/structure.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

constexpr std::string_view kChanged = "parameter.changed.";

bool has_final_child(const Chart& chart, int s) {
  const int end = chart.states[at(s)].end;
  for (int c = s + 1; c < end; c = chart.states[at(c)].end) {
    if (chart.states[at(c)].kind == StateKind::final) return true;
  }
  return false;
}

// Whether all its parts can be in final states at once.
bool can_be_final(const Chart& chart, int s) {
  const StateInfo& info = chart.states[at(s)];
  if (info.kind != StateKind::parallel) return has_final_child(chart, s);
  for (int c = s + 1; c < info.end; c = chart.states[at(c)].end) {
    if (chart.states[at(c)].history < 0 && !can_be_final(chart, c)) return false;
  }
  return true;
}

// Whether `done.state.` of a state can be raised. For a parallel state it is raised, by its rule,
// when one of its own regions enters a final child; final states in a region that is itself
// parallel do not count.
bool can_be_done(const Chart& chart, int s) {
  const StateInfo& info = chart.states[at(s)];
  if (info.kind != StateKind::parallel) return has_final_child(chart, s);
  if (info.done == DoneRule::region) return has_final_child(chart, info.done_region);
  bool ends = false;
  for (int c = s + 1; c < info.end; c = chart.states[at(c)].end) {
    ends = ends || (chart.states[at(c)].history < 0 && has_final_child(chart, c));
  }
  return ends && (info.done == DoneRule::any || can_be_final(chart, s));
}

// Reported at its `done`.
bool names_parallel_region(const Chart& chart, int s) {
  const StateInfo& info = chart.states[at(s)];
  return info.done == DoneRule::region &&
         chart.states[at(info.done_region)].kind == StateKind::parallel;
}

class EventCheck {
 public:
  explicit EventCheck(LoadContext& context) : context_(context), behavior_(context.behavior) {
    for (const std::string& event : context.declared_events) raised_.insert(event);
    for (const RaisedEvent& event : context.raised_events) by_actions_.insert(event.name);
    raised_.insert(by_actions_.begin(), by_actions_.end());
    raised_.insert(behavior_.events.begin(), behavior_.events.begin() + context.built_in_events);
    for (const ParameterInfo& parameter : behavior_.parameters) {
      raised_.insert(std::string(kChanged) + parameter.name);
    }
    for (const EventPattern& pattern : behavior_.patterns) {
      (pattern.text.ends_with("*") ? prefixes_ : exact_).insert(pattern.text);
    }
    for (const std::string& pattern : context.script_patterns) {
      (pattern.ends_with("*") ? prefixes_ : exact_).insert(pattern);
    }
  }

  void report() {
    for (const EventPattern& pattern : behavior_.patterns) check_pattern(pattern);
    for (const auto& finding : never_done_.found()) {
      context_.warning(finding.mark, "never-raised", finding.text);
    }
    for (const RaisedEvent& event : context_.raised_events) check_heard(event.name, event.mark);
    const core::YamlNode* declared = context_.section("events");
    if (declared == nullptr) return;
    for (const core::YamlEntry& entry : declared->entries) {
      if (by_actions_.contains(entry.key)) continue;  // reported there
      check_heard(entry.key, entry.key_mark);
    }
  }

 private:
  // Alternatives for a misspelt pattern: prefixes, and before them events if it is none.
  std::vector<std::string> candidates(bool prefix) const {
    std::set<std::string> found;
    for (const std::string& event : raised_) {
      for (std::size_t dot = event.find('.'); dot != std::string::npos;
           dot = event.find('.', dot + 1)) {
        found.insert(event.substr(0, dot) + ".*");
      }
      found.insert(event + ".*");
    }
    std::vector<std::string> names(found.begin(), found.end());
    if (!prefix) names.insert(names.begin(), raised_.begin(), raised_.end());
    return names;
  }

  bool is_raised(const std::string& pattern) const {
    if (pattern == "*" || raised_.contains(pattern)) return true;
    if (!pattern.ends_with(".*")) return false;
    const std::string stem = pattern.substr(0, pattern.size() - 2);
    if (raised_.contains(stem)) return true;
    const auto next = raised_.lower_bound(stem + ".");
    return next != raised_.end() && next->starts_with(stem + ".");
  }

  void check_pattern(const EventPattern& pattern) {
    constexpr std::string_view kDone = "done.state.";
    if (is_raised(pattern.text)) {
      if (!pattern.text.starts_with(kDone) || pattern.text.ends_with("*")) return;
      const int s = behavior_.find_state(std::string_view(pattern.text).substr(kDone.size()));
      if (s < 0 || can_be_done(behavior_, s) || names_parallel_region(behavior_, s)) return;
      never_done_.look(pattern.mark, true,
                       fmt::format("'{}' is never done: it has no `type: final` state that would "
                                   "end it",
                                   behavior_.states[at(s)].path));
      return;
    }
    const bool prefix = pattern.text.ends_with("*");
    const std::vector<std::string> names = candidates(prefix);
    meant_.insert(core::nearest_name(pattern.text, names));
    context_.warning(pattern.mark, "never-raised",
                     fmt::format("nothing raises '{}', and `events` does not list it{}",
                                 pattern.text, core::did_you_mean(pattern.text, names)));
  }

  void check_heard(const std::string& event, core::Mark mark) {
    if (exact_.contains(event) || meant_.contains(event)) return;
    for (const std::string& prefix : prefixes_) {
      if (Chart::event_matches(prefix, event)) return;
    }
    const std::vector<std::string> names(exact_.begin(), exact_.end());
    context_.warning(
        mark, "unheard",
        fmt::format("nothing listens to '{}'{}", event, core::did_you_mean(event, names)));
  }

  LoadContext& context_;
  const Behavior& behavior_;
  std::set<std::string> by_actions_;
  std::set<std::string> raised_;            // by actions, by the engine or externally
  std::set<std::string> exact_, prefixes_;  // patterns of transitions and scripts
  std::set<std::string> meant_;             // intended by misspelt ones: warn only once
  Findings never_done_;
};

}  // namespace

void check_events(LoadContext& context) { EventCheck(context).report(); }

}  // namespace footfall::behaviors
