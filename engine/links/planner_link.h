// Between the machine's plan requests and the planners, in lock-step: an answer is computed from
// the request's input and arrives a declared simulated latency later.
#pragma once

#include <cstdint>
#include <vector>

#include "behaviors/machine/machine.h"

namespace footfall::engine {

class PlannerLink {
 public:
  // latency_ticks >= 1: an answer is never there in the tick that asked.
  PlannerLink(const behaviors::Behavior& behavior, int latency_ticks);

  // Hands over the answers due at this tick, and copies them to `told` as far as there is room.
  // hand_over false: only that (a replay hands over what was logged).
  void deliver(std::int64_t tick, behaviors::Machine& machine,
               std::vector<behaviors::PlanAnswer>* told = nullptr, bool hand_over = true) noexcept;
  // While planners are dropped no answer arrives: what is due then is lost.
  void drop(bool on) noexcept { dropped_ = on; }
  // Answers this tick's requests, to be delivered later.
  void post(std::int64_t tick, const behaviors::Machine& machine) noexcept;
  // Goes on from another behavior's; answers under way are lost.
  void take_over(const PlannerLink& old) noexcept;

 private:
  struct Pending {
    std::int64_t due = 0;
    behaviors::PlanAnswer answer;
  };

  const behaviors::Behavior& behavior_;
  int latency_ticks_;
  std::vector<Pending> pending_;  // room for every invoke asking in every tick of the latency
  std::size_t head_ = 0, count_ = 0;
  bool dropped_ = false;
};

}  // namespace footfall::engine
