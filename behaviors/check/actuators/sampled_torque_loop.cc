// Sample-to-sample map of a torque loop; see sampled_torque_loop.h.
#include "behaviors/check/actuators/sampled_torque_loop.h"

#include <Eigen/Eigenvalues>
#include <cmath>

namespace footfall::behaviors {
namespace {

// Spring torque k δ and √(J k) θ', both in N m so that the map is well scaled; ∫e dt and the
// integral of the rate's error, each times its gain.
using LoopState = Eigen::Vector4d;

class SampleMap {
 public:
  SampleMap(const hal::TorqueLoopGains& gains, const hal::SeriesElasticParameters& actuator,
            double period)
      : gains_(gains),
        spring_(actuator.spring),
        impedance_(std::sqrt(actuator.spring * actuator.rotor)),
        period_(period),
        rotor_({.spring = actuator.spring, .rotor = actuator.rotor, .viscous = actuator.viscous},
               period) {}

  // The law of hal/actuators/torque_loop.h for a reference of 0; q' is 0, so that both kinds of
  // damping are the same.
  LoopState after(const LoopState& now) {
    const double error = -now[0], rate = now[1] / impedance_;
    const double outer = gains_.p * error + now[2];
    const bool cascade = gains_.type == hal::TorqueLoopGains::Type::cascade;
    const double slip = outer - rate;
    const double torque =
        cascade ? gains_.velocity_p * slip + now[3] : outer - gains_.damping * rate;
    rotor_.set_state({now[0] / spring_, rate});
    rotor_.advance(torque, 0.0);
    const hal::SeriesElasticState& moved = rotor_.state();
    return {spring_ * moved.deflection, impedance_ * moved.rate,
            now[2] + gains_.i * error * period_,
            cascade ? now[3] + gains_.velocity_i * slip * period_ : 0.0};
  }

 private:
  hal::TorqueLoopGains gains_;
  double spring_, impedance_, period_;
  hal::SeriesElasticActuator rotor_;
};

}  // namespace

double torque_loop_growth(const hal::TorqueLoopGains& gains,
                          const hal::SeriesElasticParameters& actuator, double period) {
  SampleMap map(gains, actuator, period);
  // An integral without gain stays as it is: no part of the loop.
  Eigen::Matrix4d whole = Eigen::Matrix4d::Zero();
  for (int k = 0; k < 4; ++k) {
    if (k == 2 && gains.i == 0.0) continue;
    if (k == 3 && gains.velocity_i == 0.0) continue;
    whole.col(k) = map.after(LoopState::Unit(k));
  }
  if (!whole.allFinite()) return HUGE_VAL;
  return Eigen::EigenSolver<Eigen::Matrix4d>(whole, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace footfall::behaviors
