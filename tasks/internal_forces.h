// Internal forces of the control laws in force: their rows on the contact forces, and what is
// remembered of each one between ticks (low-pass, integral, the tick in which it began).
//
// The complete basis for n contacts is every pair's tension and, from four contacts on, a vertical
// warp each for the fourth and later ones: tensions of coplanar contacts have rank 2n - 3 of 3n
// - 6.
#pragma once

#include <array>
#include <cstdint>

#include "model/control_model.h"
#include "tasks/active_set.h"
#include "tasks/solver/wbosc.h"

namespace footfall::tasks {

// Most rows of a law with `contacts` contacts.
int internal_rows(int contacts) noexcept;

class InternalForces {
 public:
  InternalForces(const model::ControlModel& model, double period, int rows)
      : model_(model), period_(period), rows_(rows) {}

  // The law's rows into the problem: those that it names and whose contacts hold, in order, then
  // the rest of the basis at 0 N. `alone`: no other law acts, so that what is measured is this
  // one's and is fed back. Allocates nothing.
  void assemble(WboscProblem& problem, const ControlSet& set, std::int64_t tick,
                bool alone) const noexcept;
  // After solve(): remembers what the rows' feedback has come to.
  void keep(const Wbosc& solver, const ControlSet& set, std::int64_t tick, bool alone) noexcept;
  // Goes on where another controller of the same robot stands.
  void take_over(const InternalForces& old) noexcept { memory_ = old.memory_; }

 private:
  // A force by its contacts: one pair has one, whatever its name and order. The sign of a warp
  // depends on the order.
  struct Memory {
    std::uint32_t key = 0;  // 0: unused
    std::int64_t tick = -2;
    std::int64_t began = -1;                              // to act alone; -1: not yet
    double reference = 0.0, error = 0.0, integral = 0.0;  // N, mean convention
  };
  const Memory* find(std::uint32_t key, std::int64_t tick) const noexcept;
  void name_row(WboscProblem& problem, int row, const InternalCommand& command, double reference,
                std::int64_t tick, bool alone) const noexcept;

  const model::ControlModel& model_;
  double period_;
  int rows_;
  std::array<Memory, 2 * core::kMaxInternal> memory_{};
};

// Index of a robot contact within the set, -1 if it does not hold.
int place_in(const ControlSet& set, int contact) noexcept;
// Whether all of its contacts are in the set.
bool holds(const ControlSet& set, const InternalCommand& command) noexcept;

}  // namespace footfall::tasks
