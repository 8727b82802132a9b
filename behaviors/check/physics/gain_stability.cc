// Gains that a loop of this period cannot bear; see parts.h.
//
// Each axis of a task is a sampled double integrator (sampled_loop.h), as long as its level has its
// rank. Judged as the world simulates it, and as a robot holds a torque: over the whole period.
// A law without damping (kd 0) lets an error swing for ever, and sampling makes it grow: that is
// reported where it grows faster than the robot falls by itself, ω = √(g/h).
//
// A stable loop falls as well where small errors ask for more than there is. For the CoM that is
// known without a model of the rest: feet push only, so nothing accelerates downwards more than g;
// and with all of the weight on one of two feet, at the distance d from the CoM along the line of
// the feet, the CoM at the height h accelerates by g d / h away from it (the ground's force points
// to the CoM while the angular momentum is kept), and no more.
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
        for (int a = task.axes.first; a < task.axes.end(); ++a) {
          judge(control, task, b().axes[at(a)]);
        }
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

  void judge(const ControlSpec& control, const TaskSpec& task, const AxisSpec& axis) {
    std::vector<RangeEnd> ends;
    const auto gains = gains_of(axis, ends);
    if (!gains) return;
    if (report(task, axis, *gains, Severity::error, {})) return;
    report_lift(control, task, axis, *gains);
    for (const RangeEnd& end : ends) {
      if (report(task, axis, end.gains, Severity::warning,
                 fmt::format(" at the end of the range of '{}'", end.name))) {
        return;
      }
    }
  }

  // Gains in the first tick, nullopt if they depend on what is measured; and with each end of a
  // range that an edit can reach.
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
      ends.push_back(std::move(edited));
    }
  }

  bool report(const TaskSpec& task, const AxisSpec& axis, const Gains& gains, Severity severity,
              const std::string& where) {
    const bool damped = gains[2] > 0.0;
    const bool simulated = grows(loop(task, gains, false), damped);
    const bool held = grows(loop(task, gains, true), damped);
    if (!simulated && !held) return false;
    const SampledLoop l = loop(task, gains, !simulated);
    const std::size_t gain = culprit(task, gains, damped, l.exact);
    context_.findings.add(
        simulated ? severity : Severity::warning, axis.mark, "unstable-gains",
        axis_text(task, axis),
        fmt::format("task '{}' is unstable in '{}'{}{}: {} {:g} {} is too much for a period of "
                    "{:.3g} ms{}: an error grows {}{}",
                    b().task_instances[at(task.instance)].name, axis_text(task, axis), where,
                    simulated ? "" : " on a robot, which holds its torque over the whole period",
                    kNames[gain], gains[gain], kUnits[gain], 1e3 * l.period, delay_text(),
                    growth_text(growth_of(l), l.period), remedy(task, gains, gain, l.exact)));
    return true;
  }

  // What the feet can give the CoM along an axis of the world, m/s^2; nullopt if it is not known.
  std::optional<double> given_by_feet(const ControlSpec& control, std::size_t axis) const {
    if (axis == 2) return kGravity;
    if (control.contacts.size() != 2) return std::nullopt;
    const auto right = context_.model.point_position(control.contacts[0]);
    const auto left = context_.model.point_position(control.contacts[1]);
    const auto com = context_.model.com().position;
    constexpr double kAlong = 0.9;  // cosine of the angle between the axis and the line of the feet
    const double apart = std::hypot(left[0] - right[0], left[1] - right[1]);
    const double height = com[2] - std::min(left[2], right[2]);
    if (height <= 0.0 || std::abs(left[axis] - right[axis]) < kAlong * apart) return std::nullopt;
    const double distance =
        std::min(std::abs(com[axis] - right[axis]), std::abs(com[axis] - left[axis]));
    const bool between = (com[axis] - right[axis]) * (com[axis] - left[axis]) < 0.0;
    return between ? std::optional(kGravity * distance / height) : std::nullopt;
  }

  // Position axes of the CoM, unless their acceleration is bounded to what there is.
  void report_lift(const ControlSpec& control, const TaskSpec& task, const AxisSpec& axis,
                   const Gains& gains) {
    constexpr double kError = 1e-3;  // m
    constexpr double kSpeed = 1e-2;  // m/s
    const tasks::TaskTypeInfo& type = tasks::info(task.type);
    if (type.subject != tasks::Subject::com || !type.is_length(axis.axis)) return;
    const auto given = given_by_feet(control, at(axis.axis));
    const double wanted = gains[0] * kError + gains[2] * kSpeed;
    if (!given || std::min(wanted, limit_of(axis)) <= *given) return;
    const std::string name = b().task_instances[at(task.instance)].name;
    const bool up = axis.axis == 2;
    context_.findings.add(
        Severity::warning, axis.mark, "lifts-feet", axis_text(task, axis),
        fmt::format("task '{}' asks for {:.3g} m/s^2{} when the CoM is 1 mm {} and 1 cm/s too "
                    "fast (kp {:g}, kd {:g}): feet cannot pull, so beyond {:.3g} m/s^2 {} "
                    "the ground; smaller gains, or an `acceleration_limit` below that",
                    name, std::min(wanted, limit_of(axis)),
                    up ? "" : fmt::format(" in '{}'", axis_text(task, axis)),
                    up ? "too high" : "away", gains[0], gains[2], *given,
                    up ? "they leave" : "one of the two leaves"));
  }
  // A limit that depends on what is measured is taken to be right.
  double limit_of(const AxisSpec& axis) const {
    constexpr double kUnlimited = 1e300;
    if (axis.acceleration_limit < 0) return kUnlimited;
    const Dependence needs = dependence_of(b(), axis.acceleration_limit);
    if (needs.measured || needs.variable || needs.entry) return 0.0;
    return values_.of(axis.acceleration_limit).value_or(0.0);
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
    const bool braked = gains[2] > 0.0;  // kd T = 2 alone neither grows nor decays
    if (braked && growth_of(loop(task, {0.0, 0.0, gains[2]}, exact)) > 1.0 - kRounding) return 2;
    return grows(loop(task, {gains[0], 0.0, gains[2]}, exact), damped) ? 0 : 1;
  }
  // The first value of a gain, on from the one given by a factor, with which the loop is stable, to
  // 1e-3 of it; the others as they are. nullopt: none is found within nine decades.
  std::optional<double> stable(const TaskSpec& task, Gains gains, std::size_t gain, double factor,
                               bool exact) {
    const auto is_stable = [&](double value) {
      gains[gain] = value;
      return !grows(loop(task, gains, exact), gains[2] > 0.0);
    };
    const double start = gains[gain];
    double bad = start, good = start;
    do {
      bad = good;
      good *= factor;
      if (good < 1e-9 * start || good > 1e9 * start) return std::nullopt;
    } while (!is_stable(good));
    for (int k = 0; k < 24; ++k) {
      const double middle = 0.5 * (good + bad);
      (is_stable(middle) ? good : bad) = middle;
    }
    return good;
  }

  // The most that is stable with the others as they are; if there is none, without the integral,
  // then alone. An integral is stable as well with more kp: above ki / kd in the limit of T -> 0.
  std::string remedy(const TaskSpec& task, const Gains& gains, std::size_t gain, bool exact) {
    constexpr double kDown = 0.8, kUp = 1.1;
    const auto most_text = [&](const Gains& held) -> std::string {
      const auto most = stable(task, held, gain, kDown, exact);
      if (!most) return {};
      std::string without;
      for (std::size_t k = 0; k < 3; ++k) {
        if (held[k] != gains[k]) {
          without += fmt::format("{}{}", without.empty() ? " without " : " and ", kNames[k]);
        }
      }
      std::string number = fmt::format("{:.4g}", *most);
      if (number == fmt::format("{:g}", gains[gain])) number = fmt::format("{:.7g}", *most);
      return fmt::format("; {} {} {} is the most{}{}", kNames[gain], number, kUnits[gain],
                         others(held, gain), without);
    };
    const bool none = gain == 1 && gains[0] == 0.0;  // any integral grows, however slowly
    std::string text = none ? "" : most_text(gains);
    if (gain == 1) {
      if (gains[2] == 0.0) return text;
      Gains more = gains;
      more[0] = std::max(gains[0], 1e-2 * gains[1] / gains[2]);
      const auto least = stable(task, more, 0, kUp, exact);
      if (!least) return text;
      return text + fmt::format("{} kp must be above {:.4g} {}{}", text.empty() ? ";" : ", or",
                                *least, kUnits[0], text.empty() ? others(more, 0) : "");
    }
    if (text.empty() && gains[1] != 0.0) text = most_text({gains[0], 0.0, gains[2]});
    Gains alone{};
    alone[gain] = gains[gain];
    return text.empty() ? most_text(alone) : text;
  }

  PhysicsContext& context_;
  StaticValues values_;
  double falling_ = 1e300;  // 1/s
  std::map<std::tuple<double, double, double, bool, bool>, double> growths_;
};

}  // namespace

void check_gains(PhysicsContext& context) { GainCheck(context).run(); }

}  // namespace footfall::behaviors
