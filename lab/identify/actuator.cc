// Weighted least squares over windows between reversals; see actuator.h.
#include "lab/identify/actuator.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/index.h"
#include "lab/identify/windows.h"

namespace footfall::lab {
namespace {

constexpr int kParameters = 5;
enum Column { kRotor, kViscous, kCoulomb, kSpring, kOffset };
using Vector = Eigen::Matrix<double, kParameters, 1>;
using Matrix = Eigen::Matrix<double, kParameters, kParameters>;

constexpr double kLongestWindow = 0.08;    // s
constexpr double kShortestWindow = 0.012;  // s
constexpr int kFewestIntervals = 15;
constexpr double kFewestSteps = 100.0;  // of the encoder: below this travel the motor is still

// One equation, divided by ∫φ of the even φ: in N m, a mean over the window.
struct Row {
  Vector regressors = Vector::Zero();
  Matrix noise = Matrix::Zero();  // expected square of what the encoders' steps add to regressors
  double rising = 0.0;            // mean direction in which the deflection moves
  double motor_torque = 0.0;
  double weight = 0.0;  // s
  int interval = 0;
};

struct Noise {
  double angle = 0.0, deflection = 0.0;  // rad^2, variances
};

double step_variance(double step) { return step * step / 12.0; }

// Mean of φu over the tick before sample k, φ expanded about the tick's middle. Without moments u
// is taken as smooth: its own are dt^2 u'/12, and by parts their sum becomes one over φ'' u.
double modulated_torque(const ActuatorRecord& record, int k, const Modulation& phi, double parts) {
  const double u = record.motor_torque[at(k)];
  const double curve = phi.second / (24.0 * parts * parts) * u;
  if (record.moment.empty()) return phi.value * u - curve;
  const double slope = phi.first / (parts * record.period);
  return phi.value * u + curve + slope * record.moment[at(k)];
}

double direction_of(std::span<const double> values, int k) {
  const int last = static_cast<int>(values.size()) - 1;
  const double moved =
      values[at(std::min(k + kSlopeReach, last))] - values[at(std::max(k - kSlopeReach, 0))];
  return moved > 0.0 ? 1.0 : moved < 0.0 ? -1.0 : 0.0;
}

Row row_of(const ActuatorRecord& record, const Interval& window, bool odd, const Noise& noise) {
  const double dt = record.period, parts = window.length() - 1, duration = parts * dt;
  const double late = record.drive_step / dt - 0.5;  // ticks from a sample to its torque's middle
  const double origin = record.motor[at((window.first + window.last) / 2)];
  Row row;
  double even = 0.0;
  for (int k = window.first; k <= window.last; ++k) {
    const double x = (k - window.first) / parts;
    const Modulation phi = modulation(x, odd);
    const double angle = record.motor[at(k)] - origin;
    const double first = phi.first / duration, second = phi.second / (duration * duration);
    Vector& r = row.regressors;
    r[kRotor] += second * angle;
    r[kViscous] -= first * angle;
    r[kCoulomb] += window.direction * phi.value;
    r[kSpring] += phi.value * record.torque[at(k)] / record.nominal_spring;
    r[kOffset] += phi.value;
    row.noise(kRotor, kRotor) += noise.angle * second * second;
    row.noise(kRotor, kViscous) -= noise.angle * second * first;
    row.noise(kViscous, kViscous) += noise.angle * first * first;
    row.noise(kSpring, kSpring) += noise.deflection * phi.value * phi.value;
    row.rising += phi.value * direction_of(record.torque, k);
    even += modulation(x, false).value;
    row.motor_torque += modulated_torque(record, k, modulation(x + late / parts, odd), parts);
  }
  row.noise(kViscous, kRotor) = row.noise(kRotor, kViscous);
  row.regressors /= even;
  row.noise /= even * even;
  row.motor_torque /= even;
  row.rising /= even;
  row.weight = even * dt;
  return row;
}

std::vector<Row> rows_of(const ActuatorRecord& record, std::span<const Interval> intervals) {
  const Noise noise{step_variance(encoder_step(record.motor)),
                    step_variance(encoder_step(record.torque) / record.nominal_spring)};
  const int longest = static_cast<int>(std::lround(kLongestWindow / record.period)) + 1;
  std::vector<Row> rows;
  for (std::size_t i = 0; i < intervals.size(); ++i) {
    for (const Interval& window : windows_of(intervals[i], longest)) {
      for (const bool odd : {false, true}) {
        rows.push_back(row_of(record, window, odd, noise));
        rows.back().interval = static_cast<int>(i);
      }
    }
  }
  return rows;
}

double condition_of(const Matrix& normal) {
  const Vector scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Matrix scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  const Vector values = Eigen::SelfAdjointEigenSolver<Matrix>(scaled).eigenvalues();
  return values[0] > 0.0 ? std::sqrt(values[kParameters - 1] / values[0]) : 1e9;
}

// Covariance of the parameters that holds for residuals that are correlated within an interval and
// of any size: (XᵀWX)^-1 Σ s sᵀ (XᵀWX)^-1 with s = Σ w x r of an interval.
Matrix covariance_of(std::span<const Row> rows, const Matrix& inverse, const Vector& found,
                     double clusters) {
  Matrix meat = Matrix::Zero();
  for (std::size_t k = 0; k < rows.size();) {
    Vector sum = Vector::Zero();
    const int interval = rows[k].interval;
    for (; k < rows.size() && rows[k].interval == interval; ++k) {
      const double residual = rows[k].motor_torque - rows[k].regressors.dot(found);
      sum += rows[k].weight * residual * rows[k].regressors;
    }
    meat += sum * sum.transpose();
  }
  return inverse * meat * inverse * (clusters / (clusters - kParameters));
}

// Allowance for what of the deflection's rounding does not average out under a torque loop: half of
// its rms value (N m, `rounding`) with the sign of the deflection's rate, and with that of the
// motor's. The half is empirical, see docs/identify.md.
Matrix rounding_covariance(std::span<const Row> rows, const Matrix& inverse, double rounding) {
  Vector shift = Vector::Zero();
  for (const Row& row : rows) shift += row.weight * row.rising * row.regressors;
  shift = 0.5 * rounding * (inverse * shift);
  Matrix out = shift * shift.transpose();
  out(kCoulomb, kCoulomb) += 0.25 * rounding * rounding;
  return out;
}

void solve(std::span<const Row> rows, double clusters, double deflection_step,
           ActuatorEstimate& out) {
  Matrix normal = Matrix::Zero(), noise = Matrix::Zero();
  Vector right = Vector::Zero();
  double weights = 0.0;
  for (const Row& row : rows) {
    normal += row.weight * row.regressors * row.regressors.transpose();
    noise += row.weight * row.noise;
    right += row.weight * row.motor_torque * row.regressors;
    weights += row.weight;
  }
  out.condition = condition_of(normal);
  // Noise of regressors pulls a least-squares solution towards 0: what it adds to XᵀWX is known.
  const Matrix inverse = (normal - noise).ldlt().solve(Matrix::Identity());
  const Vector found = inverse * right;
  const double rounding = found[kSpring] * std::sqrt(step_variance(deflection_step));
  const Matrix covariance =
      covariance_of(rows, inverse, found, clusters) + rounding_covariance(rows, inverse, rounding);
  double squares = 0.0;
  for (const Row& row : rows) {
    const double residual = row.motor_torque - row.regressors.dot(found);
    squares += row.weight * residual * residual;
  }
  out.residual = std::sqrt(squares / weights);
  const auto estimate = [&](Column c) {
    return Estimate{found[c], std::sqrt(std::max(0.0, covariance(c, c)))};
  };
  out.rotor = estimate(kRotor);
  out.viscous = estimate(kViscous);
  out.coulomb = estimate(kCoulomb);
  out.spring = estimate(kSpring);
  out.offset = estimate(kOffset);
}

}  // namespace

std::string_view name_of(Richness richness) noexcept {
  switch (richness) {
    case Richness::good:
      return "good";
    case Richness::poor:
      return "poor";
    case Richness::too_slow:
      return "too_slow";
    case Richness::still:
      return "still";
    case Richness::absurd:
      return "absurd";
  }
  return "";
}

ActuatorEstimate identify_actuator(const ActuatorRecord& record) {
  ActuatorEstimate out;
  if (record.motor.empty()) return out;
  const auto [least, most] = std::ranges::minmax(record.motor);
  out.travel = most - least;
  if (!(out.travel > kFewestSteps * encoder_step(record.motor)) || out.travel < 1e-9) return out;
  std::vector<Interval> intervals = moving_intervals(record.motor, record.period);
  const int shortest = static_cast<int>(std::lround(kShortestWindow / record.period)) + 1;
  std::erase_if(intervals, [&](const Interval& one) { return one.length() < shortest; });
  for (const Interval& one : intervals) out.used += (one.length() - 1) * record.period;
  out.richness = Richness::too_slow;
  if (static_cast<int>(intervals.size()) < kFewestIntervals) return out;
  const std::vector<Row> rows = rows_of(record, intervals);
  out.equations = static_cast<int>(rows.size());
  solve(rows, static_cast<double>(intervals.size()),
        encoder_step(record.torque) / record.nominal_spring, out);
  out.richness = out.condition <= kLargestCondition ? Richness::good : Richness::poor;
  const auto negative = [](const Estimate& e) { return e.value < -3.0 * e.error; };
  if (negative(out.spring) || negative(out.rotor) || negative(out.viscous) ||
      negative(out.coulomb)) {
    out.richness = Richness::absurd;
  }
  return out;
}

}  // namespace footfall::lab
