// Sample-to-sample map of a torque loop; see sampled_torque_loop.h.
#include "behaviors/check/actuators/sampled_torque_loop.h"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

namespace footfall::behaviors {
namespace {

// Spring torque k δ and √(J k) θ', both in N m so that the map is well scaled; ∫e dt and the
// integral of the rate's error, each times its gain; of the filters the δ before and both rates,
// scaled likewise; the observer's momentum times √(k/J).
constexpr int kStates = TorqueLoopMap::kStates;
using LoopState = Eigen::Matrix<double, kStates, 1>;

class SampleMap {
 public:
  SampleMap(const hal::TorqueLoopGains& gains, const hal::SeriesElasticParameters& actuator,
            double period, const hal::RateFilters& filters)
      : gains_(gains),
        spring_(actuator.spring),
        impedance_(std::sqrt(actuator.spring * actuator.rotor)),
        period_(period),
        inertia_(actuator.rotor),
        motor_share_(hal::filter_share(filters.motor, period)),
        spring_share_(hal::filter_share(filters.spring, period)),
        observer_(kTurn * gains.observer),
        rotor_({.spring = actuator.spring, .rotor = actuator.rotor, .viscous = actuator.viscous},
               period) {}

  // The law of hal/actuators/torque_loop.h; q' is 0, so that both rates are the same but for their
  // filters.
  LoopState after(const LoopState& now, double reference = 0.0) {
    const double error = reference - now[0];
    const double rate = seen_rate(now, motor_share_, now[5]);
    const double spring_rate = seen_rate(now, spring_share_, now[6]);
    const double outer = gains_.p * error + now[2];
    const bool cascade = gains_.type == hal::TorqueLoopGains::Type::cascade;
    const double slip = outer - rate;
    const double momentum = now[7] * inertia_ / impedance_;
    const double found = cascade ? 0.0 : observer_ * (inertia_ * rate - momentum);
    const bool of_motor = gains_.damps == hal::TorqueLoopGains::Damping::motor;
    const double damped = gains_.damping * (of_motor ? rate : spring_rate);
    const double torque = cascade ? gains_.velocity_p * slip + now[3]
                                  : gains_.forward * reference + outer - damped - found;
    rotor_.set_state({now[0] / spring_, now[1] / impedance_});
    rotor_.advance(torque, 0.0);
    const hal::SeriesElasticState& moved = rotor_.state();
    LoopState next;
    next << spring_ * moved.deflection, impedance_ * moved.rate,
        now[2] + gains_.i * error * period_,
        cascade ? now[3] + gains_.velocity_i * slip * period_ : 0.0, now[0], impedance_ * rate,
        impedance_ * spring_rate,
        (momentum + (torque - now[0] + found) * period_) * impedance_ / inertia_;
    return next;
  }
  // Whether a state is part of the loop: an integral without gain stays as it is.
  bool has(int state) const {
    const bool cascade = gains_.type == hal::TorqueLoopGains::Type::cascade;
    if (state == 2) return gains_.i != 0.0;
    if (state == 3) return cascade && gains_.velocity_i != 0.0;
    if (state == 4) return motor_share_ > 0.0 || spring_share_ > 0.0;
    if (state == 5) return motor_share_ > 0.0;
    if (state == 6) return spring_share_ > 0.0;
    return state < 2 || (!cascade && observer_ > 0.0);
  }

 private:
  static constexpr double kTurn = 2.0 * std::numbers::pi;

  // By differences of the angle through the drive's filter, or θ' itself.
  double seen_rate(const LoopState& now, double share, double scaled_before) const {
    if (share == 0.0) return now[1] / impedance_;
    const double before = scaled_before / impedance_;
    return before + share * ((now[0] - now[4]) / (spring_ * period_) - before);
  }

  hal::TorqueLoopGains gains_;
  double spring_, impedance_, period_, inertia_;
  double motor_share_, spring_share_;  // of the filters; 0: the rate is exact
  double observer_;                    // rad/s
  hal::SeriesElasticActuator rotor_;
};

}  // namespace

TorqueLoopMap torque_loop_map(const hal::TorqueLoopGains& gains,
                              const hal::SeriesElasticParameters& actuator, double period,
                              const hal::RateFilters& filters) {
  SampleMap map(gains, actuator, period, filters);
  TorqueLoopMap out;
  for (int k = 0; k < kStates; ++k) {
    if (map.has(k)) out.A.col(k) = map.after(LoopState::Unit(k));
  }
  out.B = map.after(LoopState::Zero(), 1.0);
  return out;
}

double torque_loop_growth(const hal::TorqueLoopGains& gains,
                          const hal::SeriesElasticParameters& actuator, double period,
                          const hal::RateFilters& filters) {
  using Square = Eigen::Matrix<double, kStates, kStates>;
  const Square whole = torque_loop_map(gains, actuator, period, filters).A;
  if (!whole.allFinite()) return HUGE_VAL;
  return Eigen::EigenSolver<Square>(whole, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace footfall::behaviors
