// When entries of a script are due, and what they do; see script_events.h.
#include "lab/judge/script_events.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "behaviors/compiled/chart.h"
#include "core/index.h"
#include "lab/judge/result.h"
#include "lab/scenario/keys.h"

namespace footfall::lab {
namespace {

std::string fault_word(InjectedFault fault) {
  return std::string(kInjectedFaults[static_cast<std::size_t>(fault)].word);
}

const char* what_of(const ScriptEntry& entry) {
  if (entry.push) return "push";
  if (!entry.edit.empty()) return "edit";
  if (!entry.set.empty()) return "new values";
  if (entry.raise >= 0) return "event";
  if (entry.fault) return "fault";
  return entry.hold ? "hold" : "call";
}

}  // namespace

std::vector<std::string> unsupported(const ScenarioDescription& scenario,
                                     const ScenarioHooks& hooks) {
  std::vector<std::string> texts;
  for (const ScriptEntry& entry : scenario.script) {
    const auto refuse = [&](const char* what) {
      texts.push_back(fmt::format("{}: error: this backend cannot {}",
                                  place_in_file(scenario, entry.mark), what));
    };
    if (entry.push && !hooks.push) refuse("push: it has no physics");
    if (entry.hold && !hooks.hold) refuse("hold a body: it has no physics");
    if (entry.fault && entry.fault != InjectedFault::planner_dropout && !hooks.fault) {
      refuse("let its sensors fail");
    }
  }
  return texts;
}

ScenarioCues::ScenarioCues(const ScenarioDescription& scenario, const ScenarioHooks& hooks,
                           engine::ControlLoop& loop, std::uint64_t seed)
    : scenario_(scenario), hooks_(hooks), loop_(loop) {
  if (!scenario.scripts.empty()) lua_.emplace(scenario, loop, seed);
  for (const ScriptEntry& entry : scenario.script) {
    Cue& cue = cues_.emplace_back();
    cue.entry = &entry;
    if (entry.moment.kind == Moment::Kind::place) watch(entry.moment);
    if (entry.moment.kind != Moment::Kind::event) continue;
    for (const std::string& event : loop.behavior().events) {
      cue.events.push_back(behaviors::Chart::event_matches(entry.moment.event, event));
    }
  }
}

void ScenarioCues::watch(const Moment& moment) {
  const behaviors::Behavior& behavior = loop_.behavior();
  for (const int state : moment.states) {
    if (std::ranges::any_of(watched_, [state](const Watched& w) { return w.state == state; })) {
      continue;
    }
    Watched watched;
    watched.state = state;
    const behaviors::Range own = behavior.states[at(state)].transitions;
    for (int t = own.first; t < own.end(); ++t) {
      const behaviors::TransitionInfo& info = behavior.transitions[at(t)];
      if (info.after >= 0 && !info.has_event) watched.timer = t;
    }
    watched_.push_back(watched);
  }
}

void ScenarioCues::observe() {
  const behaviors::Machine& machine = loop_.machine();
  for (Cue& cue : cues_) {
    if (cue.events.empty()) continue;
    for (const int event : machine.events_taken()) cue.heard += cue.events[at(event)] ? 1 : 0;
  }
  for (Watched& w : watched_) {
    const bool active = machine.is_active(w.state);
    const bool entered = machine.entries(w.state) != w.entries;
    if (w.active && (entered || !active) && w.timer < 0) w.duration = loop_.ticks() - w.entered;
    w.active = active;
    if (!entered) continue;
    w.entries = machine.entries(w.state);
    w.entered = loop_.ticks();
    if (w.timer < 0) continue;
    const behaviors::Behavior& behavior = loop_.behavior();
    const double seconds = behaviors::evaluate(
        behavior.expressions, behavior.transitions[at(w.timer)].after, machine.context());
    w.duration = behaviors::periods_of(seconds, behavior.rate_mhz);
  }
}

void ScenarioCues::fire(const StepClock& steps, RunLog& log) {
  end_lasting(log);
  for (Cue& cue : cues_) {
    if (!cue.events.empty()) {
      cue.done |= cue.heard > 0;
      for (; cue.heard > 0; --cue.heard) act(*cue.entry, log);
    } else if (!cue.done && due(cue, steps)) {
      cue.done = true;
      act(*cue.entry, log);
    }
  }
}

std::vector<ScenarioFailure> ScenarioCues::missed() const {
  std::vector<ScenarioFailure> list;
  for (const Cue& cue : cues_) {
    if (cue.done || cue.entry->optional) continue;
    list.push_back(
        {ScenarioFailure::Kind::script, place_of(*cue.entry),
         fmt::format("the {} never came: the run ended at {:.3f} s (`optional: true` allows it)",
                     what_of(*cue.entry), loop_.time()),
         std::nullopt});
  }
  return list;
}

bool ScenarioCues::due(const Cue& cue, const StepClock& steps) const {
  const Moment& moment = cue.entry->moment;
  // Half a period: times are whole numbers of periods up to round-off.
  const double now = loop_.time() + 0.5 * loop_.period();
  if (moment.kind == Moment::Kind::time) return now >= moment.time;
  if (steps.steps < moment.step) return false;
  if (!moment.states.empty()) return in_phase(moment);
  return now >= steps.last_step_at + moment.phase * steps.last_duration;
}

bool ScenarioCues::in_phase(const Moment& moment) const {
  return std::ranges::any_of(watched_, [&](const Watched& w) {
    if (!w.active || std::ranges::find(moment.states, w.state) == moment.states.end()) return false;
    if (moment.phase <= 0.0) return true;
    const auto passed = static_cast<double>(loop_.ticks() - w.entered);
    return w.duration >= 0 && passed >= moment.phase * static_cast<double>(w.duration) - 1e-9;
  });
}

void ScenarioCues::act(const ScriptEntry& entry, RunLog& log) {
  if (entry.push) {
    const ScriptedPush& push = *entry.push;
    const std::string& body = push.body.empty() ? loop_.behavior().robot.floating_base : push.body;
    log.event("push", body,
              fmt::format(
                  "{:g} N, {:g} s, {:g} rad{}", push.force, push.duration, push.direction,
                  push.elevation == 0.0 ? "" : fmt::format(", {:g} rad upwards", push.elevation)));
    if (!hooks_.push(body, push)) {
      add_problem(entry, "too many pushes at once");
    }
  }
  if (!entry.set.empty()) submit(entry, entry.set, engine::EditSource::set, log);
  if (!entry.edit.empty() || entry.raise >= 0) {
    submit(entry, entry.edit, engine::EditSource::scenario, log);
  }
  if (!entry.call.empty()) call(entry, log);
  const std::int64_t until = entry.duration ? loop_.ticks() + ticks_of(*entry.duration)
                                            : std::numeric_limits<std::int64_t>::max();
  if (entry.fault) {
    log.event("inject", fault_word(*entry.fault), "on");
    inject(*entry.fault, true);
    lasting_.push_back({until, nullptr, -1, *entry.fault});
  }
  if (entry.hold) hold(entry, until, log);
}

void ScenarioCues::hold(const ScriptEntry& entry, std::int64_t until, RunLog& log) {
  const int number = hooks_.hold(*entry.hold);
  if (number < 0) {
    add_problem(entry, "too many holds at once");
    return;
  }
  log.event("hold", entry.hold->body.name, "on");
  lasting_.push_back({until, &entry, number, {}});
}

void ScenarioCues::submit(const ScriptEntry& entry, const std::vector<behaviors::SlotValue>& values,
                          engine::EditSource source, RunLog& log) {
  engine::EditBatch batch;
  batch.source = source;
  batch.values = values;
  if (source == engine::EditSource::scenario) {
    batch.over = entry.over;
    if (entry.raise >= 0) batch.events.push_back(entry.raise);
  }
  hand_in(entry, batch, log);
}

void ScenarioCues::call(const ScriptEntry& entry, RunLog& log) {
  const ScenarioLua::Result result = lua_->call(entry.call);
  for (const std::string& text : result.messages) log.event("log", text, "scenario");
  if (result.failed) {
    add_problem(entry, result.messages.empty() ? "it failed" : result.messages.back());
  } else if (!result.batch.values.empty() || !result.batch.events.empty()) {
    hand_in(entry, result.batch, log);
  }
}

void ScenarioCues::hand_in(const ScriptEntry& entry, const engine::EditBatch& batch, RunLog& log) {
  const engine::EditReply reply = loop_.edits().submit(batch);
  if (reply.accepted()) return;
  add_problem(entry, "the edit was refused: " + reply.reasons.front());
  log.event("edit", "refused", reply.reasons.front());
}

// Entries may overlap: what fails comes back when the last of them ends.
void ScenarioCues::inject(InjectedFault fault, bool on) {
  int& entries = failing_[static_cast<std::size_t>(fault)];
  entries += on ? 1 : -1;
  if (entries != (on ? 1 : 0)) return;
  if (fault == InjectedFault::planner_dropout) {
    loop_.drop_planners(on);
  } else {
    hooks_.fault(fault, on);
  }
}

void ScenarioCues::end_lasting(RunLog& log) {
  const auto over = [&](const Lasting& lasting) {
    if (loop_.ticks() < lasting.until) return false;
    if (lasting.hold != nullptr) {
      hooks_.release(lasting.number);
      log.event("hold", lasting.hold->hold->body.name, "off");
    } else {
      inject(lasting.fault, false);
      log.event("inject", fault_word(lasting.fault), "off");
    }
    return true;
  };
  std::erase_if(lasting_, over);
}

std::int64_t ScenarioCues::ticks_of(double seconds) const {
  return behaviors::periods_of(seconds, loop_.behavior().rate_mhz);
}

void ScenarioCues::add_problem(const ScriptEntry& entry, const std::string& text) {
  const std::string place = place_of(entry);
  if (std::ranges::find(problems_, place, &ScenarioFailure::place) != problems_.end()) return;
  problems_.push_back({ScenarioFailure::Kind::script, place,
                       fmt::format("{}, at {:.3f} s", text, loop_.time()), loop_.time()});
}

std::string ScenarioCues::place_of(const ScriptEntry& entry) const {
  return place_in_file(scenario_, entry.mark);
}

}  // namespace footfall::lab
