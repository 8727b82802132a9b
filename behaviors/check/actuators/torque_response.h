// What a servo sees of an actuator whose output is locked: from the torque references that it
// writes once a period to the torques that it reads once a period, as a frequency response. Exact
// for the linear range: the drive's steps, both delays, and the loop that runs at the drive's rate.
// Pure functions. Load time only.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "behaviors/check/actuators/sampled_torque_loop.h"

namespace footfall::behaviors {

// All in steps of the drive.
struct DriveTiming {
  int steps = 1;          // a servo's period
  int command_delay = 0;  // from the servo's write to the torque loop
  // From the spring to the servo's read. The last torque that a loop has seen when the servo reads
  // is that of the beginning of its last step: 1 on top of what the line adds.
  int measurement_delay = 1;
};

class TorqueResponse {
 public:
  // Throws std::invalid_argument for less than a step a period or delays below 0.
  TorqueResponse(const TorqueLoopMap& loop, const DriveTiming& timing);

  // G(exp(i angle)): torque read over reference written, of the same tick. Angle in rad a period.
  std::complex<double> at(double angle) const;
  // Eigenvalues of the loop over a period; all within the unit circle: it is stable.
  const std::vector<std::complex<double>>& poles() const { return poles_; }
  bool is_stable() const;

 private:
  // Over a period x' = A x + B_now u_k-q + B_before u_k-q-1; read: e periods before,
  // y = C x + D_now u_k-q + D_before u_k-q-1.
  static constexpr int kMost = TorqueLoopMap::kStates;
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMost, 1>;
  Square A_;
  Column B_now_, B_before_, C_;
  double D_now_ = 0.0, D_before_ = 0.0;
  int late_commands_ = 0, late_readings_ = 0;  // q, e
  std::vector<std::complex<double>> poles_;
};

}  // namespace footfall::behaviors
