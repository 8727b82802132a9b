// What a run attaches to the executive; see run.h.
#include "lab/run/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "engine/realtime/executive.h"
#include "lab/run/reload.h"
#include "lab/run/run_log.h"

namespace footfall::lab {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongestMotion = 1e5;  // s, of a goal in a run without an end

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Figures, log and scheduled events of a run, and what else than the loop ends it.
class Recorder final : public engine::TickObserver {
 public:
  Recorder(engine::ControlLoop& loop, RunSpec& spec)
      : spec_(spec),
        metrics_(sample_names(loop.behavior()), loop.period()),
        first_log_(loop, spec.log, spec.said),
        log_(&first_log_) {
    find_columns(loop, sample_names(loop.behavior()));
    log_->begin();
  }

  void started(engine::ControlLoop& loop) override {
    log_->after_start();
    for (const engine::EditBatch& edit : goal_edits(loop.behavior(), spec_)) {
      const engine::EditReply reply = loop.edits().submit(edit);
      if (!reply.accepted()) throw std::runtime_error("--goal: error: " + reply.reasons.front());
    }
    started_ = Clock::now();
  }

  bool ends(const engine::ControlLoop& loop) override {
    if (spec_.max_steps > 0 && metrics_.counter().steps() >= spec_.max_steps) {
      end_ = RunEnd::steps;
    } else if (spec_.max_time > 0.0 && loop.time() + 0.5 * loop.period() >= spec_.max_time) {
      end_ = RunEnd::time;
    } else {
      return false;
    }
    return true;
  }

  void before_tick(engine::ControlLoop& loop) override {
    take_answers(loop);
    tell_news();
    fire_events(loop);
    if (spec_.observer) {
      spec_.observer->before_tick(
          {metrics_.counter().steps(), last_step_at_, metrics_.last_step_duration()}, *log_);
    }
    log_->before_tick();
  }

  void after_compute(engine::ControlLoop& loop) override {
    const StepEvent step = metrics_.observe(sampled(loop));
    if (step.foot >= 0) last_step_at_ = loop.time();
    log_->after_tick(step);
    if (spec_.observer) spec_.observer->after_tick();
  }

  void withdrawn(engine::ControlLoop& /*loop*/) override { log_->after_tick({}); }

  void exchanged(engine::ControlLoop& now) override {
    tell_news();
    const SampleNames names = sample_names(now.behavior());
    metrics_.go_on(names);
    find_columns(now, names);
    log_ = &spec_.reloads->log();
    log_->begin();
    log_->before_tick();
    log_->event("reload", "begins", now.behavior().name);
  }

  const StepCounter& steps() const { return metrics_.counter(); }
  RunLog& log() { return *log_; }
  RunEnd end() const { return end_; }
  RunFigures figures(double time, bool fell) const { return metrics_.figures(time, fell); }
  double wall_time() const { return seconds_since(started_); }  // s

 private:
  void find_columns(const engine::ControlLoop& loop, const SampleNames& names) {
    columns_ = sample_columns(names, [&](std::string_view n) { return loop.signals().find(n); });
  }

  TickSample sampled(const engine::ControlLoop& loop) const noexcept {
    TickSample tick = read_sample(columns_, [&](int i) { return loop.signals()[i]; });
    tick.going_on = loop.state() == engine::LoopState::running;
    return tick;
  }

  // Nobody waits for them here; what was applied is in the log.
  static void take_answers(engine::ControlLoop& loop) {
    engine::EditAnswer answer;
    while (loop.edits().take_answer(answer)) {
    }
  }

  void tell_news() {
    ReloadNews news;
    while (spec_.reloads != nullptr && spec_.reloads->take_news(news)) {
      log_->event("reload", news.what.view(), news.detail.view());
    }
  }

  void fire_events(const engine::ControlLoop& loop) {
    for (ScheduledEvent& event : spec_.events) {
      if (!event.fire || !due(event, loop)) continue;
      event.fire();
      event.fire = nullptr;
      log_->event("push", event.label, "");
    }
  }

  bool due(const ScheduledEvent& event, const engine::ControlLoop& loop) const {
    // Half a period: times are whole numbers of periods up to round-off.
    const double now = loop.time() + 0.5 * loop.period();
    if (event.at_time) return now >= *event.at_time;
    if (metrics_.counter().steps() < event.at_step) return false;
    return now >= last_step_at_ + event.phase * metrics_.last_step_duration();
  }

  RunSpec& spec_;
  RunMetrics metrics_;
  SampleColumns columns_;
  RunLog first_log_;
  RunLog* log_;  // of the loop that runs
  RunEnd end_ = RunEnd::time;
  Clock::time_point started_ = Clock::now();
  double last_step_at_ = 0.0;  // s
};

// Shows where the run is, about five times a second of wall time.
class StatusLine final : public engine::TickObserver {
 public:
  StatusLine(const RunSpec& spec, Recorder& recorder) : spec_(spec), recorder_(recorder) {}

  void before_tick(engine::ControlLoop& loop) override {
    if (loop.ticks() % 256 != 0) return;
    const double wall = recorder_.wall_time();
    if (wall - last_ < 0.2) return;
    last_ = wall;
    spec_.status({loop.time(), recorder_.steps().steps(), recorder_.log().state_name(),
                  loop.time() / wall, spec_.reloads ? spec_.reloads->note() : ""});
  }

 private:
  const RunSpec& spec_;
  Recorder& recorder_;
  double last_ = 0.0;  // s
};

RunEnd end_of(const engine::ControlLoop& loop) {
  switch (loop.state()) {
    case engine::LoopState::finished:
      return RunEnd::finished;
    case engine::LoopState::fallen:
      return RunEnd::fall;
    default:
      return RunEnd::fault;
  }
}

// Scheduled events that are left when a run is over.
void list_missed(const RunSpec& spec, RunResult& result) {
  for (const ScheduledEvent& event : spec.events) {
    if (!event.fire) continue;
    if (!event.optional) {
      result.missed.push_back(event.label);
    } else if (!result.cause) {
      result.not_reached.push_back(event.at_time ? fmt::format("push at {:.3g} s", *event.at_time)
                                                 : event.label);
    }
  }
}

}  // namespace

bool has_goal(const behaviors::Behavior& behavior) {
  return !behavior.planners.empty() && behavior.planners.front().goal_slot >= 0;
}

std::vector<engine::EditBatch> goal_edits(const behaviors::Behavior& behavior,
                                          const RunSpec& spec) {
  if (!has_goal(behavior) || (!spec.goal && !spec.goal_velocity)) return {};
  const int slot = behavior.planners.front().goal_slot;
  const behaviors::ParameterInfo& owner =
      behavior.parameters[static_cast<std::size_t>(behavior.parameter_of_slot(slot))];
  const auto edit = [](std::vector<behaviors::SlotValue> values, double over) {
    engine::EditBatch batch;
    batch.source = engine::EditSource::command;
    batch.values = std::move(values);
    batch.over = over;
    return batch;
  };
  std::vector<engine::EditBatch> edits;
  const auto x = behavior.values.begin() + slot;
  const std::array<double, 2> start = spec.goal.value_or(std::array<double, 2>{x[0], x[1]});
  if (spec.goal) edits.push_back(edit({{slot, start[0]}, {slot + 1, start[1]}}, 0.0));
  if (!spec.goal_velocity) return edits;
  // Each axis until the run ends, or its range does: the other goes on.
  for (int k = 0; k < 2; ++k) {
    const double v = (*spec.goal_velocity)[static_cast<std::size_t>(k)];
    const double begin = start[static_cast<std::size_t>(k)];
    if (v == 0.0) continue;
    double time = spec.max_time > 0.0 ? spec.max_time : kLongestMotion;
    if (owner.has_range()) {
      time = std::min(time, std::max(0.0, ((v > 0.0 ? owner.max : owner.min) - begin) / v));
    }
    edits.push_back(edit({{slot + k, begin + v * time}}, time));
  }
  return edits;
}

RunResult run(engine::ControlLoop& loop, RunSpec& spec) {
  Recorder recorder(loop, spec);
  StatusLine status(spec, recorder);
  engine::Executive executive(
      loop, {spec.realtime, spec.stop, spec.live, spec.reloads, spec.arm_allocations});
  executive.attach(recorder);
  if (spec.status) executive.attach(status);
  engine::ExecutiveEnd end{};
  try {
    end = executive.run();
  } catch (const engine::RunInterrupted& error) {
    recorder.log().event("end", "error", error.what());
    throw;
  }
  const engine::ControlLoop& last = executive.loop();
  RunResult result;
  result.wall_time = recorder.wall_time();
  result.real_time_factor = result.wall_time > 0.0 ? last.time() / result.wall_time : 0.0;
  result.end = end == engine::ExecutiveEnd::asked      ? RunEnd::stopped
               : end == engine::ExecutiveEnd::observer ? recorder.end()
                                                       : end_of(last);
  result.figures = recorder.figures(last.time(), result.end == RunEnd::fall);
  if (result.end == RunEnd::fall || result.end == RunEnd::fault) {
    result.cause = explain_end(last, recorder.log().states_before());
  }
  result.worst = worst_faults(last);
  result.execution_error = recorder.log().first_execution_error();
  result.faults = last.faults();
  const int marked = last.behavior().layout.steps;
  if (marked >= 0) result.marked_steps = std::llround(last.signals().values()[marked]);
  result.tick_time = executive.tick_time();
  if (spec.allocations) result.allocations = spec.allocations();
  result.reloads = executive.exchanges();
  if (spec.log != nullptr) result.log_lost = spec.log->lost();
  list_missed(spec, result);
  recorder.log().event("end", run_end_name(result.end), result.cause ? result.cause->text : "");
  return result;
}

}  // namespace footfall::lab
