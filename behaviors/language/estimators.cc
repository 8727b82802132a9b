// One row an estimator, one a parameter; see estimators.h.
#include "behaviors/language/estimators.h"

#include <algorithm>
#include <array>

namespace footfall::behaviors {
namespace {

using core::kAcceleration;
using core::kForce;
using core::kLength;
using core::kNone;
using core::kRate;
using core::kRateSquared;
using core::kTime;
using core::kVelocity;

// First of every estimator that measures (engine/estimators/measured.h).
constexpr std::array kMeasured = {
    EstimatorParameter{"joint_velocity_filter", kTime, 2e-3, 0.0, 0.1,
                       "time constant of the joint velocities' low-pass; 0: none"},
    EstimatorParameter{
        "encoder_time", kTime, 0.05, 0.0, 10.0,
        "beyond this time a joint's position is its encoder's, below it that of motor "
        "less deflection; 0: always the encoder's"},
    EstimatorParameter{"contact_debounce", kTime, 2e-3, 0.0, 0.1,
                       "a foot switch opens after it has been open this long"},
    EstimatorParameter{"contact_force", kForce, 50.0, 1.0, 1e4,
                       "upward force by measured torques from which on a foot touches; half of it "
                       "when it already does"},
    EstimatorParameter{"anchor_settle", kTime, 0.01, 0.0, 1.0,
                       "from touchdown until a foot counts as keeping its place"},
    EstimatorParameter{"anchor_release", kTime, 0.0, 0.0, 1.0,
                       "a foot that the law has not relied on for longer may slip"},
};

template <std::size_t Count>
constexpr auto measured_and(const std::array<EstimatorParameter, Count>& own) {
  std::array<EstimatorParameter, kMeasured.size() + Count> all{};
  std::copy(kMeasured.begin(), kMeasured.end(), all.begin());
  std::copy(own.begin(), own.end(), all.begin() + kMeasured.size());
  return all;
}

constexpr auto kMotionCapture = measured_and(std::array{
    EstimatorParameter{
        "lambda", kLength, 2.0, 0.01, 1e3,
        "weight of the gyro's prediction: a frame's gain is Z Z^T/(Z Z^T + lambda^2) "
        "with Z the seen markers about their mean"},
    EstimatorParameter{
        "gyro_bias_gain", kRate, 0.3, 0.0, 10.0,
        "integral of the frames' corrections of orientation; 0: none, as in the paper"},
    EstimatorParameter{"oldest_frame", kTime, 0.05, 0.0, 0.08,
                       "frames of motion capture older than this are not used"},
    EstimatorParameter{"position_gain", kRate, 20.0, 0.0, 500.0,
                       "of a frame's position on the position"},
    EstimatorParameter{"velocity_gain", kRateSquared, 100.0, 0.0, 1e4,
                       "of a frame's position on the velocity"},
    EstimatorParameter{"leg_velocity_time", kTime, 0.1, 0.0, 100.0,
                       "time constant from the accelerometer's velocity to that of the feet that "
                       "keep their place; 0: the legs alone"},
    EstimatorParameter{
        "acceleration_gain", kRate, 1.0, 0.0, 20.0,
        "integral of the velocity's corrections: takes out the accelerometer's error; "
        "0: none"},
});
constexpr auto kContactKalman = measured_and(std::array<EstimatorParameter, 0>{});
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
