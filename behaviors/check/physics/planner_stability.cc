// Planners whose step-to-step map is unstable, or whose steady steps are too wide; see parts.h.
//
// [Kim16] V-B with E1, E2 of docs/notation.md: from one change of support to the next, relative to
// the goal, the CoM's state is multiplied by a matrix A' per axis of the heading frame
// (behaviors/planners/foot_planner.h). Steps grow without bound if the modulus of an
// eigenvalue, real or complex, exceeds 1.
//   h   the CoM's height: the reference of the state that asks, else that of the nominal posture
//   T   duration of a step: from the entry of the stride to the change of support predicted by
//       `switch_in`, i.e. the timed states before the one that asks, and `switch_in` at its entry
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <optional>
#include <vector>

#include "behaviors/check/physics/parts.h"
#include "behaviors/machine/planner_calls.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

using core::Severity;

class PlannerCheck {
 public:
  explicit PlannerCheck(PhysicsContext& context) : context_(context), values_(context.behavior) {
    context_.model.update(context_.postures.front());
  }

  void run() {
    for (std::size_t p = 0; p < context_.behavior.planners.size(); ++p) {
      const auto planner = static_cast<int>(p);
      bool good = true;
      for (const Timing& timing : timings(planner)) {
        good = good && judge(planner, timing);
        good = good && !too_wide(planner, timing);
      }
    }
    context_.findings.settle(1);
  }

 private:
  struct Timing {
    double step = 0.0;    // s
    double height = 0.0;  // m
    double coast = 0.0;   // s of the step with both feet down
  };
  const Behavior& b() const { return context_.behavior; }

  // Of all strides that ask the planner, longest first: each at its own height. Invokes that cover
  // only the rest of a step are among them, and do no harm: the shorter T, the more stable.
  std::vector<Timing> timings(int planner) const {
    std::vector<Timing> found;
    for (const InvokeInfo& invoke : b().invokes) {
      if (invoke.planner != planner || invoke.stance < 0) continue;
      const auto ahead = values_.of(invoke.switch_in);
      if (!ahead || *ahead <= 0.0) continue;
      Timing timing{*ahead, height(invoke)};
      add_time_before(invoke, timing);
      found.push_back(timing);
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Timing& a, const Timing& b) { return a.step > b.step; });
    return found;
  }

  // Time from the entry of the stride to that of the state that asks: sibling states that lead here
  // by a timer, up to one that asks the planner for the other foot.
  void add_time_before(const InvokeInfo& invoke, Timing& timing) const {
    std::vector<int> visited = {invoke.state};
    for (int s = invoke.state;;) {
      double duration = 0.0;
      const int previous = timed_predecessor(s, duration);
      const bool known = std::find(visited.begin(), visited.end(), previous) != visited.end();
      if (previous < 0 || known || plans_otherwise(previous, invoke)) return;
      visited.push_back(previous);
      timing.step += duration;
      const ControlSpec* control = control_while(previous);
      const bool both =
          control != nullptr && (control->contacts.size() > 1 || control->transition >= 0);
      if (both) timing.coast += duration;
      s = previous;
    }
  }
  int timed_predecessor(int s, double& duration) const {
    const int parent = b().states[at(s)].parent;
    for (const TransitionInfo& transition : b().transitions) {
      if (transition.after < 0 || transition.guard >= 0 || transition.targets.count != 1) continue;
      if (b().targets[at(transition.targets.first)] != s) continue;
      if (b().states[at(transition.source)].parent != parent || transition.source == s) continue;
      const auto after = values_.of(transition.after);
      if (!after) continue;
      duration = *after;
      return transition.source;
    }
    return -1;
  }
  bool plans_otherwise(int s, const InvokeInfo& invoke) const {
    return std::any_of(b().invokes.begin(), b().invokes.end(), [&](const InvokeInfo& other) {
      return other.state == s && other.planner == invoke.planner && other.stance != invoke.stance;
    });
  }

  // CoM height above the stance foot, m.
  double height(const InvokeInfo& invoke) const {
    const double measured =
        context_.model.com().position[2] - context_.model.point_position(invoke.stance)[2];
    for (const TaskSpec& task : tasks_while(invoke.state)) {
      const tasks::TaskTypeInfo& type = tasks::info(task.type);
      if (type.subject != tasks::Subject::com || !type.is_length(2)) continue;
      for (int a = task.axes.first; a < task.axes.end(); ++a) {
        const AxisSpec& axis = b().axes[at(a)];
        const Dependence needs = dependence_of(b(), axis.value);
        if (axis.axis != 2 || axis.value < 0 || needs.measured || needs.entry) continue;
        const double wanted = values_.of(axis.value).value_or(measured);
        if (wanted > 0.0) return wanted;
      }
    }
    return measured;
  }
  // The control of a configuration that contains the state; nullptr if there is none.
  const ControlSpec* control_while(int s) const {
    int sum = b().states[at(s)].control_weight;
    for (int p = b().states[at(s)].parent; p >= 0; p = b().states[at(p)].parent) {
      sum += b().states[at(p)].control_weight;
    }
    return sum < static_cast<int>(b().controls.size()) ? &b().controls[at(sum)] : nullptr;
  }
  std::vector<TaskSpec> tasks_while(int s) const {
    const ControlSpec* control = control_while(s);
    if (control == nullptr) return {};
    const Range& range = control->tasks;
    return {b().tasks.begin() + range.first, b().tasks.begin() + range.end()};
  }

  // Whether the planner is stable here, with every kappa that an edit may give it.
  bool judge(int planner, const Timing& timing) {
    const PlannerInfo& info = b().planners[at(planner)];
    const FootPlannerSpec spec = spec_in_force(info, b().values);
    if (report(info, spec, timing, Severity::error, {})) return false;
    if (info.kappa_parameter < 0) return true;
    const ParameterInfo& parameter = b().parameters[at(info.kappa_parameter)];
    if (!parameter.live || !parameter.has_range()) return true;
    for (const double end : {parameter.min, parameter.max}) {
      FootPlannerSpec edited = spec;
      edited.kappa = {end, end};
      if (report(info, edited, timing, Severity::warning,
                 fmt::format(" at the end of the range of '{}'", parameter.name))) {
        return false;
      }
    }
    return true;
  }

  // Steady steps on the spot: the CoM coasts for T2 with both feet down and is a pendulum about one
  // foot for T1; the switch ends that. Each step mirrors the one before, so the speed is the same
  // at both ends of T1; v^2 - ω^2 d^2 is constant there, so the distance d from the foot is, too:
  //   v = ω τ d,  τ = tanh(ω T1/2).
  // At the switch the next foot is v T2 + d ahead, and the middle of the sway v T2/2. The law of
  // behaviors/planners/foot_planner.h puts that foot at
  //   v T2 + d = coth(ωt')/ω v + width_offset - κ v T2/2,  so that
  //   d = width_offset / (1 + ω τ T2 - τ coth(ωt') + κ ω τ T2/2),  and steps are 2 d + v T2 wide.
  // Runs of balance_best are 5 to 9 % wider (offsets of 3 to 7 cm). Not in the model: the load that
  // goes from foot to foot within T2, and after the switch. A ramp of it instead of the coasting
  // changes the model's width by +18 % while a foot is unloaded, and by -12 % with both ramps.
  bool too_wide(int planner, const Timing& timing) {
    const PlannerInfo& info = b().planners[at(planner)];
    const FootPlannerSpec spec = spec_in_force(info, b().values);
    if (spec.max_width <= 0.0) return false;
    const double omega = std::sqrt(spec.gravity / timing.height);
    const double tau = std::tanh(0.5 * omega * (timing.step - timing.coast));
    const double coasting = omega * tau * timing.coast;  // v T2 / d
    const double offset_part = 1.0 + coasting - tau / std::tanh(omega * spec.reversal[1]) +
                               0.5 * spec.kappa[1] * coasting;  // width_offset / d
    if (offset_part <= 0.0) return false;                       // no steady step on this side
    const double width_part = (2.0 + coasting) / offset_part;   // width / width_offset
    const double width = width_part * spec.width_offset;
    if (width <= spec.max_width) return false;
    context_.findings.add(
        Severity::warning, info.mark, "out-of-reach", {},
        fmt::format("planner '{}' steps {:.3g} m wide on the spot with width_offset {:g} m (step "
                    "time T {:.3f} s, reversal {:g} ms), beyond its reach.y of {:g} m: every step "
                    "is cut; here width_offset must be below {:.3g} m",
                    info.name, width, spec.width_offset, timing.step, 1e3 * spec.reversal[1],
                    spec.max_width, spec.max_width / width_part));
    return true;
  }

  bool report(const PlannerInfo& info, const FootPlannerSpec& spec, const Timing& timing,
              Severity severity, const std::string& where) {
    // With kappa 0 one eigenvalue is exactly 1: steps drift, but do not grow. The rounding of the
    // closed form is far below any printed digit.
    constexpr double kRounding = 1e-9;
    std::complex<double> worst = 1.0;
    std::size_t axis = 0;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::complex<double> largest = step_eigenvalues(
          spec.kappa[k], spec.reversal[k], timing.step, timing.height, spec.gravity)[0];
      if (std::abs(largest) <= std::abs(worst) + kRounding) continue;
      worst = largest;
      axis = k;
    }
    if (worst == 1.0) return false;
    context_.findings.add(
        severity, info.mark, "unstable-planner", where,
        fmt::format(
            "planner '{}' diverges{}: an eigenvalue of its step-to-step map in {} is {} "
            "(kappa {:g}, reversal {:g} ms, height h {:.3f} m, step time T {:.3f} s), {}{}",
            info.name, where, axis == 0 ? "x" : "y", eigenvalue_text(worst), spec.kappa[axis],
            1e3 * spec.reversal[axis], timing.height, timing.step,
            worst.imag() == 0.0 ? "it must lie within -1 and 1" : "its modulus must not exceed 1",
            remedy(spec, timing, axis)));
    return true;
  }

  static std::string eigenvalue_text(const std::complex<double>& value) {
    if (value.imag() == 0.0) return fmt::format("{:.3f}", value.real());
    return fmt::format("{:.3f} +- {:.3f}i, of modulus {:.3f}", value.real(), std::abs(value.imag()),
                       std::abs(value));
  }

  // Which of the three conditions of behaviors/planners/foot_planner.h is broken, and what would
  // meet it.
  static std::string remedy(const FootPlannerSpec& spec, const Timing& timing, std::size_t axis) {
    if (spec.kappa[axis] < 0.0) {
      return "; kappa is positive here, the printed equation has its sign wrong";
    }
    if (spec.reversal[axis] < 0.5 * timing.step) {
      return fmt::format("; reversal must be longer than half the step, {:.0f} ms",
                         500.0 * timing.step);
    }
    const double omega = std::sqrt(spec.gravity / timing.height);
    const double product =
        std::tanh(0.5 * omega * timing.step) * std::tanh(omega * spec.reversal[axis]);
    return fmt::format("; here kappa must be below {:.3f}, or step and reversal shorter",
                       1.0 / product - 1.0);
  }

  PhysicsContext& context_;
  StaticValues values_;
};

}  // namespace

void check_planners(PhysicsContext& context) {
  if (!context.behavior.planners.empty()) PlannerCheck(context).run();
}

}  // namespace footfall::behaviors
