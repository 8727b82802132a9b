// Which estimator a behavior asks for.
#pragma once

#include <cstdint>

#include "core/yaml/yaml.h"

namespace footfall::behaviors {

// In the order of kEstimatorTypes (behaviors/language/estimators.h).
enum class EstimatorType : std::uint8_t {
  true_state,      // the simulator's own state
  motion_capture,  // [Kim16] Appendix C: IMU, motion capture, leg kinematics
  contact_kalman,  // IMU, leg kinematics, contacts: an error-state Kalman filter
};

// What tells that a foot touches the ground.
enum class ContactSource : std::uint8_t { switches, torque, both };

struct EstimatorSpec {
  EstimatorType type = EstimatorType::true_state;
  ContactSource contact = ContactSource::switches;
  int first_slot = 0;  // of its parameters in Behavior::values, in the order of its table
  int slots = 0;
  core::Mark mark;  // of the section
};

}  // namespace footfall::behaviors
