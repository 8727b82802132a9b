// Markers against each other; see marker_gate.h.
#include "engine/estimators/parts/marker_gate.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/capacities.h"
#include "core/index.h"

namespace footfall::engine {
namespace {

double median(std::span<double> values) noexcept {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return 0.5 * (*middle + *std::max_element(values.begin(), middle));
}

struct RotationFit {
  bool found = false;
  Matrix3d R = Matrix3d::Identity();
  double rms = std::numeric_limits<double>::infinity();    // m
  double worst = std::numeric_limits<double>::infinity();  // m
};

RotationFit fit_all(std::span<const MarkerPair> markers) noexcept {
  RotationFit fit;
  if (!fit_rotation(markers, fit.R)) return fit;
  const Vector3d origin = fit_affine(markers, fit.R, 0.0).origin(fit.R);
  fit.found = true;
  fit.rms = marker_residual(markers, fit.R, origin);
  fit.worst = 0.0;
  for (const MarkerPair& m : markers) {
    fit.worst = std::max(fit.worst, (origin + fit.R * m.place - m.position).norm());
  }
  return fit;
}

}  // namespace

int agreeing_markers(std::span<MarkerPair> markers, const Matrix3d& R, double gate) noexcept {
  const int count = static_cast<int>(markers.size());
  if (!(gate > 0.0) || count == 0) return count;
  Vector3d middle;
  std::array<double, core::kMaxMarkers> values;
  for (int k = 0; k < 3; ++k) {
    for (std::size_t m = 0; m < markers.size(); ++m) {
      values[m] = markers[m].position[k] - R.row(k).dot(markers[m].place);
    }
    middle[k] = median(std::span(values).first(markers.size()));
  }
  const auto kept = std::partition(markers.begin(), markers.end(), [&](const MarkerPair& m) {
    return (m.position - R * m.place - middle).norm() <= gate;
  });
  return static_cast<int>(kept - markers.begin());
}

int agreeing_rotation(std::span<MarkerPair> markers, double gate, Matrix3d& R) noexcept {
  constexpr std::size_t kFewest = 3;
  RotationFit fit = fit_all(markers);
  while (fit.found && gate > 0.0 && fit.worst > gate) {
    if (markers.size() <= kFewest) return 0;
    RotationFit best;
    std::size_t odd = 0;
    const auto rest = markers.first(markers.size() - 1);
    for (std::size_t m = 0; m < markers.size(); ++m) {
      std::swap(markers[m], markers.back());
      const RotationFit without = fit_all(rest);
      std::swap(markers[m], markers.back());
      if (without.rms >= best.rms) continue;
      best = without;
      odd = m;
    }
    std::swap(markers[odd], markers.back());
    markers = rest;
    fit = best;
  }
  if (!fit.found) return 0;
  R = fit.R;
  return static_cast<int>(markers.size());
}

}  // namespace footfall::engine
