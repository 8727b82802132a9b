// One row an estimator, one a parameter; see estimators.h.
#include "behaviors/language/estimators.h"

#include <array>

namespace footfall::behaviors {
namespace {

using core::kTime;

constexpr std::array kMotionCapture = {
    EstimatorParameter{"joint_velocity_filter", kTime, 4e-3, 0.0, 0.1,
                       "time constant of the joint velocities' low-pass"},
};
constexpr std::array kContactKalman = {
    EstimatorParameter{"joint_velocity_filter", kTime, 4e-3, 0.0, 0.1,
                       "time constant of the joint velocities' low-pass"},
};
constexpr std::array kTypes = {
    EstimatorInfo{"true_state", "the simulator's own state", false, false, false, {}},
    EstimatorInfo{"motion_capture", "IMU, motion capture and leg kinematics", true, true, true,
                  kMotionCapture},
    EstimatorInfo{"contact_kalman", "IMU, leg kinematics and contacts, no motion capture", true,
                  false, true, kContactKalman},
};

}  // namespace

std::span<const EstimatorInfo> estimator_types() { return kTypes; }

}  // namespace footfall::behaviors
