// From sensors to the state that the control model is updated with. Estimators are listed in
// catalogue.h; docs/adding_an_estimator.md says how to add one.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/capacities.h"
#include "hal/hardware.h"
#include "model/control_model.h"
#include "model/state.h"

namespace footfall::engine {

// What an estimator knows in a tick.
struct EstimatorInput {
  const hal::Sensors& sensors;
  // Updated with the last estimate: its kinematics hold for this tick to first order in the joint
  // angles' change, whose square is below 1e-5 m. Before the first estimate: the base at the
  // origin, upright, joints as measured.
  const model::ControlModel& model;
  // Contacts that the control law in force relies on since the last tick: bit c of contact c.
  std::uint64_t support = 0;
  // Its parameters, SI, in the order of its table (behaviors/language/estimators.h).
  std::span<const double> parameters;
  // The joints' values are of this tick; else the last good ones.
  bool joints_fresh = true;
};

// How an estimator judges itself; what it does not estimate is NaN.
struct EstimateQuality {
  std::array<double, 3> gyro_bias{};           // rad/s, IMU frame
  std::array<double, 3> accelerometer_bias{};  // m/s^2, IMU frame
  // Standard deviations.
  std::array<double, 3> attitude{};  // rad, about the world's axes
  std::array<double, 3> position{};  // m, world
  std::array<double, 3> velocity{};  // m/s, world
  // Norms of the last innovations; 0: none in this tick.
  double marker_innovation = 0.0;     // m, rms over the markers seen
  double kinematic_innovation = 0.0;  // m/s or m, by the estimator, largest of the contacts
  int markers = 0;                    // used of the last frame
};

using Contacts = std::array<bool, core::kMaxContacts>;  // by contact: it touches the ground

struct Estimate {
  model::State state;
  Contacts contact{};
  EstimateQuality quality;
};

// Covariance of the estimate's error (estimate less truth), row-major: attitude (rotation vector
// from the true to the estimated base, rad, world axes), velocity and position of the base's origin
// (m/s and m, world axes).
using ErrorCovariance = std::array<double, 81>;

class Estimator {
 public:
  virtual ~Estimator() = default;
  // Once per tick; allocates nothing. False: the sensors cannot give a state (no truth, stale
  // data); `estimate` is then unchanged.
  virtual bool estimate(const EstimatorInput& input, Estimate& estimate) noexcept = 0;
  // For tests and tools. False: this estimator does not know, or has not started.
  virtual bool covariance(ErrorCovariance& covariance) const noexcept {
    (void)covariance;
    return false;
  }
  // Instead of a start: goes on from an estimator of the same type, or else from its estimate.
  virtual void take_over(const Estimator& old, const Estimate& last) noexcept {
    (void)old;
    (void)last;
  }
};

}  // namespace footfall::engine
