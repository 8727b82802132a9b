// Period-to-period map of a sampled loop and its spectral radius; see sampled_loop.h.
#include "behaviors/check/physics/sampled_loop.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/index.h"

namespace footfall::behaviors {
namespace {

using Vector = std::vector<double>;
using Columns = std::vector<Vector>;

// x, ẋ, ∫x, then the commands of the periods before, the last one first.
class PeriodMap {
 public:
  explicit PeriodMap(const SampledLoop& loop)
      : loop_(loop),
        step_(loop.period / loop.steps),
        late_(static_cast<int>(std::lround(loop.delay / step_))),
        commands_((late_ + loop.steps - 1) / loop.steps) {}

  Columns columns() const {
    Columns columns;
    for (int k = 0; k < 3 + commands_; ++k) {
      Vector unit(at(3 + commands_), 0.0);
      unit[at(k)] = 1.0;
      columns.push_back(after_period(unit));
    }
    return columns;
  }

 private:
  // An error that nothing feeds back is no part of the loop: it stays 0.
  Vector after_period(const Vector& now) const {
    const bool has_position = loop_.is_rate || loop_.kp != 0.0 || loop_.ki != 0.0;
    const bool has_integral = (loop_.is_rate ? loop_.kp : loop_.ki) != 0.0;
    double x = has_position ? now[0] : 0.0;
    double v = loop_.is_rate ? 0.0 : now[1];
    const double sum = has_integral ? now[2] + loop_.period * x : 0.0;
    const double u = loop_.is_rate ? -loop_.kd * x - loop_.kp * sum
                                   : -loop_.kp * x - loop_.kd * v - loop_.ki * sum;
    for (int s = 0; s < loop_.steps; ++s) {
      const int ago = s >= late_ ? 0 : (late_ - s + loop_.steps - 1) / loop_.steps;
      const double a = ago == 0 ? u : now[at(2 + ago)];
      if (loop_.is_rate) {
        x += step_ * a;
      } else if (loop_.exact) {
        x += step_ * (v + 0.5 * step_ * a);
        v += step_ * a;
      } else {
        v += step_ * a;
        x += step_ * v;
      }
    }
    Vector next = {has_position ? x : 0.0, v, sum};
    for (int k = 0; k < commands_; ++k) next.push_back(k == 0 ? u : now[at(2 + k)]);
    return next;
  }

  SampledLoop loop_;
  double step_;
  int late_;      // steps
  int commands_;  // periods that a late command spans
};

Vector times(const Columns& A, const Vector& v) {
  Vector out(v.size(), 0.0);
  for (std::size_t c = 0; c < v.size(); ++c) {
    for (std::size_t r = 0; r < v.size(); ++r) out[r] += A[c][r] * v[c];
  }
  return out;
}

double norm_of(const Columns& A) {
  double sum = 0.0;
  for (const Vector& column : A) {
    for (const double value : column) sum += value * value;
  }
  return std::sqrt(sum);
}

}  // namespace

// ‖A^n‖^(1/n) for n = 2^40, by squaring; A is kept at norm 1.
double growth(const SampledLoop& loop) {
  Columns A = PeriodMap(loop).columns();
  // In units of the period all entries are near 1, whatever the gains.
  const double units[] = {1.0, 1.0 / loop.period, loop.period};
  const auto unit = [&](std::size_t k) {
    return k < 3 ? units[k] : 1.0 / (loop.period * loop.period);
  };
  for (std::size_t c = 0; c < A.size(); ++c) {
    for (std::size_t r = 0; r < A.size(); ++r) A[c][r] *= unit(c) / unit(r);
  }
  double log_growth = 0.0;
  double n = 1.0;
  for (int k = 0; k < 40; ++k, n *= 2.0) {
    const double norm = norm_of(A);
    if (!(norm > 0.0)) return 0.0;
    log_growth += std::log(norm) / n;
    for (Vector& column : A) {
      for (double& value : column) value /= norm;
    }
    Columns squared;
    for (const Vector& column : A) squared.push_back(times(A, column));
    A = std::move(squared);
  }
  return std::exp(log_growth);
}

}  // namespace footfall::behaviors
