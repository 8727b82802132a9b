// Lock-step planner traffic; see planner_link.h.
#include "engine/tick/planner_link.h"

#include <algorithm>
#include <cmath>

#include "behaviors/machine/planner_calls.h"

namespace footfall::engine {

using behaviors::FootPlan;
using behaviors::FootPlannerInput;
using behaviors::PlanAnswer;
using behaviors::PlannerInfo;
using behaviors::PlanRequest;

PlannerLink::PlannerLink(const behaviors::Behavior& behavior, const model::ControlModel& model,
                         int latency_ticks)
    : behavior_(behavior),
      model_(model),
      latency_ticks_(std::max(1, latency_ticks)),
      pending_(std::max<std::size_t>(1, behavior.invokes.size()) *
               (static_cast<std::size_t>(latency_ticks_) + 1)) {}

// A foot belongs to the side of the base on which it stands at the start; later the feet may be
// close together or cross, and must not change sides by that.
void PlannerLink::start() noexcept {
  const auto& R = model_.R_WB();
  const auto& p = model_.state().p_WB;
  for (int c = 0; c < model_.contact_count(); ++c) {
    const auto& x = model_.point(c).position;
    const double y = R[1] * (x[0] - p[0]) + R[4] * (x[1] - p[1]) + R[7] * (x[2] - p[2]);
    contact_side_[static_cast<std::size_t>(c)] = y >= 0.0 ? 1.0 : -1.0;
  }
  primed_ = false;
  head_ = count_ = 0;
}

void PlannerLink::take_over(const PlannerLink& old, const std::vector<int>& planners,
                            const model::ControlModel& now) noexcept {
  const auto& com = now.com();
  filtered_velocity_.fill({com.velocity[0], com.velocity[1]});
  goal_.fill({com.position[0], com.position[1]});
  for (std::size_t i = 0; i < planners.size(); ++i) {
    if (planners[i] < 0) continue;
    filtered_velocity_[static_cast<std::size_t>(planners[i])] = old.filtered_velocity_[i];
    goal_[static_cast<std::size_t>(planners[i])] = old.goal_[i];
  }
  contact_side_ = old.contact_side_;
  primed_ = old.primed_;
  dropped_ = old.dropped_;
  head_ = count_ = 0;
}

// v̂' = (g/h)(x - p) + (v - v̂)/τ: the pendulum predicts, the measured velocity corrects slowly, so
// noise is averaged over τ without the lag of a plain low-pass.
void PlannerLink::observe(std::span<const int> stance_contacts, std::span<const double> parameters,
                          double period) noexcept {
  const auto& com = model_.com();
  for (std::size_t i = 0; i < behavior_.planners.size(); ++i) {
    approach_goal(i, parameters, period);
    const double tau = behavior_.planners[i].spec.velocity_filter;
    auto& v = filtered_velocity_[i];
    if (!primed_ || !(tau > 0.0) || stance_contacts.empty()) {
      v = {com.velocity[0], com.velocity[1]};
      continue;
    }
    std::array<double, 3> support{};
    for (const int c : stance_contacts) {
      for (std::size_t k = 0; k < 3; ++k) {
        support[k] += model_.point(c).position[k] / static_cast<double>(stance_contacts.size());
      }
    }
    const double height = std::max(0.1, com.position[2] - support[2]);
    for (std::size_t k = 0; k < 2; ++k) {
      v[k] +=
          period * (behavior_.planners[i].spec.gravity / height * (com.position[k] - support[k]) +
                    (com.velocity[k] - v[k]) / tau);
    }
  }
  primed_ = true;
}

void PlannerLink::deliver(std::int64_t tick, behaviors::Machine& machine,
                          std::vector<PlanAnswer>* told, bool hand_over) noexcept {
  while (count_ > 0 && pending_[head_].due <= tick) {
    const PlanAnswer& answer = pending_[head_].answer;
    if (!dropped_) {
      if (told != nullptr && told->size() < told->capacity()) told->push_back(answer);
      if (hand_over) machine.deliver(answer);
    }
    head_ = (head_ + 1) % pending_.size();
    --count_;
  }
}

void PlannerLink::take(std::int64_t tick, behaviors::Machine& machine) noexcept {
  for (const PlanRequest& request : machine.plan_requests()) {
    const PlanAnswer computed = answer(request, machine.parameters());
    if (count_ == pending_.size()) continue;  // its deadline will report it
    pending_[(head_ + count_) % pending_.size()] = {tick + latency_ticks_, computed};
    ++count_;
  }
}

// A goal that jumps is approached from where the robot stood, at a speed it can follow.
void PlannerLink::approach_goal(std::size_t planner, std::span<const double> parameters,
                                double period) noexcept {
  const PlannerInfo& info = behavior_.planners[planner];
  std::array<double, 2> wanted{};
  if (info.goal_slot >= 0) {
    const auto slot = static_cast<std::size_t>(info.goal_slot);
    wanted = {parameters[slot], parameters[slot + 1]};
  } else if (info.goal.size() >= 2) {
    wanted = {info.goal[0], info.goal[1]};
  }
  std::array<double, 2>& goal = goal_[planner];
  if (!primed_) goal = {model_.com().position[0], model_.com().position[1]};
  const double distance = std::hypot(wanted[0] - goal[0], wanted[1] - goal[1]);
  const double step = info.spec.goal_speed * period;
  if (!(info.spec.goal_speed > 0.0) || distance <= step) {
    goal = wanted;
    return;
  }
  for (std::size_t k = 0; k < 2; ++k) goal[k] += step / distance * (wanted[k] - goal[k]);
}

PlanAnswer PlannerLink::answer(const PlanRequest& request,
                               std::span<const double> parameters) const noexcept {
  const PlannerInfo& planner = behavior_.planners[static_cast<std::size_t>(request.planner)];
  FootPlannerInput in;
  const auto& com = model_.com();
  const auto& stance = model_.point(request.stance).position;
  in.com = {com.position[0], com.position[1]};
  in.com_vel = filtered_velocity_[static_cast<std::size_t>(request.planner)];
  in.com_height = com.position[2] - stance[2];
  in.stance = stance;
  in.yaw = model_.rpy()[2];
  in.goal = goal_[static_cast<std::size_t>(request.planner)];
  in.switch_in = request.switch_in;
  in.swing_side = contact_side_[static_cast<std::size_t>(request.swing)];
  const FootPlan plan = plan_foot(behaviors::spec_in_force(planner, parameters), in);
  return {request.planner,    request.sequence,   plan.ok,       plan.target,
          plan.predicted_pos, plan.predicted_vel, plan.extension};
}

}  // namespace footfall::engine
