// Markers of a frame that do not agree with the others: one that was moved, taken for another, or
// a reflection.
#pragma once

#include <span>

#include "engine/estimators/parts/marker_fit.h"

namespace footfall::engine {

// Both put the markers that agree first and return how many they are. Gate: m, 0: all agree.

// For a predicted orientation: a marker agrees if y - R z, which is the base's origin, is within
// the gate of the median (by component) over all markers. An error of the prediction moves it by
// the angle times the markers' distances from their middle, a common shift of the frame does not.
int agreeing_markers(std::span<MarkerPair> markers, const Matrix3d& R, double gate) noexcept;

// Without a prediction: while a marker is farther than the gate from where the rotation that fits
// best puts it, the one without which the rest fits best goes. 0 if fewer than three are left or
// they lie on a line; else R is their rotation.
int agreeing_rotation(std::span<MarkerPair> markers, double gate, Matrix3d& R) noexcept;

}  // namespace footfall::engine
