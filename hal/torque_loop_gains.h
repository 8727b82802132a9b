// Gains of an actuator's torque loop; actuators/torque_loop.h has the laws and the units.
#pragma once

#include <cstdint>

namespace footfall::hal {

struct TorqueLoopGains {
  enum class Type : std::uint8_t { cascade, direct };
  enum class Damping : std::uint8_t { motor, spring };  // of `direct`: θ', or θ' − q'
  Type type = Type::cascade;
  double p = 0.0, i = 0.0;                    // of the torque error
  double velocity_p = 0.0, velocity_i = 0.0;  // cascade
  double forward = 1.0, damping = 0.0;        // direct
  double observer = 0.0;                      // direct: w/2π, Hz; 0: none
  Damping damps = Damping::motor;
  bool operator==(const TorqueLoopGains&) const = default;
};

// Whether no torque reference makes the motor move.
constexpr bool gives_no_torque(const TorqueLoopGains& g) noexcept {
  const bool no_error = g.p == 0.0 && g.i == 0.0;
  if (g.type == TorqueLoopGains::Type::direct) return no_error && g.forward == 0.0;
  return no_error || (g.velocity_p == 0.0 && g.velocity_i == 0.0);
}

}  // namespace footfall::hal
