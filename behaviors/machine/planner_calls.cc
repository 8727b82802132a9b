// Requests to planners and their answers; see planner_calls.h.
#include "behaviors/machine/planner_calls.h"

#include <algorithm>
#include <cmath>

#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {
constexpr std::size_t kEventsPerInvoke = 64;
}  // namespace

FootPlannerSpec spec_in_force(const PlannerInfo& planner,
                              std::span<const double> parameters) noexcept {
  FootPlannerSpec spec = planner.spec;
  if (planner.kappa_slot < 0) return spec;
  for (int k = 0; k < 2; ++k) {
    spec.kappa[at(k)] = parameters[at(planner.kappa_slot + (planner.kappa_size > 1 ? k : 0))];
  }
  return spec;
}

PlanAnswer answer_of(const Behavior& behavior, const PlanRequest& request,
                     std::span<const double> parameters) noexcept {
  const PlannerInfo& planner = behavior.planners[at(request.planner)];
  const FootPlan plan = plan_foot(spec_in_force(planner, parameters), request.input);
  return {request.planner,    request.sequence,   plan.ok,       plan.target,
          plan.predicted_pos, plan.predicted_vel, plan.extension};
}

PlannerCalls::PlannerCalls(const Behavior& behavior, Statechart& statechart,
                           core::SignalTable& signals, std::span<const double> parameters)
    : behavior_(behavior),
      statechart_(statechart),
      signals_(signals),
      parameters_(parameters),
      calls_(behavior.invokes.size()) {
  requests_.reserve(behavior.invokes.size());
  events_.reserve((behavior.invokes.size() + 1) * kEventsPerInvoke);
  const std::int64_t ticks_a_second = std::max<std::int64_t>(behavior.rate_mhz / 1000, 1);
  for (Call& call : calls_) call.ring.resize(static_cast<std::size_t>(ticks_a_second) + 1);
}

void PlannerCalls::start() noexcept {
  if (!behavior_.has_robot) return;  // without planners, too: a reload may bring some
  const auto rpy = signal3(behavior_.layout.base_rpy);
  const auto base = signal3(behavior_.layout.base_pos);
  const double sr = std::sin(rpy[0]), cr = std::cos(rpy[0]);
  const double sp = std::sin(rpy[1]), cp = std::cos(rpy[1]);
  const double sy = std::sin(rpy[2]), cy = std::cos(rpy[2]);
  const std::array<double, 3> left = {cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr};
  for (std::size_t c = 0; c < behavior_.robot.contacts.size(); ++c) {
    const auto p = signal3(behavior_.layout.point[c]);
    double y = 0.0;
    for (std::size_t k = 0; k < 3; ++k) y += left[k] * (p[k] - base[k]);
    side_[c] = y >= 0.0 ? 1.0 : -1.0;
  }
}

std::array<double, 3> PlannerCalls::signal3(int first) const noexcept {
  return {signals_[first], signals_[first + 1], signals_[first + 2]};
}

std::array<double, 2> PlannerCalls::wanted_goal(const PlannerInfo& planner) const noexcept {
  if (planner.goal_slot >= 0) {
    return {parameters_[at(planner.goal_slot)], parameters_[at(planner.goal_slot + 1)]};
  }
  if (planner.goal.size() >= 2) return {planner.goal[0], planner.goal[1]};
  return {};
}

void PlannerCalls::observe(std::span<const int> stance_contacts) noexcept {
  if (behavior_.planners.empty()) return;
  PendulumMeasurement measured;
  measured.com = signal3(behavior_.layout.com_pos);
  measured.com_vel = signal3(behavior_.layout.com_vel);
  measured.supported = !stance_contacts.empty();
  for (const int c : stance_contacts) {
    const auto p = signal3(behavior_.layout.point[at(c)]);
    for (std::size_t k = 0; k < 3; ++k) {
      measured.support[k] += p[k] / static_cast<double>(stance_contacts.size());
    }
  }
  for (std::size_t i = 0; i < behavior_.planners.size(); ++i) {
    const PlannerInfo& planner = behavior_.planners[i];
    behaviors::observe(seen_[i], planner.spec, measured, wanted_goal(planner),
                       statechart_.context().period);
  }
  for (PlanRequest& request : requests_) {
    request.input = input_of(request.planner, request.stance, request.swing, request.switch_in);
  }
}

FootPlannerInput PlannerCalls::input_of(int planner, int stance, int swing,
                                        double switch_in) const noexcept {
  const SignalLayout& layout = behavior_.layout;
  return make_input(seen_[at(planner)], signal3(layout.com_pos), signal3(layout.point[at(stance)]),
                    signals_[layout.base_rpy + 2], side_[at(swing)], switch_in);
}

void PlannerCalls::take_over(const PlannerCalls& old, const TakeOverMap& map) noexcept {
  for (Call& call : calls_) {
    call.active = false;
    call.count = 0;
    call.next_ask = -1;
  }
  for (std::size_t k = 0; k < map.invokes.size(); ++k) {
    if (map.invokes[k] < 0) continue;
    Call& call = calls_[at(map.invokes[k])];
    call.active = old.calls_[k].active;
    call.serial = old.calls_[k].serial;
    call.next_ask = old.calls_[k].next_ask;
  }
  requests_.clear();
  events_.clear();
  for (const int event : old.events_) {
    if (map.events[at(event)] >= 0) emit(map.events[at(event)]);
  }
  sequence_ = old.sequence_;
  side_ = old.side_;
  if (behavior_.planners.empty()) return;
  PlannerObservation fresh;  // of a planner that was not there: from the last tick's measurement
  fresh.velocity = {signals_[behavior_.layout.com_vel], signals_[behavior_.layout.com_vel + 1]};
  fresh.goal = {signals_[behavior_.layout.com_pos], signals_[behavior_.layout.com_pos + 1]};
  fresh.primed = true;
  seen_.fill(fresh);
  for (std::size_t i = 0; i < map.planners.size(); ++i) {
    if (map.planners[i] >= 0) seen_[at(map.planners[i])] = old.seen_[i];
  }
}

void PlannerCalls::update() noexcept {
  requests_.clear();
  for (std::size_t k = 0; k < calls_.size(); ++k) update_call(behavior_.invokes[k], calls_[k]);
}

void PlannerCalls::update_call(const InvokeInfo& invoke, Call& call) noexcept {
  const std::int64_t tick = statechart_.context().tick;
  const bool active = statechart_.is_active(invoke.state);
  const std::uint32_t serial = statechart_.entry_serial(invoke.state);
  if (call.active && (!active || serial != call.serial)) leave(invoke, call);
  if (!active) return;
  if (!call.active) {
    call.active = true;
    call.serial = serial;
    const std::int64_t delay =
        invoke.at >= 0 ? ticks_of(invoke.at, 1.0) : ticks_of(invoke.after, invoke.at_fraction);
    call.next_ask = delay < 0 ? -1 : statechart_.entry_tick(invoke.state) + delay;
  }
  while (call.count > 0 && call.nth(0).deadline >= 0 && tick >= call.nth(0).deadline) {
    const Outstanding late = call.nth(0);
    call.drop(1);
    replace_late(invoke, late);
  }
  if (call.next_ask < 0 || tick < call.next_ask) return;
  ask(invoke, call);
  const std::int64_t every = invoke.every < 0 ? -1 : ticks_of(invoke.every, 1.0);
  call.next_ask =
      every < 0 ? -1 : std::max(call.next_ask + std::max<std::int64_t>(every, 1), tick + 1);
}

// An exit cancels the request; if a late plan is to be replaced, the next state needs a plan now.
void PlannerCalls::leave(const InvokeInfo& invoke, Call& call) noexcept {
  if (call.count > 0 && invoke.closed_form) {
    replace_late(invoke, call.nth(call.count - 1));
  }
  call.active = false;
  call.count = 0;
  call.next_ask = -1;
}

void PlannerCalls::ask(const InvokeInfo& invoke, Call& call) noexcept {
  const EvaluationContext& context = statechart_.context();
  const double switch_in = evaluate(behavior_.expressions, invoke.switch_in, context);
  if (!std::isfinite(switch_in)) {
    statechart_.report_execution_error(bad_value(invoke.switch_in, switch_in));
    return;
  }
  if (at(call.count) == call.ring.size()) call.drop(1);  // unanswered for one second
  const std::int64_t deadline = invoke.deadline < 0 ? -1 : ticks_of(invoke.deadline, 1.0);
  Outstanding& request = call.nth(call.count++);
  request.sequence = ++sequence_;
  request.deadline = deadline < 0 ? -1 : context.tick + deadline;
  request.switch_time = static_cast<double>(context.tick) * context.period + switch_in;
  requests_.push_back(
      {invoke.planner, request.sequence, invoke.stance, invoke.swing, switch_in, {}});
}

bool PlannerCalls::deliver(const PlanAnswer& answer) noexcept {
  for (std::size_t k = 0; k < calls_.size(); ++k) {
    Call& call = calls_[k];
    if (!call.active || behavior_.invokes[k].planner != answer.planner) continue;
    int found = 0;
    while (found < call.count && call.nth(found).sequence != answer.sequence) ++found;
    if (found == call.count) continue;
    const double switch_time = call.nth(found).switch_time;
    call.drop(found + 1);  // this answer also covers older requests
    const PlannerInfo& planner = behavior_.planners[at(answer.planner)];
    const bool good =
        answer.ok && std::isfinite(answer.target[0] + answer.target[1] + answer.target[2]);
    if (good) write(answer.planner, answer, switch_time, false);
    emit(good ? planner.done_event : planner.failed_event);
    return true;
  }
  return false;
}

// Computes the missing plan here, from the current position; velocity and goal as filtered up to
// the tick before, because observe() follows the statechart.
void PlannerCalls::replace_late(const InvokeInfo& invoke, const Outstanding& request) noexcept {
  const PlannerInfo& planner = behavior_.planners[at(invoke.planner)];
  statechart_.count_fault(core::Fault::planner_late);
  emit(planner.late_event);
  signals_[behavior_.layout.planner[at(invoke.planner)].late] = 1.0;
  if (!invoke.closed_form) return;
  const EvaluationContext& context = statechart_.context();
  const double switch_in =
      std::max(0.0, request.switch_time - static_cast<double>(context.tick) * context.period);
  const PlanAnswer answer =
      answer_of(behavior_,
                {invoke.planner, request.sequence, invoke.stance, invoke.swing, switch_in,
                 input_of(invoke.planner, invoke.stance, invoke.swing, switch_in)},
                parameters_);
  if (answer.ok) {
    write(invoke.planner, answer, request.switch_time, true);
  } else {
    emit(planner.failed_event);
  }
}

void PlannerCalls::write(int planner, const PlanAnswer& answer, double switch_time,
                         bool late) noexcept {
  const PlannerSignals& out = behavior_.layout.planner[at(planner)];
  for (int k = 0; k < 3; ++k) signals_[out.target + k] = answer.target[at(k)];
  for (int k = 0; k < 2; ++k) {
    signals_[out.predicted_pos + k] = answer.predicted_pos[at(k)];
    signals_[out.predicted_vel + k] = answer.predicted_vel[at(k)];
  }
  signals_[out.switch_time] = switch_time;
  signals_[out.extension] = answer.extension;
  signals_[out.late] = late ? 1.0 : 0.0;
}

void PlannerCalls::emit(int event) noexcept {
  if (events_.size() < events_.capacity()) events_.push_back(event);
}

std::int64_t PlannerCalls::ticks_of(int expression, double factor) noexcept {
  const double seconds =
      factor * evaluate(behavior_.expressions, expression, statechart_.context());
  const std::int64_t ticks = periods_of(seconds, behavior_.rate_mhz);
  if (ticks < 0) statechart_.report_execution_error(no_time(expression, seconds));
  return ticks;
}

}  // namespace footfall::behaviors
