// Whether an estimator's errors are as large as its covariance says.
#pragma once

#include <array>

#include "engine/estimators/estimator.h"

namespace footfall::lab {

// Normalised squared error eᵀ P⁻¹ e of roll and pitch (the rotation vector's components about the
// estimate's horizontal world axes) and of the base's velocity. Heading and place are left out, as
// feet and IMU do not see them: the truth is first turned about the vertical by the heading's
// error, so that it may be large. Errors of roll and pitch to first order. A consistent estimator's
// mean is kNeesDimension, and 2 and 3 of its parts. NaN if P is singular.
inline constexpr int kNeesDimension = 5;
struct NormalisedError {
  double all = 0.0, tilt = 0.0, velocity = 0.0;
};
NormalisedError normalised_error(const model::State& estimate, const model::State& truth,
                                 const engine::ErrorCovariance& covariance);

// Where an estimator's world is in that of the truth: turned about the vertical and moved
// horizontally, so that its first estimate is the truth.
class StartFrame {
 public:
  StartFrame(const model::State& estimate, const model::State& truth);
  // Of the horizontal place (dimension 2), as the estimator tells it in its own world: the way that
  // a wrong heading turned is in it. NaN if its covariance is singular.
  double normalised_place(const model::State& estimate, const model::State& truth,
                          const engine::ErrorCovariance& covariance) const;

 private:
  double yaw_ = 0.0;                            // rad, of the truth's less the estimate's
  std::array<double, 3> truth_{}, estimate_{};  // m, places at the start
};

// Mean over ticks.
struct NeesFigure {
  double sum = 0.0;
  std::int64_t count = 0;
  void add(double value) {
    sum += value;
    ++count;
  }
  double mean() const { return count > 0 ? sum / static_cast<double>(count) : 0.0; }
};

}  // namespace footfall::lab
