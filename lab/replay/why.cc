// Explains a tick; see why.h.
#include "lab/replay/why.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <vector>

#include "behaviors/explain/guard_terms.h"
#include "core/index.h"
#include "engine/tick/control_loop.h"

namespace footfall::lab {
namespace {

// One transition out of an active state, with the state of the machine at the start of the tick.
struct Candidate {
  int transition = 0;
  std::vector<std::string> lines;
};

class Explanation {
 public:
  Explanation(Replay& replay, std::int64_t tick)
      : replay_(replay),
        behavior_(replay.behavior()),
        machine_(replay.loop().machine()),
        tick_(tick) {}

  std::string text() {
    while (replay_.next() < tick_) replay_.tick({});
    replay_.tick([this] { after(); }, [this] { before(); });
    return std::move(text_);
  }

 private:
  void before() {
    state_ = replay_.state();
    behaviors::EvaluationContext context = machine_.context();
    context.tick = tick_;
    for (const int state : machine_.active_states()) {
      const behaviors::Range own = behavior_.states[at(state)].transitions;
      for (int t = own.first; t < own.end(); ++t) candidates_.push_back(candidate(t, context));
    }
  }

  Candidate candidate(int t, const behaviors::EvaluationContext& context) const {
    const behaviors::TransitionInfo& info = behavior_.transitions[at(t)];
    Candidate out{t, {}};
    if (info.guard >= 0) {
      for (const behaviors::GuardTerm& term :
           behaviors::guard_terms(behavior_, info.guard, context)) {
        out.lines.push_back(fmt::format("when  {}{}", term.text, term.holds ? "" : "   <- no"));
      }
    }
    if (info.after >= 0) out.lines.push_back(timer(machine_.deadline(t)));
    return out;
  }

  std::string timer(std::int64_t due) const {
    if (due < 0) return "after its time was used in this entry   <- no";
    const auto left = due - tick_;
    if (left <= 0) return fmt::format("after due since {} ticks", -left);
    return fmt::format("after {} ticks ({:.6g} s) left   <- no", left,
                       static_cast<double>(left) * behavior_.period());
  }

  std::string name(int t) const {
    const behaviors::TransitionInfo& info = behavior_.transitions[at(t)];
    std::string text = behavior_.states[at(info.source)].path + " -> ";
    if (info.targets.count == 0) text += "(actions only)";
    for (int k = info.targets.first; k < info.targets.end(); ++k) {
      if (k > info.targets.first) text += ", ";
      text += behavior_.states[at(behavior_.targets[at(k)])].path;
    }
    return info.reason.empty() ? text : text + " (" + info.reason + ")";
  }

  // Sets `on` from the events processed in this tick.
  void add_events(Candidate& candidate) const {
    if (!behavior_.transitions[at(candidate.transition)].has_event) return;
    std::string patterns;
    for (const behaviors::EventPattern& p : behavior_.patterns) {
      if (p.transition != candidate.transition) continue;
      patterns += (patterns.empty() ? "" : ", ") + p.text;
    }
    const auto matches = [&](int e) { return behavior_.matches(candidate.transition, e); };
    const bool seen = std::ranges::any_of(machine_.events_taken(), matches);
    candidate.lines.insert(candidate.lines.begin(),
                           fmt::format("on    {}{}", patterns, seen ? ": came" : "   <- no"));
  }

  void after() {
    text_ = fmt::format("tick {}, {:.6f} s, in {}\n", tick_, replay_.loop().time(), state_);
    std::string events;
    for (const int e : machine_.events_taken()) events += " " + behavior_.events[at(e)];
    if (!events.empty()) text_ += "events:" + events + "\n";
    const auto taken = machine_.transitions_taken();
    text_ += taken.empty() ? "taken: none\n" : "taken:\n";
    for (const int t : taken) {
      text_ += "  " + name(t) + "\n";
      for (Candidate& c : candidates_) {
        if (c.transition == t) tell(c);
      }
    }
    bool first = true;
    for (Candidate& c : candidates_) {
      if (std::ranges::find(taken, c.transition) != taken.end()) continue;
      if (first) text_ += "not taken:\n";
      first = false;
      text_ += "  " + name(c.transition) + "\n";
      tell(c);
    }
    text_ += "then in " + replay_.state() + "\n";
  }

  void tell(Candidate& candidate) {
    add_events(candidate);
    for (const std::string& line : candidate.lines) text_ += "    " + line + "\n";
  }

  Replay& replay_;
  const behaviors::Behavior& behavior_;
  const behaviors::Machine& machine_;
  std::int64_t tick_;
  std::string state_, text_;
  std::vector<Candidate> candidates_;
};

}  // namespace

std::int64_t telling_tick(const Log& log) {
  const LoggedEvent* last = nullptr;
  for (const LoggedEvent& event : log.events) {
    if (event.kind == "fault" && event.name == "fall") return event.tick;
    if (event.kind == "transition") last = &event;
  }
  return last != nullptr ? last->tick : log.inputs.first_tick + log.inputs.ticks() - 1;
}

std::string faults_until(const Log& log, std::int64_t tick) {
  constexpr double kBefore = 1.0;  // s: a fall is the end of something
  const auto rate = static_cast<double>(log.rate_mhz) / 1e3;
  const std::int64_t from = tick - std::llround(kBefore * rate);
  std::string faults, end;
  for (const LoggedEvent& event : log.events) {
    if (event.kind == "fault" && event.tick > from && event.tick <= tick) {
      faults += fmt::format("  {:.6f} s  {}  {}\n", event.time, event.name, event.detail);
    }
    const bool by_itself = event.kind == "end" && !event.detail.empty();
    if (by_itself && std::abs(event.tick - tick) <= 1) {
      end = fmt::format("end: {}\n", event.detail);
    }
  }
  return (faults.empty() ? "" : "faults of the last second:\n" + faults) + end;
}

std::string explain_tick(Replay& replay, std::int64_t tick) {
  if (tick < replay.next() || tick >= replay.end()) {
    throw std::runtime_error(
        fmt::format("the log has ticks {} to {}, not {}", replay.next(), replay.end() - 1, tick));
  }
  return Explanation(replay, tick).text();
}

}  // namespace footfall::lab
