// Rows and memory of internal forces; see internal_forces.h.
#include "tasks/internal_forces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/index.h"
#include "tasks/statics.h"

namespace footfall::tasks {
namespace {

// The contacts as one number; of a pair, and `as_set`, whatever their order.
std::uint32_t key_of(std::array<int, 4> contacts, int count, bool as_set = false) noexcept {
  if (count == 2 || as_set) std::sort(contacts.begin(), contacts.begin() + count);
  std::uint32_t key = 0;
  for (int i = 0; i < count; ++i) {
    key = (key << 8) | static_cast<std::uint32_t>(contacts[at(i)] + 1);
  }
  return key;
}

bool named(const ControlSet& set, const std::array<int, 4>& contacts, int count) noexcept {
  const std::uint32_t key = key_of(contacts, count, true);
  for (int i = 0; i < set.internal_count; ++i) {
    const InternalCommand& c = set.internals[at(i)];
    if (key_of(c.contacts, c.contact_count, true) == key) return true;
  }
  return false;
}

// Tension between contacts a and b, mean convention, as a row on f (ground on robot): pushing apart
// means the robot pushes a away from b, so f_a points back: F = -½ x̂ᵀ (f_a - f_b). Contacts at the
// same place have no direction; their row stays without rank.
// Source: [Kim16] eqs. (7)-(10) with E10 (each foot's force, not the sum).
void tension_row(const model::ControlModel& model, const ControlSet& set,
                 const std::array<int, 4>& contacts, double* w) noexcept {
  const std::array<double, 3>& a = model.point_position(contacts[0]);
  const std::array<double, 3>& b = model.point_position(contacts[1]);
  const double distance = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  if (distance < 1e-6) return;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = (a[k] - b[k]) / distance;
    w[3 * at(place_in(set, contacts[0])) + k] = -0.5 * x;
    w[3 * at(place_in(set, contacts[1])) + k] = 0.5 * x;
  }
}

// Vertical warp of four contacts: c_i on f_iz with Σ c_i = 0 and Σ c_i (x_i, y_i) = 0, so that
// vertical forces in proportion to c balance each other; c_1 > 0 and Σ|c_i| = 1, by which it is the
// change at each foot where the four are a parallelogram. c_i is the oriented area of the triangle
// of the other three, signs alternating; contacts in a line have none, and no rank.
void warp_row(const model::ControlModel& model, const ControlSet& set,
              const std::array<int, 4>& contacts, double* w) noexcept {
  std::array<double, 4> c{};
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& p = model.point_position(contacts[(i + 1) % 4]);
    const auto& q = model.point_position(contacts[(i + 2) % 4]);
    const auto& r = model.point_position(contacts[(i + 3) % 4]);
    const double area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
    c[i] = i % 2 == 0 ? area : -area;
    sum += std::abs(c[i]);
  }
  if (sum < 1e-9) return;
  if (c[0] < 0.0) sum = -sum;
  for (std::size_t i = 0; i < 4; ++i) w[3 * at(place_in(set, contacts[i])) + 2] = c[i] / sum;
}

}  // namespace

int place_in(const ControlSet& set, int contact) noexcept {
  for (int i = 0; i < set.contact_count; ++i) {
    if (set.contacts[at(i)] == contact) return i;
  }
  return -1;
}

int internal_rows(int contacts) noexcept {
  const int pairs = contacts * (contacts - 1) / 2;
  return pairs + (contacts > 3 ? contacts - 3 + core::kMaxInternal : 0);
}

bool holds(const ControlSet& set, const InternalCommand& command) noexcept {
  for (int i = 0; i < command.contact_count; ++i) {
    if (place_in(set, command.contacts[at(i)]) < 0) return false;
  }
  return true;
}

const InternalForces::Memory* InternalForces::find(std::uint32_t key,
                                                   std::int64_t tick) const noexcept {
  for (const Memory& m : memory_) {
    if (m.key == key && m.tick == tick) return &m;
  }
  return nullptr;
}

// The low-pass of a force that was not in force in the last tick begins without error: feedback
// comes in with the low-pass's own time, whatever the torques before were.
void InternalForces::name_row(WboscProblem& problem, int row, const InternalCommand& c,
                              double reference, std::int64_t tick, bool alone) const noexcept {
  const std::size_t r = at(row);
  const Memory* last = find(key_of(c.contacts, c.contact_count), tick - 1);
  double share = 1.0;
  if (c.ramp > 0.0) {
    const std::int64_t ticks = last && last->began >= 0 ? tick - last->began : 0;
    share = std::min(1.0, static_cast<double>(ticks) * period_ / c.ramp);
  }
  reference *= share;
  constexpr double kTurn = 2.0 * std::numbers::pi;
  problem.F_int[r] = reference;
  problem.K_F[r] = c.feedback;
  problem.error_part[r] = alone ? share : 0.0;
  problem.error_share[r] = c.bandwidth > 0.0 ? -std::expm1(-kTurn * c.bandwidth * period_) : 1.0;
  problem.F_before[r] = last ? last->reference : reference;
  problem.error_before[r] = last ? last->error : 0.0;
  problem.integral_gain[r] = alone ? c.integral * period_ : 0.0;
  problem.integral_before[r] = last ? last->integral : 0.0;
  problem.integral_limit[r] = c.integral_limit;
}

void InternalForces::assemble(WboscProblem& problem, const ControlSet& set, std::int64_t tick,
                              bool alone) const noexcept {
  const int columns = problem.contact_rows;
  int row = 0;
  const auto begin_row = [&](const std::array<int, 4>& contacts, int count) {
    double* w = problem.W_int.data() + row * columns;
    std::fill_n(w, columns, 0.0);
    count == 2 ? tension_row(model_, set, contacts, w) : warp_row(model_, set, contacts, w);
    return w;
  };
  std::array<double, at(3 * core::kMaxContacts)> rest;
  bool known = false;
  for (int i = 0; i < set.internal_count; ++i) {
    const InternalCommand& c = set.internals[at(i)];
    if (!holds(set, c)) continue;
    const double* w = begin_row(c.contacts, c.contact_count);
    double reference = c.reference;
    if (c.statics != 0.0) {
      if (!known) static_forces(model_, set.contacts.data(), set.contact_count, rest.data());
      known = true;
      reference = 0.0;
      for (int k = 0; k < 3 * set.contact_count; ++k) reference += c.statics * w[k] * rest[at(k)];
    }
    name_row(problem, row++, c, reference, tick, alone);
  }
  problem.named_internal_rows = row;
  const auto add = [&](const std::array<int, 4>& contacts, int count) {
    if (row == rows_ || named(set, contacts, count)) return;
    begin_row(contacts, count);
    name_row(problem, row++, {}, 0.0, tick, alone);
  };
  for (int i = 0; i < set.contact_count; ++i) {
    for (int j = i + 1; j < set.contact_count; ++j) {
      add({set.contacts[at(i)], set.contacts[at(j)]}, 2);
    }
  }
  for (int i = 3; i < set.contact_count; ++i) {
    add({set.contacts[0], set.contacts[1], set.contacts[2], set.contacts[at(i)]}, 4);
  }
  problem.internal_rows = row;
}

void InternalForces::keep(const Wbosc& solver, const ControlSet& set, std::int64_t tick,
                          bool alone) noexcept {
  int row = 0;
  for (int i = 0; i < set.internal_count; ++i) {
    const InternalCommand& c = set.internals[at(i)];
    if (!holds(set, c)) continue;
    const std::uint32_t key = key_of(c.contacts, c.contact_count);
    const Memory* last = find(key, tick - 1);
    if (last == nullptr) last = find(key, tick);  // the other law's, just kept
    std::int64_t began = last ? last->began : -1;
    if (began < 0 && alone) began = tick;
    Memory* place =
        memory_.data();  // of the same force, else the one not used for the longest time
    for (Memory& m : memory_) {
      if (m.key == key) place = &m;
      if (place->key != key && m.tick < place->tick) place = &m;
    }
    const WboscSolution& out = solver.solution();
    const double error = out.internal_error[at(row)], integral = out.internal_integral[at(row)];
    *place = {key, tick, began, solver.reference(row), error, integral};
    ++row;
  }
}

}  // namespace footfall::tasks
