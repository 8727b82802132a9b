// Whether an estimator's errors are as large as its covariance says.
#pragma once

#include "engine/estimators/estimator.h"

namespace footfall::lab {

// Normalised squared error eᵀ P⁻¹ e of roll and pitch (the rotation vector's components about the
// estimate's horizontal world axes) and of the base's velocity. Heading and place are left out, as
// feet and IMU do not see them: the truth is first turned about the vertical by the heading's
// error, so that it may be large. Errors of roll and pitch to first order. A consistent estimator's
// mean is kNeesDimension. NaN if P is singular.
inline constexpr int kNeesDimension = 5;
double normalised_error(const model::State& estimate, const model::State& truth,
                        const engine::ErrorCovariance& covariance);

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
