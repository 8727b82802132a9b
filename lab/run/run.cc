// The loop around the loop; see run.h.
#include "lab/run/run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <utility>

#include "engine/realtime/pacer.h"
#include "lab/run/reload.h"
#include "lab/run/run_log.h"

namespace footfall::lab {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kLongestMotion = 1e5;  // s, of a goal in a run without an end

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

std::int64_t ns_since(Clock::time_point start) {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start).count();
}

class Run {
 public:
  Run(engine::ControlLoop& loop, RunSpec& spec)
      : loop_(&loop),
        spec_(spec),
        metrics_(loop),
        log_(std::make_unique<RunLog>(loop, spec.log, spec.said)) {
    states_before_.reserve(loop.behavior().states.size());
  }

  RunResult execute() {
    loop_->start();
    log_->after_start();
    for (const engine::EditBatch& edit : goal_edits(loop_->behavior(), spec_)) {
      const engine::EditReply reply = loop_->edits().submit(edit);
      if (!reply.accepted()) throw std::runtime_error("--goal: error: " + reply.reasons.front());
    }
    if (spec_.link) spec_.link->start();
    engine::Pacer pacer(loop_->period());
    started_ = Clock::now();
    while (!ended()) {
      if (spec_.realtime) loop_->late(!pacer.wait());
      one_tick();
    }
    loop_->safe_stop();
    if (spec_.link) spec_.link->stop();
    finish();
    return std::move(result_);
  }

 private:
  // Where the robot is told to be; the origin if its behavior has no goal.
  std::array<double, 2> current_goal() const {
    if (!has_goal(loop_->behavior())) return {};
    const auto slot = static_cast<std::size_t>(loop_->behavior().planners.front().goal_slot);
    return {loop_->machine().parameters()[slot], loop_->machine().parameters()[slot + 1]};
  }

  void one_tick() {
    take_answers();
    fire_events();
    if (spec_.reloads) reload();
    if (spec_.observer) {
      spec_.observer->before_tick(
          {metrics_.counter().steps(), last_step_at_, metrics_.last_step_duration()}, *log_);
    }
    loop_->sense();
    // A fault's tick enters `safe`: what ended the run is told by the states before it.
    const auto active = loop_->machine().active_atomic();
    states_before_.assign(active.begin(), active.end());
    compute();
    if (spec_.reloads && spec_.reloads->take_back()) {
      log_->after_tick({});  // what the faulty tick was; the hardware never sees it
      go_on();
      compute();
    }
    const StepEvent step = metrics_.observe(current_goal());
    if (step.foot >= 0) last_step_at_ = loop_->time();
    log_->after_tick(step);
    if (spec_.observer) spec_.observer->after_tick();
    loop_->actuate();
    if (spec_.status && loop_->ticks() % 256 == 0) show_status();
  }

  void compute() {
    const Clock::time_point before = Clock::now();
    if (spec_.arm_allocations) spec_.arm_allocations(true);
    loop_->compute();
    if (spec_.link && binding_ == nullptr) spec_.link->post(*loop_, ns_since(before));
    if (spec_.arm_allocations) spec_.arm_allocations(false);
    result_.tick_time.add(ns_since(before));
  }

  void reload() {
    for (ScheduledReload& next : spec_.reload_at) {
      if (next.path.empty() || loop_->time() + 0.5 * loop_->period() < next.at_time) continue;
      spec_.reloads->request(std::exchange(next.path, ""));
    }
    if (spec_.link) bind_link();
    const bool linked = spec_.link == nullptr || (binding_ == nullptr && spec_.link->rebound());
    if (linked && spec_.reloads->swap()) {
      go_on();
    } else {
      tell_news();
    }
  }

  // With another loop, from where the one before is.
  void go_on() {
    tell_news();
    loop_ = &spec_.reloads->now();
    metrics_.go_on(*loop_);
    log_ = std::make_unique<RunLog>(*loop_, spec_.reloads->log(), spec_.said);
    states_before_.reserve(loop_->behavior().states.size());
    log_->event("reload", "begins", loop_->behavior().name);
    if (spec_.link) binding_ = spec_.link->prepare(*loop_);
    if (spec_.link) bind_link();
    if (spec_.on_reload) spec_.on_reload(*loop_);
    ++result_.reloads;
  }

  // The link takes one loop after the other.
  void bind_link() {
    if (binding_ != nullptr && spec_.link->rebound()) spec_.link->rebind(std::move(binding_));
  }

  void tell_news() {
    for (const auto& [what, detail] : spec_.reloads->take_news()) {
      log_->event("reload", what, detail);
    }
  }

  // Nobody waits for them here; what was applied is in the log.
  void take_answers() {
    engine::EditAnswer answer;
    while (loop_->edits().take_answer(answer)) {
    }
  }

  void fire_events() {
    for (ScheduledEvent& event : spec_.events) {
      if (!event.fire || !due(event)) continue;
      event.fire();
      event.fire = nullptr;
      log_->event("push", event.label, "");
    }
  }

  bool due(const ScheduledEvent& event) const {
    // Half a period: times are whole numbers of periods up to round-off.
    const double now = loop_->time() + 0.5 * loop_->period();
    if (event.at_time) return now >= *event.at_time;
    if (metrics_.counter().steps() < event.at_step) return false;
    return now >= last_step_at_ + event.phase * metrics_.last_step_duration();
  }

  bool ended() {
    if (spec_.stop && spec_.stop->load()) return end_with(RunEnd::stopped);
    switch (loop_->state()) {
      case engine::LoopState::running:
        break;
      case engine::LoopState::finished:
        return end_with(RunEnd::finished);
      case engine::LoopState::fallen:
        return end_with(RunEnd::fall);
      case engine::LoopState::stopped:
        return end_with(RunEnd::fault);
    }
    if (spec_.max_steps > 0 && metrics_.counter().steps() >= spec_.max_steps) {
      return end_with(RunEnd::steps);
    }
    if (spec_.max_time > 0.0 && loop_->time() + 0.5 * loop_->period() >= spec_.max_time) {
      return end_with(RunEnd::time);
    }
    return false;
  }

  bool end_with(RunEnd end) {
    result_.end = end;
    return true;
  }

  void show_status() {
    const double wall = seconds_since(started_);
    if (wall - last_status_ < 0.2) return;
    last_status_ = wall;
    spec_.status({loop_->time(), metrics_.counter().steps(), log_->state_name(),
                  loop_->time() / wall, spec_.reloads ? spec_.reloads->note() : ""});
  }

  void finish() {
    result_.wall_time = seconds_since(started_);
    result_.real_time_factor = result_.wall_time > 0.0 ? loop_->time() / result_.wall_time : 0.0;
    result_.figures = metrics_.figures(result_.end == RunEnd::fall);
    if (result_.end == RunEnd::fall || result_.end == RunEnd::fault) {
      result_.cause = explain_end(*loop_, states_before_);
    }
    result_.worst = worst_faults(*loop_);
    result_.faults = loop_->faults();
    if (spec_.allocations) result_.allocations = spec_.allocations();
    log_->event("end", run_end_name(result_.end), result_.cause ? result_.cause->text : "");
  }

  engine::ControlLoop* loop_;  // that runs now
  RunSpec& spec_;
  RunMetrics metrics_;
  std::unique_ptr<RunLog> log_;
  std::shared_ptr<engine::LinkBinding> binding_;  // that the link is to take when it can
  RunResult result_;
  Clock::time_point started_;
  std::vector<int> states_before_;  // active atomic states at the start of the tick
  double last_status_ = 0.0;
  double last_step_at_ = 0.0;
};

}  // namespace

bool has_goal(const behaviors::Behavior& behavior) {
  return !behavior.planners.empty() && behavior.planners.front().goal_slot >= 0;
}

std::vector<engine::EditBatch> goal_edits(const behaviors::Behavior& behavior,
                                          const RunSpec& spec) {
  if (!has_goal(behavior) || (!spec.goal && !spec.goal_velocity)) return {};
  const int slot = behavior.planners.front().goal_slot;
  const auto& all = behavior.parameters;
  const auto owner = std::ranges::find_if(all, [slot](const behaviors::ParameterInfo& info) {
    return slot >= info.slot && slot < info.slot + info.size;
  });
  const auto to = [&](const std::array<double, 2>& goal, double over) {
    const auto parameter = static_cast<int>(owner - all.begin());
    engine::EditBatch edit;
    edit.source = engine::EditSource::command;
    for (int k = 0; k < 2; ++k) {
      edit.values.push_back(
          {parameter, slot - owner->slot + k, {goal[static_cast<std::size_t>(k)]}});
    }
    edit.over = over;
    return edit;
  };
  std::vector<engine::EditBatch> edits;
  const auto x = behavior.values.begin() + slot;
  const std::array<double, 2> start = spec.goal.value_or(std::array<double, 2>{x[0], x[1]});
  if (spec.goal) edits.push_back(to(start, 0.0));
  if (!spec.goal_velocity) return edits;
  // Until the run ends, or the goal's range does.
  double time = spec.max_time > 0.0 ? spec.max_time : kLongestMotion;
  std::array<double, 2> end = start;
  for (std::size_t k = 0; k < 2; ++k) {
    const double v = (*spec.goal_velocity)[k];
    if (v == 0.0 || !owner->has_range()) continue;
    time = std::min(time, std::max(0.0, ((v > 0.0 ? owner->max : owner->min) - start[k]) / v));
  }
  for (std::size_t k = 0; k < 2; ++k) end[k] += (*spec.goal_velocity)[k] * time;
  edits.push_back(to(end, time));
  return edits;
}

RunResult run(engine::ControlLoop& loop, RunSpec& spec) { return Run(loop, spec).execute(); }

}  // namespace footfall::lab
