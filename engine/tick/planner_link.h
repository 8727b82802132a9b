// Between the machine's plan requests and the planners, in lock-step: an answer is computed from
// the state at the asking and arrives a declared simulated latency later.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "behaviors/machine/machine.h"
#include "model/control_model.h"

namespace footfall::engine {

class PlannerLink {
 public:
  // latency_ticks >= 1: an answer is never there in the tick that asked.
  PlannerLink(const behaviors::Behavior& behavior, const model::ControlModel& model,
              int latency_ticks);

  // At the start pose, the model being updated: which side each contact belongs to.
  void start() noexcept;
  // Goes on with what the planners of another behavior observed; answers under way are lost. A
  // planner that was not there starts from the model of the last tick, `now`.
  void take_over(const PlannerLink& old, const std::vector<int>& planners,
                 const model::ControlModel& now) noexcept;
  // Updates what planners observe every tick (the CoM velocity filter, the goal
  // that is approached). period in s.
  void observe(std::span<const int> stance_contacts, std::span<const double> parameters,
               double period) noexcept;
  // Hands over the answers due at this tick, and copies them to `told` as far as there is room.
  // hand_over false: only that (a replay hands over what was logged).
  void deliver(std::int64_t tick, behaviors::Machine& machine,
               std::vector<behaviors::PlanAnswer>* told = nullptr, bool hand_over = true) noexcept;
  // While planners are dropped no answer arrives: what is due then is lost.
  void drop(bool on) noexcept { dropped_ = on; }
  // Answers this tick's requests, to be delivered later.
  void take(std::int64_t tick, behaviors::Machine& machine) noexcept;

 private:
  struct Pending {
    std::int64_t due = 0;
    behaviors::PlanAnswer answer;
  };
  void approach_goal(std::size_t planner, std::span<const double> parameters,
                     double period) noexcept;
  behaviors::PlanAnswer answer(const behaviors::PlanRequest& request,
                               std::span<const double> parameters) const noexcept;

  const behaviors::Behavior& behavior_;
  const model::ControlModel& model_;
  int latency_ticks_;
  std::vector<Pending> pending_;  // room for every invoke asking in every tick of the latency
  std::size_t head_ = 0, count_ = 0;
  std::array<std::array<double, 2>, core::kMaxPlanners> filtered_velocity_{};
  std::array<double, core::kMaxContacts> contact_side_{};         // +1 left, -1 right of the base
  std::array<std::array<double, 2>, core::kMaxPlanners> goal_{};  // m, world, as approached
  bool primed_ = false;
  bool dropped_ = false;
};

}  // namespace footfall::engine
