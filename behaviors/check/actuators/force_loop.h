// The loop that feedback of a measured internal force closes around the actuators:
//
//   F = F_ref + K_F (F_ref - y) + K_I ∫ (F_ref - y) dt           ([Kim16] eqs. (4)-(5) with E7)
//   y  first-order low-pass of the tension under the torques measured
//
// An internal force moves no joint: each actuator's output is locked, and the tension measured is
// Σ_j w_j τ_j/d_j, d_j the torque of joint j per tension, w_j its share of the tension. With G_j
// from reference to measured torque an error dies out exactly if all roots of
//   1 + (K_F + K_I T z/(z - 1)) H(z) = 0,   H(z) = (1 - a) z/(z - a) Σ_j w_j G_j(z),
//   a = exp(-2 pi B T),                      ideal torque, n periods late: G = z^-n
// are within the unit circle. They are counted by the windings of the left side along it
// (Nyquist), so that the actuators' order does not matter. Pure functions. Load time only.
#pragma once

#include <complex>
#include <functional>
#include <vector>

#include "behaviors/check/actuators/torque_response.h"

namespace footfall::behaviors {

// The actuators of all joints that bear the tension, tabulated: from the reference of a tick to the
// torque read in the same tick, on the unit circle.
class TensionPlant {
 public:
  struct Actuator {
    std::function<std::complex<double>(double angle)> response;  // rad a period
    std::vector<std::complex<double>> corners;                   // poles near which it changes fast
  };
  // Each must be stable.
  explicit TensionPlant(std::vector<Actuator> actuators);
  // Torques as commanded, `periods` before; one share, 1.
  static TensionPlant ideal(int periods);
  static TensionPlant elastic(const std::vector<TorqueResponse>& joints);

  // 0 to pi, close where something changes fast.
  const std::vector<double>& angles() const { return angles_; }
  // Σ_j w_j G_j at angles(), and at any angle.
  std::vector<std::complex<double>> table(const std::vector<double>& shares) const;
  std::complex<double> at(const std::vector<double>& shares, double angle) const;

 private:
  std::vector<Actuator> actuators_;
  std::vector<double> angles_;
  std::vector<std::vector<std::complex<double>>> tables_;  // by actuator
};

struct FeedbackGains {
  double proportional = 0.0;  // K_F
  double integral = 0.0;      // K_I, 1/s, 0 or more
};

class ForceLoop {
 public:
  // The plant must outlive the loop; a share w_j for each of its actuators. `bandwidth`: Hz, 0: no
  // low-pass; `period`: s.
  ForceLoop(const TensionPlant& plant, std::vector<double> shares, double bandwidth, double period);

  // Whether an error dies out.
  bool is_stable(const FeedbackGains& gains) const;
  // Where K_F, with this K_I, is no longer stable: above the one given if that is stable, else the
  // end of what is stable below it. 0: nothing from 0 on is; infinite: without end.
  double limit(const FeedbackGains& gains) const;

 private:
  std::complex<double> low_pass(double angle) const;
  std::complex<double> bound(double angle, double integral) const;
  std::vector<double> bounds(double integral) const;

  const TensionPlant& plant_;
  std::vector<double> shares_;
  double new_share_ = 1.0;  // of a new value, in the low-pass
  double period_;
  std::vector<std::complex<double>> response_;  // H at the plant's angles
};

}  // namespace footfall::behaviors
