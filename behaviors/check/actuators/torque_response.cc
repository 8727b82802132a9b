// Lifts the map of a drive's step to a servo's period; see torque_response.h.
#include "behaviors/check/actuators/torque_response.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <stdexcept>

namespace footfall::behaviors {
namespace {

// x after n steps: A^n x + gain u, u held.
struct Advance {
  Eigen::MatrixXd power;
  Eigen::VectorXd gain;
};

Advance advance(const Eigen::MatrixXd& A, const Eigen::VectorXd& B, int steps) {
  Advance out = {Eigen::MatrixXd::Identity(A.rows(), A.rows()), Eigen::VectorXd::Zero(A.rows())};
  for (int k = 0; k < steps; ++k) {
    out.gain = A * out.gain + B;
    out.power = A * out.power;
  }
  return out;
}

// Of a map the states on which anything depends; the first is always one of them.
std::vector<int> states_of(const TorqueLoopMap& loop) {
  std::vector<int> states;
  for (int k = 0; k < TorqueLoopMap::kStates; ++k) {
    if (k == 0 || !loop.A.col(k).isZero(0.0)) states.push_back(k);
  }
  return states;
}

}  // namespace

TorqueResponse::TorqueResponse(const TorqueLoopMap& loop, const DriveTiming& timing) {
  const int S = timing.steps;
  if (S < 1 || timing.command_delay < 0 || timing.measurement_delay < 0) {
    throw std::invalid_argument("torque response: steps and delays cannot be negative");
  }
  const std::vector<int> states = states_of(loop);
  const Eigen::MatrixXd A = loop.A(states, states);
  const Eigen::VectorXd B = loop.B(states);
  // In the first r steps of a period the loop still has the command before.
  const int r = timing.command_delay % S;
  late_commands_ = timing.command_delay / S;
  const Advance before = advance(A, B, r), now = advance(A, B, S - r);
  A_ = now.power * before.power;
  B_before_ = now.power * before.gain;
  B_now_ = now.gain;
  poles_.resize(states.size());
  Eigen::VectorXcd::Map(poles_.data(), A_.rows()) =
      Eigen::EigenSolver<Eigen::MatrixXd>(A_, false).eigenvalues();
  // What is read is t steps from the beginning of the period e periods before.
  late_readings_ = (timing.measurement_delay + S - 1) / S;
  const int t = late_readings_ * S - timing.measurement_delay;
  const Advance old = advance(A, B, std::min(t, r)), young = advance(A, B, std::max(0, t - r));
  C_ = (young.power * old.power).row(0).transpose();
  D_before_ = young.power.row(0).dot(old.gain);
  D_now_ = young.gain[0];
}

std::complex<double> TorqueResponse::at(double angle) const {
  using Complex = std::complex<double>;
  using Vector = Eigen::Matrix<Complex, Eigen::Dynamic, 1, 0, kMost, 1>;
  using Matrix = Eigen::Matrix<Complex, Eigen::Dynamic, Eigen::Dynamic, 0, kMost, kMost>;
  const Complex late = std::polar(1.0, -angle);
  const Vector input = B_now_.cast<Complex>() + late * B_before_.cast<Complex>();
  Matrix resolvent = -A_.cast<Complex>();
  resolvent.diagonal().array() += std::polar(1.0, angle);
  const Vector state = resolvent.partialPivLu().solve(input);
  const Complex read = C_.cast<Complex>().dot(state) + D_now_ + late * D_before_;
  return std::polar(1.0, -angle * (late_commands_ + late_readings_)) * read;
}

bool TorqueResponse::is_stable() const {
  return std::ranges::all_of(poles_, [](const auto& pole) { return std::abs(pole) < 1.0; });
}

}  // namespace footfall::behaviors
