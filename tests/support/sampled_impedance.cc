// The map from tick to tick; see sampled_impedance.h.
#include "tests/support/sampled_impedance.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace footfall::tests {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// Places of the parts of the state: rows of a block that holds one state a column.
struct StateLayout {
  int n, m, rows;  // velocities, joints, task rows
  int queue;       // torques on their way, periods
  int history;     // of J q and J q̇, periods
  int q() const { return 0; }
  int v() const { return n; }
  int rotor() const { return 2 * n; }           // θ
  int rotor_rate() const { return 2 * n + m; }  // θ'
  int continuous() const { return 2 * n + 2 * m; }
  int motor_seen() const { return continuous(); }              // θ at the last step
  int spring_seen() const { return continuous() + m; }         // θ − q
  int motor_filtered() const { return continuous() + 2 * m; }  // their rates
  int spring_filtered() const { return continuous() + 3 * m; }
  int integral() const { return continuous() + 4 * m; }
  int torque(int ago) const { return integral() + rows + ago * m; }  // 0: of the last period
  int position(int ago) const { return torque(queue) + ago * rows; }
  int velocity(int ago) const { return position(history) + ago * rows; }
  int size() const { return velocity(history); }
};

void require_plain(const hal::TorqueLoopGains& gains) {
  const bool plain =
      gains.type == hal::TorqueLoopGains::Type::direct && gains.i == 0.0 && gains.observer == 0.0;
  if (!plain) throw std::invalid_argument("sampled impedance: a torque loop that is not modelled");
}

// exp(A) by its series, scaled to a norm below 1/2 and squared again: the rest after 18 terms is
// below 2^-18/18!, less than rounding. Eigen's own takes several times as long to compile.
MatrixXd exponential(const MatrixXd& A) {
  const double norm = A.cwiseAbs().rowwise().sum().maxCoeff();
  const int squarings = norm > 0.5 ? static_cast<int>(std::ceil(std::log2(2.0 * norm))) : 0;
  const MatrixXd scaled = A * std::ldexp(1.0, -squarings);
  MatrixXd sum = MatrixXd::Identity(A.rows(), A.cols()), term = sum;
  for (int k = 1; k <= 18; ++k) {
    term = MatrixXd(term * scaled) / k;
    sum += term;
  }
  for (int k = 0; k < squarings; ++k) sum = MatrixXd(sum * sum);
  return sum;
}

class TickMap {
 public:
  TickMap(const SampledPlant& plant, const SampledLaw& law)
      : plant_(plant), law_(law), at_(layout(plant, law)) {
    for (const hal::DriveJoint& joint : plant.drive.joints) require_plain(joint.gains);
    discretize();
  }

  MatrixXd matrix() const {
    MatrixXd x = MatrixXd::Identity(at_.size(), at_.size());
    const MatrixXd torque = control(x);
    for (int step = 0; step < plant_.steps_per_period; ++step) {
      const int ago = periods_ago(step);
      advance(x, ago == 0 ? torque : MatrixXd(x.middleRows(at_.torque(ago - 1), at_.m)));
    }
    for (int k = at_.queue - 1; k >= 0; --k) {
      x.middleRows(at_.torque(k), at_.m) =
          k == 0 ? torque : MatrixXd(x.middleRows(at_.torque(k - 1), at_.m));
    }
    return x;
  }

 private:
  static StateLayout layout(const SampledPlant& plant, const SampledLaw& law) {
    const int n = static_cast<int>(plant.inertia.rows());
    const int m = static_cast<int>(plant.drive.joints.size());
    const int steps = plant.steps_per_period;
    const int queue = (plant.drive.command_delay + steps - 1) / steps;
    return {n, m, static_cast<int>(law.rows.rows()), queue,
            std::max(law.position_delay, law.velocity_delay)};
  }

  // Of the torque that the drive has in a step of this period: 0 is this period's.
  int periods_ago(int step) const {
    const int late = plant_.drive.command_delay - step;
    return late <= 0 ? 0 : (late + plant_.steps_per_period - 1) / plant_.steps_per_period;
  }

  // M q̈ = −K q − C q̇ + Sᵀ τ_s,  J θ'' = u − b θ' − τ_s,  τ_s = k (θ − S q): exactly over a step of
  // the drives, u constant.
  void discretize() {
    const int n = at_.n, m = at_.m, size = at_.continuous();
    MatrixXd pick = MatrixXd::Zero(m, n);
    pick.rightCols(m).setIdentity();
    VectorXd spring(m), rotor(m), viscous(m);
    for (int j = 0; j < m; ++j) {
      const auto& actuator = plant_.drive.joints[static_cast<std::size_t>(j)].actuator;
      spring[j] = actuator.spring;
      rotor[j] = actuator.rotor;
      viscous[j] = actuator.viscous;
    }
    const Eigen::LDLT<MatrixXd> mass(plant_.inertia);
    const MatrixXd sprung = pick.transpose() * spring.asDiagonal();
    const VectorXd per_rotor = rotor.cwiseInverse();
    MatrixXd a = MatrixXd::Zero(size + m, size + m);
    a.block(at_.q(), at_.v(), n, n).setIdentity();
    a.block(at_.v(), at_.q(), n, n) = mass.solve(-plant_.stiffness - sprung * pick);
    a.block(at_.v(), at_.v(), n, n) = mass.solve(-plant_.damping);
    a.block(at_.v(), at_.rotor(), n, m) = mass.solve(sprung);
    a.block(at_.rotor(), at_.rotor_rate(), m, m).setIdentity();
    a.block(at_.rotor_rate(), at_.q(), m, n) = per_rotor.asDiagonal() * sprung.transpose();
    a.block(at_.rotor_rate(), at_.rotor(), m, m) =
        -MatrixXd(per_rotor.cwiseProduct(spring).asDiagonal());
    a.block(at_.rotor_rate(), at_.rotor_rate(), m, m) =
        -MatrixXd(per_rotor.cwiseProduct(viscous).asDiagonal());
    a.block(at_.rotor_rate(), size, m, m) = per_rotor.asDiagonal();
    const MatrixXd whole = exponential(a * plant_.drive.step);
    transition_ = whole.topLeftCorner(size, size);
    input_ = whole.topRightCorner(size, m);
  }

  // u = F τ_d + P (τ_d − k_nominal (θ − q)) − D r, r the filtered rate that the loop damps.
  void advance(MatrixXd& x, const MatrixXd& reference) const {
    const int m = at_.m;
    const double h = plant_.drive.step;
    const hal::RateFilters& filters = plant_.drive.filters;
    const MatrixXd motor = x.middleRows(at_.rotor(), m);
    const MatrixXd spring = motor - x.middleRows(at_.q() + at_.n - m, m);
    const MatrixXd motor_rate = x.middleRows(at_.rotor_rate(), m);
    const MatrixXd spring_rate = motor_rate - x.middleRows(at_.v() + at_.n - m, m);
    const auto follow = [&](double cutoff, int filtered, int seen, const MatrixXd& now,
                            const MatrixXd& exact) {
      const double share = hal::filter_share(cutoff, h);  // 0: the exact rate
      const MatrixXd slope = share > 0.0 ? MatrixXd((now - x.middleRows(seen, m)) / h) : exact;
      x.middleRows(filtered, m) +=
          (share > 0.0 ? share : 1.0) * (slope - x.middleRows(filtered, m));
      x.middleRows(seen, m) = now;
    };
    follow(filters.motor, at_.motor_filtered(), at_.motor_seen(), motor, motor_rate);
    follow(filters.spring, at_.spring_filtered(), at_.spring_seen(), spring, spring_rate);
    MatrixXd u(m, x.cols());
    for (int j = 0; j < m; ++j) {
      const hal::DriveJoint& joint = plant_.drive.joints[static_cast<std::size_t>(j)];
      const hal::TorqueLoopGains& g = joint.gains;
      const bool motor_damped = g.damps == hal::TorqueLoopGains::Damping::motor;
      const int rate = (motor_damped ? at_.motor_filtered() : at_.spring_filtered()) + j;
      u.row(j) = (g.forward + g.p) * reference.row(j) - g.p * joint.nominal_spring * spring.row(j) -
                 g.damping * x.row(rate);
    }
    const int size = at_.continuous();
    x.topRows(size) = transition_ * x.topRows(size) + input_ * u;
  }

  // The law's torque; also moves integral and histories on.
  MatrixXd control(MatrixXd& x) const {
    const int rows = at_.rows;
    const double period = plant_.drive.step * plant_.steps_per_period;
    const auto late = [&](int delay, int (StateLayout::*past)(int) const, const MatrixXd& now) {
      return delay == 0 ? now : MatrixXd(x.middleRows((at_.*past)(delay - 1), rows));
    };
    const MatrixXd position = law_.rows * x.middleRows(at_.q(), at_.n);
    const MatrixXd velocity = law_.rows * x.middleRows(at_.v(), at_.n);
    const MatrixXd error = -late(law_.position_delay, &StateLayout::position, position);
    const MatrixXd rate = late(law_.velocity_delay, &StateLayout::velocity, velocity);
    x.middleRows(at_.integral(), rows) += period * error;
    const MatrixXd u = law_.kp.asDiagonal() * error - law_.kd.asDiagonal() * rate +
                       law_.ki.asDiagonal() * x.middleRows(at_.integral(), rows);
    for (int k = at_.history - 1; k >= 0; --k) {
      x.middleRows(at_.position(k), rows) =
          k == 0 ? position : MatrixXd(x.middleRows(at_.position(k - 1), rows));
      x.middleRows(at_.velocity(k), rows) =
          k == 0 ? velocity : MatrixXd(x.middleRows(at_.velocity(k - 1), rows));
    }
    // An integral without gain is no part of the loop.
    for (int r = 0; r < rows; ++r) {
      if (law_.ki[r] == 0.0) x.row(at_.integral() + r).setZero();
    }
    return law_.torque * u;
  }

  const SampledPlant& plant_;
  const SampledLaw& law_;
  StateLayout at_;
  MatrixXd transition_, input_;  // of the continuous part, over a step of the drives
};

}  // namespace

double sampled_growth(const SampledPlant& plant, const SampledLaw& law) {
  const MatrixXd map = TickMap(plant, law).matrix();
  if (!map.allFinite()) return HUGE_VAL;
  return Eigen::EigenSolver<MatrixXd>(map, false).eigenvalues().cwiseAbs().maxCoeff();
}

double largest_stable_kp(const SampledPlant& plant, SampledLaw law, int row, double most) {
  constexpr double kRatio = 1.05, kLeast = 1e-4, kRounding = 1e-9, kEnough = 1e-3;
  const auto is_stable = [&](double kp) {
    law.kp[row] = kp;
    return sampled_growth(plant, law) <= 1.0 + kRounding;
  };
  double good = 0.0, bad = kLeast * most;
  while (bad <= most && is_stable(bad)) {
    good = bad;
    bad *= kRatio;
  }
  if (bad > most) return most;
  if (good == 0.0) return 0.0;
  while (bad > (1.0 + kEnough) * good) {
    const double middle = std::sqrt(good * bad);
    (is_stable(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace footfall::tests
