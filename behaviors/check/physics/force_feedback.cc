// Feedback of internal forces that the loop cannot bear; see parts.h.
//
// The torque measured at a tick is what acted in the physics step before it. With a delay of d of
// the S steps of a period it is the command n = ceil((d + 1) / S) = 1 + floor(d / S) periods ago,
// and what is fed back, F = F_ref + K_F (F_ref - F_measured) ([Kim16] eqs. (4)-(5) with E7), has
// gone through a low-pass: sampled_loop.h. A series-elastic actuator's own lag comes on top. With
// the joint at rest (internal forces move nothing) a direct torque loop of the gains p, i, forward
// and d answers a commanded torque with
//   G(s) = k (forward + p + i/s) / (J s^2 + d s + k (1 + p + i/s))
// and by Nyquist an error grows from K_F = 1/|G L| on, at the frequency at which G, low-pass and
// delay turn by 180 deg: the least of all joints. Of other loops it is known that they are stable
// below 1 alone, whatever the low-pass.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

#include "behaviors/check/physics/parts.h"
#include "behaviors/check/physics/sampled_loop.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

using core::Severity;

using Complex = std::complex<double>;

// The least K_F, for one joint, from which an error grows; `delay` in s, bandwidth in Hz.
double elastic_limit(const model::JointDescription& joint, const hal::TorqueLoopGains& gains,
                     double bandwidth, double delay) {
  const double turn = 2.0 * std::numbers::pi;
  double phase = 0.0, last = 0.0;                           // unwrapped
  constexpr double kFrom = 0.1, kTo = 1e4, kRatio = 1.002;  // rad/s
  for (double w = kFrom; w < kTo; w *= kRatio) {
    const Complex s(0.0, w), p = gains.p + gains.i / s;
    const Complex answer = joint.spring * (gains.forward + p) /
                           (joint.rotor * s * s + gains.damping * s + joint.spring * (1.0 + p));
    const Complex low_pass = bandwidth > 0.0 ? 1.0 / (1.0 + s / (turn * bandwidth)) : 1.0;
    const Complex loop = answer * low_pass;
    const double now = std::arg(loop);
    phase += std::remainder(now - last, turn);
    last = now;
    if (phase - w * delay <= -std::numbers::pi) return 1.0 / std::abs(loop);
  }
  return std::numeric_limits<double>::infinity();
}

// Of all joints, or 1 where the answer of their torque loops is not known.
double elastic_limit(const Behavior& behavior, double bandwidth, double delay) {
  const model::RobotDescription& robot = behavior.robot;
  if (robot.drives.torque_loop.empty() || !behavior.torque_loops.empty()) return 1.0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const hal::TorqueLoopGains& gains = robot.drives.torque_loop[j];
    if (gains.type != hal::TorqueLoopGains::Type::direct || gains.observer > 0.0) return 1.0;
    least = std::min(least, elastic_limit(robot.joints[j], gains, bandwidth, delay));
  }
  return std::max(1.0, least);
}

class FeedbackCheck {
 public:
  explicit FeedbackCheck(PhysicsContext& context) : context_(context), values_(context.behavior) {}

  void run() {
    for (const InternalSpec& spec : b().internals) judge(spec);
    context_.findings.settle(1);
  }

 private:
  const Behavior& b() const { return context_.behavior; }

  void judge(const InternalSpec& spec) {
    if (spec.feedback < 0) return;
    Dependence needs = dependence_of(b(), spec.feedback);
    if (spec.bandwidth >= 0) {
      const Dependence more = dependence_of(b(), spec.bandwidth);
      if (!more.fixed()) return;
      needs.parameters.insert(needs.parameters.end(), more.parameters.begin(),
                              more.parameters.end());
    }
    if (!needs.fixed()) return;
    if (report(spec, values_, true, {})) return;
    for (const int parameter : needs.parameters) {
      const ParameterInfo& info = b().parameters[at(parameter)];
      if (!info.live || !info.has_range()) continue;
      for (const double end : {info.min, info.max}) {
        StaticValues edited(b());
        for (int i = 0; i < info.size; ++i) edited.parameters()[at(info.slot + i)] = end;
        if (report(spec, edited, false,
                   fmt::format(" at the end of the range of '{}'", info.name))) {
          break;
        }
      }
    }
  }

  // `now`: the values with which the run begins, else an end of a range.
  bool report(const InternalSpec& spec, const StaticValues& values, bool now,
              const std::string& where) {
    const auto feedback = values.of(spec.feedback);
    const auto bandwidth =
        spec.bandwidth >= 0 ? values.of(spec.bandwidth) : std::optional(kInternalBandwidth);
    if (!feedback || !bandwidth) return false;
    const int steps = context_.world.steps_per_tick;
    const auto late_steps = std::lround(context_.world.command_delay * steps / b().period());
    const int periods = 1 + static_cast<int>(late_steps / steps);
    const bool elastic = context_.world.series_elastic;
    // Half a period: torques are held as commanded.
    const double limit = elastic ? elastic_limit(b(), *bandwidth, (periods + 0.5) * b().period())
                                 : force_feedback_limit(*bandwidth, b().period(), periods);
    const bool negative = *feedback <= -1.0;  // z = 1 is a root at -1, whatever low-pass and delay
    const bool unstable = negative || *feedback >= limit;
    if (!unstable && (limit == 1.0 || !now || *feedback <= 0.5 * limit)) return false;
    const std::string& name = b().internal_instances[at(spec.instance)];
    const std::string loop = fmt::format(
        "the measured force is that of a command {:.3g} ms before, through a low-pass of {:g} Hz{}",
        1e3 * periods * b().period(), *bandwidth,
        elastic ? ", and of a series-elastic actuator" : "");
    if (unstable) {
      context_.findings.add(now ? Severity::error : Severity::warning, spec.mark,
                            "unstable-feedback", where,
                            fmt::format("internal force '{}' is unstable with feedback {:g}{}: {}; "
                                        "{} {:.3g} an error dies out",
                                        name, *feedback, where, loop, negative ? "above" : "below",
                                        negative ? -1.0 : limit));
    } else {
      context_.findings.add(
          Severity::warning, spec.mark, "near-unstable-feedback", where,
          fmt::format("internal force '{}' is fed back with {:g}, more than half of what is "
                      "stable: {}; from {:.3g} on an error grows",
                      name, *feedback, loop, limit));
    }
    return true;
  }

  PhysicsContext& context_;
  StaticValues values_;
};

}  // namespace

void check_force_feedback(PhysicsContext& context) { FeedbackCheck(context).run(); }

}  // namespace footfall::behaviors
