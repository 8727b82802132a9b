// The active states' `invoke`s at run time: requests to planners, signals written from answers,
// reactions to late answers. Allocates nothing after construction.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/machine/machine.h"
#include "behaviors/planners/observation.h"
#include "behaviors/statechart/statechart.h"

namespace footfall::behaviors {

struct TakeOverMap;

// The planner's settings in this tick: `kappa: $name` uses the current value of its parameter.
FootPlannerSpec spec_in_force(const PlannerInfo& planner,
                              std::span<const double> parameters) noexcept;

// The plan of the closed form for a request's input.
PlanAnswer answer_of(const Behavior& behavior, const PlanRequest& request,
                     std::span<const double> parameters) noexcept;

class PlannerCalls {
 public:
  PlannerCalls(const Behavior& behavior, Statechart& statechart, core::SignalTable& signals,
               std::span<const double> parameters);

  // Records the lateral order of the feet (the signals contain the first measurement).
  void start() noexcept;
  // Call after the statechart's tick: handles exits, deadlines and new requests.
  void update() noexcept;
  // At the end of every tick: what the planners see, and the input of this tick's requests.
  void observe(std::span<const int> stance_contacts) noexcept;
  // Writes the answer's signals; false: it was cancelled, late, or never asked for.
  bool deliver(const PlanAnswer& answer) noexcept;

  // Continues the calls of another behavior; its pending requests are not awaited.
  void take_over(const PlannerCalls& old, const TakeOverMap& map) noexcept;

  std::span<const PlanRequest> requests() const noexcept { return requests_; }
  // Events for the next tick's external queue; the caller clears them.
  std::vector<int>& events() noexcept { return events_; }

 private:
  struct Outstanding {
    std::uint32_t sequence = 0;
    std::int64_t deadline = -1;  // tick, -1: none
    double switch_time = 0.0;    // s since start
  };
  struct Call {
    bool active = false;
    std::uint32_t serial = 0;    // of the state's entry
    std::int64_t next_ask = -1;  // tick, -1: none
    // Unanswered requests, oldest first, in a ring buffer with room for one a tick during one
    // second, so that even a late answer finds its request.
    int first = 0;
    int count = 0;
    std::vector<Outstanding> ring;

    Outstanding& nth(int k) noexcept {
      return ring[static_cast<std::size_t>(first + k) % ring.size()];
    }
    void drop(int oldest) noexcept {
      first = static_cast<int>(static_cast<std::size_t>(first + oldest) % ring.size());
      count -= oldest;
    }
  };

  void update_call(const InvokeInfo& invoke, Call& call) noexcept;
  void leave(const InvokeInfo& invoke, Call& call) noexcept;
  void ask(const InvokeInfo& invoke, Call& call) noexcept;
  void replace_late(const InvokeInfo& invoke, const Outstanding& request) noexcept;
  FootPlannerInput input_of(int planner, int stance, int swing, double switch_in) const noexcept;
  std::array<double, 2> wanted_goal(const PlannerInfo& planner) const noexcept;
  std::array<double, 3> signal3(int first) const noexcept;
  void write(int planner, const PlanAnswer& answer, double switch_time, bool late) noexcept;
  void emit(int event) noexcept;
  // A time in ticks; -1 and error.execution if it is invalid.
  std::int64_t ticks_of(int expression, double factor) noexcept;

  const Behavior& behavior_;
  Statechart& statechart_;
  core::SignalTable& signals_;
  std::span<const double> parameters_;
  std::vector<Call> calls_;  // by Behavior::invokes
  std::vector<PlanRequest> requests_;
  std::vector<int> events_;
  std::array<PlannerObservation, core::kMaxPlanners> seen_{};  // by Behavior::planners
  std::array<double, core::kMaxContacts> side_{};              // +1 left, -1 right of the base
  std::uint32_t sequence_ = 0;
};

}  // namespace footfall::behaviors
