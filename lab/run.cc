// The loop around the loop; see run.h.
#include "lab/run.h"

#include <chrono>
#include <cmath>

#include "engine/pacer.h"
#include "lab/run_log.h"

namespace footfall::lab {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

class Run {
 public:
  Run(engine::ControlLoop& loop, RunSpec& spec)
      : loop_(loop), spec_(spec), metrics_(loop), log_(loop, spec.log, spec.log_every, spec.said) {
    states_before_.reserve(loop.behavior().states.size());
  }

  RunResult execute() {
    loop_.start();
    if (has_goal(loop_.behavior())) goal_ = current_goal();
    start_goal_ = goal_;
    if (spec_.goal) goal_ = start_goal_ = *spec_.goal;
    engine::Pacer pacer(loop_.period());
    started_ = Clock::now();
    while (!ended()) {
      if (spec_.realtime && !pacer.wait()) result_.faults.add(core::Fault::tick_overrun);
      one_tick();
    }
    loop_.safe_stop();
    finish();
    return std::move(result_);
  }

 private:
  std::array<double, 2> current_goal() const {
    const auto slot = static_cast<std::size_t>(loop_.behavior().planners.front().goal_slot);
    return {loop_.machine().parameters()[slot], loop_.machine().parameters()[slot + 1]};
  }

  void one_tick() {
    move_goal();
    fire_events();
    loop_.sense();
    // A fault's tick enters `safe`: what ended the run is told by the states before it.
    const auto active = loop_.machine().active_atomic();
    states_before_.assign(active.begin(), active.end());
    const Clock::time_point before = Clock::now();
    if (spec_.arm_allocations) spec_.arm_allocations(true);
    loop_.compute();
    if (spec_.arm_allocations) spec_.arm_allocations(false);
    const auto spent = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - before);
    result_.tick_time.add(spent.count());
    const StepEvent step = metrics_.observe(goal_);
    if (step.foot >= 0) last_step_at_ = loop_.time();
    log_.after_tick(step);
    loop_.actuate();
    if (spec_.status && loop_.ticks() % 256 == 0) show_status();
  }

  // What the run was told moves the goal; without that it is the behavior's own, which may change.
  void move_goal() {
    if (!has_goal(loop_.behavior())) return;
    if (!spec_.goal && !spec_.goal_velocity) {
      goal_ = current_goal();
      return;
    }
    if (spec_.goal_velocity) {
      for (std::size_t k = 0; k < 2; ++k) {
        goal_[k] = start_goal_[k] + (*spec_.goal_velocity)[k] * loop_.time();
      }
    }
    const auto slot = static_cast<std::size_t>(loop_.behavior().planners.front().goal_slot);
    loop_.machine().parameters()[slot] = goal_[0];
    loop_.machine().parameters()[slot + 1] = goal_[1];
  }

  void fire_events() {
    for (ScheduledEvent& event : spec_.events) {
      if (!event.fire || !due(event)) continue;
      event.fire();
      event.fire = nullptr;
      log_.event("push", event.label, "");
    }
  }

  bool due(const ScheduledEvent& event) const {
    // Half a period: times are whole numbers of periods up to round-off.
    const double now = loop_.time() + 0.5 * loop_.period();
    if (event.at_time) return now >= *event.at_time;
    if (metrics_.counter().steps() < event.at_step) return false;
    return now >= last_step_at_ + event.phase * metrics_.last_step_duration();
  }

  bool ended() {
    if (spec_.stop && spec_.stop->load()) return end_with(RunEnd::stopped);
    switch (loop_.state()) {
      case engine::LoopState::running:
        break;
      case engine::LoopState::finished:
        return end_with(RunEnd::finished);
      case engine::LoopState::fallen:
        return end_with(RunEnd::fall);
      case engine::LoopState::stopped:
        return end_with(RunEnd::fault);
    }
    if (metrics_.counter().swing_too_long()) {
      result_.faults.add(core::Fault::swing_too_long);
      return end_with(RunEnd::fall);
    }
    if (spec_.max_steps > 0 && metrics_.counter().steps() >= spec_.max_steps) {
      return end_with(RunEnd::steps);
    }
    if (spec_.max_time > 0.0 && loop_.time() + 0.5 * loop_.period() >= spec_.max_time) {
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
    spec_.status(
        {loop_.time(), metrics_.counter().steps(), log_.state_name(), loop_.time() / wall});
  }

  void finish() {
    result_.wall_time = seconds_since(started_);
    result_.real_time_factor = result_.wall_time > 0.0 ? loop_.time() / result_.wall_time : 0.0;
    result_.figures = metrics_.figures(result_.end == RunEnd::fall);
    if (result_.end == RunEnd::fall || result_.end == RunEnd::fault) {
      result_.cause = explain_end(loop_, metrics_.counter(), states_before_);
    }
    result_.worst = worst_faults(loop_);
    for (std::size_t i = 0; i < result_.faults.count.size(); ++i) {
      result_.faults.count[i] += loop_.faults().count[i];
      result_.faults.count[i] += loop_.machine().faults().count[i];
    }
    if (spec_.allocations) result_.allocations = spec_.allocations();
    log_.event("end", run_end_name(result_.end), result_.cause ? result_.cause->text : "");
  }

  engine::ControlLoop& loop_;
  RunSpec& spec_;
  RunMetrics metrics_;
  RunLog log_;
  RunResult result_;
  std::array<double, 2> goal_{}, start_goal_{};
  Clock::time_point started_;
  std::vector<int> states_before_;  // active atomic states at the start of the tick
  double last_status_ = 0.0;
  double last_step_at_ = 0.0;
};

}  // namespace

bool has_goal(const behaviors::Behavior& behavior) {
  return !behavior.planners.empty() && behavior.planners.front().goal_slot >= 0;
}

RunResult run(engine::ControlLoop& loop, RunSpec& spec) { return Run(loop, spec).execute(); }

}  // namespace footfall::lab
