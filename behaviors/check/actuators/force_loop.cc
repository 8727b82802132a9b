// Windings and real crossings of a force's loop; see force_loop.h.
#include "behaviors/check/actuators/force_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace footfall::behaviors {
namespace {

using Complex = std::complex<double>;
constexpr double kHalfTurn = std::numbers::pi;

// Evenly to half a turn, evenly by decade below 0.01, and around each corner by decades of its
// distance from the unit circle.
std::vector<double> angles_around(const std::vector<Complex>& corners) {
  constexpr int kEven = 1200, kPerDecade = 24;
  constexpr double kLeast = 1e-9, kDecade = 10.0;
  std::vector<double> angles = {0.0};
  const auto decades = [](double from, double to, const auto& take) {
    const double ratio = std::pow(kDecade, 1.0 / kPerDecade);
    for (double a = from; a < to; a *= ratio) take(a);
  };
  for (int k = 1; k <= kEven; ++k) angles.push_back(k * kHalfTurn / kEven);
  decades(kLeast, kHalfTurn / kEven, [&](double a) { angles.push_back(a); });
  for (const Complex& corner : corners) {
    const double middle = std::abs(std::arg(corner));
    const double distance = std::max(kLeast, 1.0 - std::abs(corner));
    if (distance > 0.1 || middle == 0.0) continue;
    angles.push_back(middle);
    decades(0.1 * distance, kHalfTurn / kEven, [&](double a) {
      if (middle > a) angles.push_back(middle - a);
      if (middle + a < kHalfTurn) angles.push_back(middle + a);
    });
  }
  std::ranges::sort(angles);
  angles.erase(std::unique(angles.begin(), angles.end()), angles.end());
  return angles;
}

// exp(i angle) - 1, without the difference of near numbers.
Complex step_from_one(double angle) {
  const double half = 0.5 * angle;
  return Complex(0.0, 2.0 * std::sin(half)) * std::polar(1.0, half);
}

}  // namespace

TensionPlant::TensionPlant(std::vector<Actuator> actuators) : actuators_(std::move(actuators)) {
  std::vector<Complex> corners;
  for (const Actuator& actuator : actuators_) {
    corners.insert(corners.end(), actuator.corners.begin(), actuator.corners.end());
  }
  angles_ = angles_around(corners);
  for (const Actuator& actuator : actuators_) {
    std::vector<Complex>& table = tables_.emplace_back();
    for (const double angle : angles_) table.push_back(actuator.response(angle));
  }
}

TensionPlant TensionPlant::ideal(int periods) {
  return TensionPlant(
      {{[periods](double angle) { return std::polar(1.0, -periods * angle); }, {}}});
}

TensionPlant TensionPlant::elastic(const std::vector<TorqueResponse>& joints) {
  std::vector<Actuator> actuators;
  for (const TorqueResponse& joint : joints) {
    actuators.push_back({[joint](double angle) { return joint.at(angle); }, joint.poles()});
  }
  return TensionPlant(std::move(actuators));
}

std::vector<Complex> TensionPlant::table(const std::vector<double>& shares) const {
  std::vector<Complex> sum(angles_.size(), 0.0);
  for (std::size_t j = 0; j < tables_.size(); ++j) {
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += shares[j] * tables_[j][k];
  }
  return sum;
}

Complex TensionPlant::at(const std::vector<double>& shares, double angle) const {
  Complex sum = 0.0;
  for (std::size_t j = 0; j < actuators_.size(); ++j) {
    if (shares[j] != 0.0) sum += shares[j] * actuators_[j].response(angle);
  }
  return sum;
}

ForceLoop::ForceLoop(const TensionPlant& plant, std::vector<double> shares, double bandwidth,
                     double period)
    : plant_(plant), shares_(std::move(shares)), period_(period), response_(plant.table(shares_)) {
  if (bandwidth > 0.0) new_share_ = -std::expm1(-2.0 * std::numbers::pi * bandwidth * period);
  for (std::size_t k = 0; k < response_.size(); ++k) response_[k] *= low_pass(plant.angles()[k]);
}

Complex ForceLoop::low_pass(double angle) const {
  const Complex z = std::polar(1.0, angle);
  return new_share_ * z / (step_from_one(angle) + new_share_);
}

// With an integral the left side is taken times z - 1: one more zero, and no pole on the circle.
// Its windings are then one more.
bool ForceLoop::is_stable(const FeedbackGains& gains) const {
  const bool integral = gains.integral != 0.0;
  const auto side = [&](std::size_t k) {
    const double angle = plant_.angles()[k];
    const Complex both = 1.0 + gains.proportional * response_[k];
    if (!integral) return both;
    const Complex z = std::polar(1.0, angle);
    return step_from_one(angle) * both + gains.integral * period_ * z * response_[k];
  };
  double turned = 0.0;
  Complex before = side(0);
  for (std::size_t k = 1; k < response_.size(); ++k) {
    const Complex now = side(k);
    turned += std::arg(now / before);
    before = now;
  }
  return std::lround(turned / kHalfTurn) == (integral ? 1 : 0);
}

// The K_F for which exp(i angle) would be a root; a gain where it is real.
Complex ForceLoop::bound(double angle, double integral) const {
  const Complex value = -1.0 / (low_pass(angle) * plant_.at(shares_, angle));
  if (integral == 0.0) return value;
  return value - integral * period_ * std::polar(1.0, angle) / step_from_one(angle);
}

std::vector<double> ForceLoop::bounds(double integral) const {
  constexpr int kHalvings = 50;
  constexpr double kReal = 1e-6;  // relative: else H is 0 there
  const std::vector<double>& angles = plant_.angles();
  const auto off = [&](std::size_t k) {
    const Complex value = -1.0 / response_[k];
    const Complex z = std::polar(1.0, angles[k]);
    return (integral == 0.0 ? value : value - integral * period_ * z / step_from_one(angles[k]))
        .imag();
  };
  std::vector<double> found = {bound(kHalfTurn, integral).real()};
  if (integral == 0.0) found.push_back(bound(0.0, 0.0).real());
  for (std::size_t k = 2; k + 1 < angles.size(); ++k) {
    const double start = off(k - 1);
    if (start * off(k) > 0.0) continue;
    double low = angles[k - 1], high = angles[k];
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (low + high);
      (start * bound(middle, integral).imag() > 0.0 ? low : high) = middle;
    }
    const Complex there = bound(high, integral);
    if (std::abs(there.imag()) <= kReal * (1.0 + std::abs(there.real()))) {
      found.push_back(there.real());
    }
  }
  std::ranges::sort(found);
  return found;
}

double ForceLoop::limit(const FeedbackGains& gains) const {
  const std::vector<double> all = bounds(gains.integral);
  auto above = std::ranges::upper_bound(all, gains.proportional);
  if (is_stable(gains)) {
    return above == all.end() ? std::numeric_limits<double>::infinity() : *above;
  }
  while (above != all.begin() && *(above - 1) > 0.0) {
    --above;
    const double below = above == all.begin() ? 0.0 : std::max(0.0, *(above - 1));
    if (is_stable({0.5 * (below + *above), gains.integral})) return *above;
  }
  return 0.0;
}

}  // namespace footfall::behaviors
