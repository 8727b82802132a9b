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

}  // namespace footfall::hal
