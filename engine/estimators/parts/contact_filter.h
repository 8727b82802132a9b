// Which contacts touch the ground, and which of them an estimator may hold on to.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "behaviors/compiled/estimator_spec.h"
#include "core/capacities.h"
#include "hal/sensor_fields.h"
#include "model/control_model.h"
#include "model/robot/description.h"

namespace footfall::engine {

// A contact each.
using ContactFlags = std::array<bool, core::kMaxContacts>;

// Live settings, from the table's rows of the same names.
struct ContactSettings {
  double debounce = 0.0;  // s, a contact opens when it has been open this long
  double force = 0.0;     // N upward, by measured torques, from which on a foot touches
  double settle = 0.0;    // s, from touchdown until a foot is an anchor
  double release = 0.0;   // s, without support after which a foot is no anchor
};

// Switches: as they are, opening after `debounce`. Torques: the upward part of the force that the
// leg's measured torques stand against, f = -(J_legᵀ)⁺ (tau - h_leg) with h the model's bias force
// (gravity and velocity terms, no acceleration): closes above `force`, opens below half of it.
// Both: closes when either says so, opens when neither does.
class ContactFilter {
 public:
  ContactFilter(const model::RobotDescription& robot, behaviors::ContactSource source);
  // `model` of the last tick; support: bit c, the law relies on contact c.
  void update(const hal::Sensors& sensors, const model::ControlModel& model, std::uint64_t support,
              const ContactSettings& settings) noexcept;
  void take_over(const ContactFilter& old) noexcept { memory_ = old.memory_; }

  const ContactFlags& contact() const noexcept { return memory_.contact; }
  // A foot that touches, has settled, and that the law in force relies on: it keeps its place.
  bool anchor(int c) const noexcept;
  int count() const noexcept { return static_cast<int>(legs_.size()); }
  // N, upward, of the last update; 0 if torques are not asked.
  double force(int c) const noexcept { return memory_.force[static_cast<std::size_t>(c)]; }

 private:
  bool by_switch(std::size_t c, bool closed, double debounce) noexcept;
  double leg_force(const hal::Sensors& sensors, const model::ControlModel& model,
                   int c) const noexcept;

  behaviors::ContactSource source_;
  double period_;
  std::vector<std::vector<int>> legs_;  // joints by contact
  ContactSettings settings_;
  struct Memory {
    bool started = false;
    ContactFlags contact{}, switched{}, pressed{};
    std::array<double, core::kMaxContacts> open{};         // s that the switch has been open
    std::array<double, core::kMaxContacts> touching{};     // s since touchdown
    std::array<double, core::kMaxContacts> unsupported{};  // s
    std::array<double, core::kMaxContacts> force{};        // N
  } memory_;
};

}  // namespace footfall::engine
