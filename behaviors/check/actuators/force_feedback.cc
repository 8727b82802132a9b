// Feedback of internal forces that the loop cannot bear; see physics/parts.h.
//
// With ideal actuators the torque measured at a tick is what acted in the physics step before it.
// With a delay of d of the S steps of a period it is the command n = ceil((d + 1) / S) =
// 1 + floor(d / S) periods ago. Series-elastic actuators follow with their torque loops, in the
// posture and with the gains in which the force bears least (force_loop.h); springs and rotors are
// those of the robot's file. Of several forces each is judged as if the others were not fed back.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "behaviors/check/actuators/force_loop.h"
#include "behaviors/check/physics/configurations.h"
#include "behaviors/check/physics/parts.h"
#include "behaviors/compiled/torque_loops.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

using core::Severity;

// Values of a force's feedback.
struct ForceFeedback {
  FeedbackGains gains;
  double bandwidth = 0.0;  // Hz
};
// What the loop bears of them: the least over configurations and postures.
struct ForceMargin {
  bool stable = true;
  double limit = HUGE_VAL;  // of the proportional gain
};

class FeedbackCheck {
 public:
  explicit FeedbackCheck(PhysicsContext& context)
      : context_(context), values_(context.behavior), elastic_(has_actuators()) {}

  void run() {
    for (std::size_t k = 0; k < b().internals.size(); ++k) judge(static_cast<int>(k));
    context_.findings.settle(1);
  }

 private:
  const Behavior& b() const { return context_.behavior; }
  const InternalSpec& spec_of(int index) const { return b().internals[at(index)]; }

  // A robot without springs is refused in such a world (sim/world/actuators.h).
  bool has_actuators() const {
    const auto sprung = [](const auto& joint) { return joint.spring > 0.0 && joint.rotor > 0.0; };
    return context_.world.series_elastic && std::ranges::all_of(b().robot.joints, sprung);
  }

  void judge(int index) {
    const InternalSpec& spec = spec_of(index);
    if (spec.feedback < 0 && spec.integral < 0) return;
    std::vector<int> parameters;
    for (const int expression : {spec.feedback, spec.integral, spec.bandwidth}) {
      if (expression < 0) continue;
      const Dependence needs = dependence_of(b(), expression);
      if (!needs.fixed()) {
        context_.findings.add(
            Severity::error, spec.mark, "unjudged-feedback", {},
            fmt::format(
                "feedback, integral or bandwidth of internal force '{}' changes with time or "
                "measurements: whether it is stable cannot be told; give each state its "
                "own value, or a parameter",
                b().internal_instances[at(spec.instance)]));
        return;
      }
      parameters.insert(parameters.end(), needs.parameters.begin(), needs.parameters.end());
    }
    if (report(index, values_, true, {})) return;
    for (const int parameter : parameters) {
      const ParameterInfo& info = b().parameters[at(parameter)];
      if (!info.live || !info.has_range()) continue;
      for (const double end : {info.min, info.max}) {
        StaticValues edited(b());
        for (int i = 0; i < info.size; ++i) edited.parameters()[at(info.slot + i)] = end;
        if (report(index, edited, false,
                   fmt::format(" at the end of the range of '{}'", info.name))) {
          break;
        }
      }
    }
  }

  std::optional<ForceFeedback> feedback_of(const InternalSpec& spec,
                                           const StaticValues& values) const {
    const auto value_or = [&](int expression, double usual) {
      return expression >= 0 ? values.of(expression) : std::optional(usual);
    };
    const auto proportional = value_or(spec.feedback, 0.0);
    const auto integral = value_or(spec.integral, 0.0);
    const auto bandwidth = value_or(spec.bandwidth, kInternalBandwidth);
    if (!proportional || !integral || !bandwidth) return std::nullopt;
    return ForceFeedback{{*proportional, *integral}, *bandwidth};
  }

  // `now`: the values with which the run begins, else an end of a range.
  bool report(int index, const StaticValues& values, bool now, const std::string& where) {
    const InternalSpec& spec = spec_of(index);
    const auto feedback = feedback_of(spec, values);
    if (!feedback) return false;
    const double gain = feedback->gains.proportional;
    if (gain == 0.0 && feedback->gains.integral == 0.0) return false;
    const bool negative = gain <= -1.0;  // with ideal torques z = 1 is a root at -1
    const ForceMargin margin = negative ? ForceMargin{false, -1.0} : margin_of(index, *feedback);
    if (margin.stable && (!now || gain <= 0.5 * margin.limit)) return false;
    const std::string& name = b().internal_instances[at(spec.instance)];
    const std::string loop = loop_text(feedback->bandwidth);
    if (!margin.stable) {
      const std::string bound =
          margin.limit == 0.0
              ? fmt::format("with an integral of {:g} 1/s an error dies out with no feedback",
                            feedback->gains.integral)
              : fmt::format("{} {:.3g} an error dies out", negative ? "above" : "below",
                            margin.limit);
      context_.findings.add(now ? Severity::error : Severity::warning, spec.mark,
                            "unstable-feedback", where,
                            fmt::format("internal force '{}' is unstable with feedback {:g}{}: {}; "
                                        "{}",
                                        name, gain, where, loop, bound));
    } else {
      context_.findings.add(
          Severity::warning, spec.mark, "near-unstable-feedback", where,
          fmt::format("internal force '{}' is fed back with {:g}, more than half of what is "
                      "stable: {}; from {:.3g} on an error grows",
                      name, gain, loop, margin.limit));
    }
    return true;
  }

  // `the measured force is that of a command 0.667 ms before, through a low-pass of 20 Hz`.
  std::string loop_text(double bandwidth) const {
    const std::string low_pass = fmt::format("through a low-pass of {:g} Hz", bandwidth);
    if (!elastic_) {
      return fmt::format("the measured force is that of a command {:.3g} ms before, {}",
                         1e3 * ideal_periods() * b().period(), low_pass);
    }
    const DriveTiming timing = drive_timing();
    const double late = (timing.command_delay + timing.measurement_delay) / b().robot.drives.rate;
    return fmt::format(
        "the measured force is that of the series-elastic actuators, {:.3g} ms late beside their "
        "own lag, {}",
        1e3 * late, low_pass);
  }

  int ideal_periods() const {
    const int steps = context_.world.steps_per_tick;
    const auto late = std::lround(context_.world.command_delay * steps / b().period());
    return 1 + static_cast<int>(late / steps);
  }

  DriveTiming drive_timing() const {
    const double rate = b().robot.drives.rate;
    const auto steps = [rate](double time) { return static_cast<int>(std::lround(time * rate)); };
    return {std::max(1, steps(b().period())), steps(context_.world.command_delay),
            1 + steps(context_.world.measurement_delay)};
  }

  ForceMargin margin_of(int index, const ForceFeedback& feedback) {
    ForceMargin least;
    const auto consider = [&](const TensionPlant& plant, const std::vector<double>& shares) {
      const ForceLoop loop(plant, shares, feedback.bandwidth, b().period());
      const bool stable = loop.is_stable(feedback.gains);
      const double limit = loop.limit(feedback.gains);
      if (stable == least.stable ? limit >= least.limit : stable) return;
      least = {stable, limit};
    };
    if (!elastic_) {
      consider(TensionPlant::ideal(ideal_periods()), {1.0});
      return least;
    }
    for (const auto& [control, state] : controlling_states(b())) {
      const Range& internals = b().controls[at(control)].internals;
      if (index < internals.first || index >= internals.end()) continue;
      const TensionPlant* const plant = plant_of(control);
      if (plant == nullptr) continue;  // its torque loops alone are unstable: check_torque_loops()
      for (const auto& shares : shares_of(control, index - internals.first)) {
        consider(*plant, shares);
      }
    }
    return least;
  }

  // The joints' actuators with the gains that a control gives them; nullptr: not stable.
  const TensionPlant* plant_of(int control) {
    const auto known = plants_.find(control);
    if (known != plants_.end()) return known->second.get();
    std::unique_ptr<TensionPlant>& plant = plants_[control];
    const model::DriveDescription& drives = b().robot.drives;
    std::vector<TorqueResponse> joints;
    for (int j = 0; j < b().robot.joint_count(); ++j) {
      const model::JointDescription& joint = b().robot.joints[at(j)];
      const TorqueLoopMap map = torque_loop_map(
          torque_loop_gains(b(), b().controls[at(control)], j, b().values),
          {.spring = joint.spring, .rotor = joint.rotor, .viscous = context_.world.viscous},
          1.0 / drives.rate, drives.filters);
      joints.emplace_back(map, drive_timing());
      if (!joints.back().is_stable()) return nullptr;
    }
    plant = std::make_unique<TensionPlant>(TensionPlant::elastic(joints));
    return plant.get();
  }

  // By posture in which torques make the force.
  const std::vector<std::vector<double>>& shares_of(int control, int internal) {
    const auto [known, is_new] = shares_.try_emplace({control, internal});
    if (!is_new) return known->second;
    for (const model::State& posture : context_.postures) {
      context_.model.update(posture);
      auto shares = context_.law.tension_shares(b().controls[at(control)], internal);
      if (!shares.empty()) known->second.push_back(std::move(shares));
    }
    return known->second;
  }

  PhysicsContext& context_;
  StaticValues values_;
  bool elastic_;
  std::map<int, std::unique_ptr<TensionPlant>> plants_;  // by control
  std::map<std::pair<int, int>, std::vector<std::vector<double>>> shares_;
};

}  // namespace

void check_force_feedback(PhysicsContext& context) { FeedbackCheck(context).run(); }

}  // namespace footfall::behaviors
