// Gains that a loop of this period cannot bear; see parts.h.
//
// Each axis of a task is a sampled double integrator (sampled_loop.h), as long as its level has its
// rank. Judged as the world simulates it, and as a robot holds a torque: over the whole period.
// A law without damping (kd 0) lets an error swing for ever, and sampling makes it grow: that is
// reported where it grows faster than the robot falls by itself, ω = √(g/h).
//
// A stable loop falls as well where small errors ask for more than there is. For the CoM's height
// that is certain without a model: feet push only, so nothing accelerates downwards more than g.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "behaviors/check/physics/parts.h"
#include "behaviors/check/physics/sampled_loop.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

using core::Severity;

constexpr std::array<const char*, 3> kNames = {"kp", "ki", "kd"};
constexpr std::array<const char*, 3> kUnits = {"1/s^2", "1/s^3", "1/s"};
constexpr double kRounding = 1e-9;  // of the growth in a period
constexpr double kGravity = 9.81;   // m/s^2

using Gains = std::array<double, 3>;  // kp, ki, kd

// An end of a gain's range, and the gains with it.
struct RangeEnd {
  Gains gains{};
  std::string name;
};

class GainCheck {
 public:
  explicit GainCheck(PhysicsContext& context) : context_(context), values_(context.behavior) {
    context_.model.update(context_.postures.front());
    double ground = 0.0;
    for (int c = 0; c < context_.model.contact_count(); ++c) {
      const double z = context_.model.point_position(c)[2];
      ground = c == 0 ? z : std::min(ground, z);
    }
    const double height = context_.model.com().position[2] - ground;
    if (height > 0.0) falling_ = std::sqrt(kGravity / height);
  }

  void run() {
    for (const ControlSpec& control : b().controls) {
      for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
        const TaskSpec& task = b().tasks[at(k)];
        for (int a = task.axes.first; a < task.axes.end(); ++a) judge(task, b().axes[at(a)]);
      }
    }
    context_.findings.settle(1);
  }

 private:
  const Behavior& b() const { return context_.behavior; }

  // As the world simulates a period, or as a robot lives it.
  SampledLoop loop(const TaskSpec& task, const Gains& gains, bool exact) const {
    const PhysicsWorld& world = context_.world;
    return {gains[0],
            gains[1],
            gains[2],
            b().period(),
            world.steps_per_tick,
            exact,
            world.command_delay,
            tasks::info(task.type).is_rate};
  }
  double growth_of(const SampledLoop& l) {
    const auto key = std::make_tuple(l.kp, l.ki, l.kd, l.exact, l.is_rate);
    const auto known = growths_.find(key);
    return known != growths_.end() ? known->second : growths_[key] = growth(l);
  }
  bool grows(const SampledLoop& l, bool damped) {
    const double g = growth_of(l);
    return damped ? g > 1.0 + kRounding : std::log(std::max(g, 1e-300)) > falling_ * l.period;
  }

  void judge(const TaskSpec& task, const AxisSpec& axis) {
    std::vector<RangeEnd> ends;
    const auto gains = gains_of(axis, ends);
    if (!gains) return;
    const bool damped = (*gains)[2] > 0.0;
    if (report(task, axis, *gains, damped, Severity::error, {})) return;
    report_lift(task, axis, *gains);
    for (const RangeEnd& end : ends) {
      if (report(task, axis, end.gains, damped, Severity::warning,
                 fmt::format(" at the end of the range of '{}'", end.name))) {
        return;
      }
    }
  }

  // Gains in the first tick, nullopt if they depend on what is measured; and with each end of a
  // range that an edit can reach. An end of 0 switches the gain off, and says nothing of the rest.
  std::optional<Gains> gains_of(const AxisSpec& axis, std::vector<RangeEnd>& ends) const {
    const std::array<int, 3> slots = {axis.kp, axis.ki, axis.kd};
    Gains gains{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (slots[k] >= 0) {
        gains[k] = b().values[at(slots[k])];
      } else if (axis.computed[k] >= 0) {
        const Dependence needs = dependence_of(b(), axis.computed[k]);
        if (needs.measured || needs.variable || needs.entry) return std::nullopt;
        gains[k] = values_.of(axis.computed[k]).value_or(0.0);
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (slots[k] >= 0) add_ends(b().parameter_of_slot(slots[k]), slots[k], k, -1, gains, ends);
      if (slots[k] >= 0 || axis.computed[k] < 0) continue;
      for (const int parameter : dependence_of(b(), axis.computed[k]).parameters) {
        add_ends(parameter, -1, k, axis.computed[k], gains, ends);
      }
    }
    return gains;
  }

  void add_ends(int parameter, int slot, std::size_t gain, int expression, const Gains& gains,
                std::vector<RangeEnd>& ends) const {
    if (parameter < 0) return;
    const ParameterInfo& info = b().parameters[at(parameter)];
    if (!info.live || !info.has_range()) return;
    for (const double end : {info.min, info.max}) {
      RangeEnd edited = {gains, info.name};
      if (slot >= 0) {
        edited.gains[gain] = end;
      } else {
        StaticValues values(b());
        for (int i = 0; i < info.size; ++i) values.parameters()[at(info.slot + i)] = end;
        edited.gains[gain] = values.of(expression).value_or(0.0);
      }
      if (edited.gains[gain] > 0.0) ends.push_back(std::move(edited));
    }
  }

  bool report(const TaskSpec& task, const AxisSpec& axis, const Gains& gains, bool damped,
              Severity severity, const std::string& where) {
    const bool simulated = grows(loop(task, gains, false), damped);
    const bool held = grows(loop(task, gains, true), damped);
    if (!simulated && !held) return false;
    const SampledLoop l = loop(task, gains, !simulated);
    const std::size_t gain = culprit(task, gains, damped, l.exact);
    context_.findings.add(
        simulated ? severity : Severity::warning, axis.mark, "unstable-gains",
        axis_text(task, axis),
        fmt::format("task '{}' is unstable in '{}'{}{}: {} {:g} {} is too much for a period of "
                    "{:.3g} ms{}: an error grows {}; {} {:.4g} {} is the most{}",
                    b().task_instances[at(task.instance)].name, axis_text(task, axis), where,
                    simulated ? "" : " on a robot, which holds its torque over the whole period",
                    kNames[gain], gains[gain], kUnits[gain], 1e3 * l.period, delay_text(),
                    growth_text(growth_of(l), l.period), kNames[gain],
                    most(task, gains, gain, damped, l.exact), kUnits[gain], others(gains, gain)));
    return true;
  }

  // The CoM's height, unless its acceleration is bounded.
  void report_lift(const TaskSpec& task, const AxisSpec& axis, const Gains& gains) {
    constexpr double kError = 1e-3;  // m
    constexpr double kSpeed = 1e-2;  // m/s
    const tasks::TaskTypeInfo& type = tasks::info(task.type);
    if (type.subject != tasks::Subject::com || !type.is_length(2) || axis.axis != 2) return;
    const double wanted = gains[0] * kError + gains[2] * kSpeed;
    if (axis.acceleration_limit >= 0 || wanted <= kGravity) return;
    context_.findings.add(
        Severity::warning, axis.mark, "lifts-feet", axis_text(task, axis),
        fmt::format("task '{}' asks for {:.3g} m/s^2 when the CoM is 1 mm too high and 1 cm/s too "
                    "fast (kp {:g}, kd {:g}): feet cannot pull, so beyond 9.81 m/s^2 they leave "
                    "the ground; smaller gains, or `acceleration_limit`",
                    b().task_instances[at(task.instance)].name, wanted, gains[0], gains[2]));
  }

  std::string axis_text(const TaskSpec& task, const AxisSpec& axis) const {
    return tasks::axis_names(task.type, b().robot)[at(axis.axis)];
  }
  std::string delay_text() const {
    const double delay = context_.world.command_delay;
    return delay > 0.0 ? fmt::format(" and a delay of {:.3g} ms", 1e3 * delay) : "";
  }
  static std::string growth_text(double g, double period) {
    if (g > 1.1) return fmt::format("{:.3g} times in each period", g);
    return fmt::format("by e in {:.3g} s", period / std::log(g));
  }
  static std::string others(const Gains& gains, std::size_t gain) {
    std::string text;
    for (std::size_t k = 0; k < 3; ++k) {
      if (k == gain || gains[k] == 0.0) continue;
      text += fmt::format("{}{} {:g}", text.empty() ? " with " : " and ", kNames[k], gains[k]);
    }
    return text;
  }

  // The gain without which the rest is stable: kd alone, then with kp, then the integral.
  std::size_t culprit(const TaskSpec& task, const Gains& gains, bool damped, bool exact) {
    if (grows(loop(task, {0.0, 0.0, gains[2]}, exact), true)) return 2;
    return grows(loop(task, {gains[0], 0.0, gains[2]}, exact), damped) ? 0 : 1;
  }
  // The largest value with which the loop is stable, the others as they are (kp and ki above it 0).
  double most(const TaskSpec& task, Gains gains, std::size_t gain, bool damped, bool exact) {
    if (gain != 1) gains[1] = 0.0;
    if (gain == 2) gains[0] = 0.0;
    double low = 0.0, high = gains[gain];
    for (int k = 0; k < 60; ++k) {
      gains[gain] = 0.5 * (low + high);
      (grows(loop(task, gains, exact), damped) ? high : low) = gains[gain];
    }
    return low;
  }

  PhysicsContext& context_;
  StaticValues values_;
  double falling_ = 1e300;  // 1/s
  std::map<std::tuple<double, double, double, bool, bool>, double> growths_;
};

}  // namespace

void check_gains(PhysicsContext& context) { GainCheck(context).run(); }

}  // namespace footfall::behaviors
