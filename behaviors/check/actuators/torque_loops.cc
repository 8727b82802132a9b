// Torque loops that are unstable, or that can give energy to what the joint holds; see
// physics/parts.h.
//
// Each table is judged for every joint that uses it, with the robot's spring and rotor:
// - the sampled loop, output locked (sampled_torque_loop.h): an error if it grows;
// - passivity at the output, zero torque reference, no delay: `cascade` by the closed form of
//   hal/actuators/passivity.h, `direct` by a sweep of its admittance;
// both also at the ends of the gains' live ranges, one at a time, as task gains are.
//
// A cascade without velocity_p asks for no motor torque: stable and passive. A direct loop without
// d on a robot without `drives` is not judged: its damping is not known.
#include "behaviors/compiled/torque_loops.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <tuple>

#include "behaviors/check/actuators/sampled_torque_loop.h"
#include "behaviors/check/physics/parts.h"
#include "core/index.h"
#include "core/units/units.h"
#include "hal/actuators/passivity.h"
#include "model/robot/torque_loop.h"

namespace footfall::behaviors {
namespace {

using core::Severity;
using hal::TorqueLoopGains;
using Gain = double TorqueLoopGains::*;

constexpr double kGrowthRounding = 1e-9;  // of the growth in a period

// The gain to change, and the value up to (or from) which it is good.
struct Remedy {
  Gain gain = &TorqueLoopGains::p;
  double bound = 0.0;
  bool at_least = false;
  double velocity_bound = -1.0;  // also of velocity_i, if both integrals are too large; -1: not
  bool alone = false;            // the bound holds without integrals
};

// A finding about one value of a table, in all joints that have it; text and mark of the worst one.
struct Found {
  Severity severity = Severity::warning;
  core::Mark mark;
  std::string joint, text;
  double badness = 0.0;
  int count = 0;
};

// One joint's loop with the gains of a table.
class JointLoop {
 public:
  JointLoop(const model::JointDescription& joint, const model::DriveDescription& drives,
            const TorqueLoopGains& gains)
      : actuator_{.spring = joint.spring, .rotor = joint.rotor}, drives_(drives), gains_(gains) {}

  const TorqueLoopGains& gains() const { return gains_; }
  bool is_cascade() const { return gains_.type == TorqueLoopGains::Type::cascade; }
  double growth(const TorqueLoopGains& gains) const {
    return torque_loop_growth(gains, actuator_, 1.0 / drives_.rate, drives_.filters);
  }
  bool is_stable(const TorqueLoopGains& gains) const {
    return growth(gains) <= 1.0 + kGrowthRounding;
  }
  bool is_passive(const TorqueLoopGains& gains) const { return passivity(gains) >= 0.0; }

  // 0 or more: passive. Of `direct` the least real part of the admittance from 0.1 Hz to 1 kHz,
  // relative to its size at the low end, where it is largest.
  double passivity(const TorqueLoopGains& gains) const {
    constexpr double kFrom = 0.1, kTo = 1000.0;  // Hz
    constexpr int kPoints = 81;                  // 20 a decade
    constexpr double kRounding = 1e-12;
    if (is_cascade()) return hal::passivity_margin(gains, actuator_);
    const double least = hal::least_admittance(gains, actuator_, 0.0, kFrom, kTo, kPoints);
    const double size = std::abs(
        hal::output_admittance(gains, actuator_, 0.0, {0.0, 2.0 * std::numbers::pi * kFrom}));
    return std::abs(least) < kRounding * size ? 0.0 : least / size;
  }

  // The gain without which the rest is stable: damping alone, then with p, then the integrals.
  Remedy stable_remedy() const {
    const Gain damping = is_cascade() ? &TorqueLoopGains::velocity_p : &TorqueLoopGains::damping;
    TorqueLoopGains part = gains_;
    part.velocity_i = 0.0;
    const bool outer = !is_stable(part);  // it is not the inner integral
    part.i = 0.0;
    const bool proportional = !is_stable(part);
    part.p = 0.0;
    Gain gain = outer ? &TorqueLoopGains::i : &TorqueLoopGains::velocity_i;
    if (gains_.*damping == 0.0 || !is_stable(part)) {
      gain = damping;
    } else if (proportional) {
      gain = &TorqueLoopGains::p;
    }
    Remedy remedy = {gain};
    remedy.at_least = gains_.*gain == 0.0;
    TorqueLoopGains others = gains_;
    auto bound = remedy.at_least ? stable_from(others, gain) : stable_up_to(others, gain);
    if (!bound) {
      others.i = gain == &TorqueLoopGains::i ? others.i : 0.0;
      others.velocity_i = gain == &TorqueLoopGains::velocity_i ? others.velocity_i : 0.0;
      remedy.alone = true;
      bound = remedy.at_least ? stable_from(others, gain) : stable_up_to(others, gain);
    }
    remedy.bound = bound.value_or(0.0);
    return remedy;
  }

  // The integral that gives energy, with the most that does not.
  Remedy passive_remedy() const {
    if (!is_cascade()) {
      TorqueLoopGains gains = gains_;
      double good = 0.0, bad = gains_.i;
      for (int k = 0; k < kHalvings; ++k) {
        gains.i = 0.5 * (good + bad);
        (is_passive(gains) ? good : bad) = gains.i;
      }
      return {&TorqueLoopGains::i, good};
    }
    // (1 + P_v P_t)(b + P_v) / J >= P_v I_t + I_v P_t
    const double most = (1.0 + gains_.velocity_p * gains_.p) *
                        (actuator_.viscous + gains_.velocity_p) / actuator_.rotor;
    const double outer = gains_.velocity_p * gains_.i, inner = gains_.velocity_i * gains_.p;
    if (std::min(outer, inner) >= most) {  // each alone is too large: half of it for each
      return {&TorqueLoopGains::i, 0.5 * most / gains_.velocity_p, false, 0.5 * most / gains_.p};
    }
    if (outer >= inner) return {&TorqueLoopGains::i, (most - inner) / gains_.velocity_p};
    return {&TorqueLoopGains::velocity_i, (most - outer) / gains_.p};
  }

 private:
  static constexpr int kHalvings = 40;

  double halved(TorqueLoopGains gains, Gain gain, double good, double bad) const {
    for (int k = 0; k < kHalvings; ++k) {
      gains.*gain = 0.5 * (good + bad);
      (is_stable(gains) ? good : bad) = gains.*gain;
    }
    return good;
  }
  // The first good value on the way down; nullopt within nine decades: none.
  std::optional<double> stable_up_to(TorqueLoopGains gains, Gain gain) const {
    constexpr double kDown = 0.8, kLeast = 1e-9;
    const double start = gains.*gain;
    double bad = start;
    for (double good = kDown * start; good > kLeast * start; good *= kDown) {
      gains.*gain = good;
      if (is_stable(gains)) return halved(gains, gain, good, bad);
      bad = good;
    }
    return std::nullopt;
  }
  // The first good value on the way up, in parts of the spring's and rotor's critical damping.
  std::optional<double> stable_from(TorqueLoopGains gains, Gain gain) const {
    constexpr double kUp = 1.25, kFrom = 1e-6, kTo = 1e6;
    const double critical = 2.0 * std::sqrt(actuator_.spring * actuator_.rotor);
    double bad = 0.0;
    for (double part = kFrom; part < kTo; part *= kUp) {
      gains.*gain = part * critical;
      if (is_stable(gains)) return halved(gains, gain, gains.*gain, bad);
      bad = gains.*gain;
    }
    return std::nullopt;
  }

  hal::SeriesElasticParameters actuator_;
  TorqueLoopGains gains_;
  const model::DriveDescription& drives_;
};

class TorqueLoopCheck {
 public:
  explicit TorqueLoopCheck(PhysicsContext& context)
      : context_(context), period_(1.0 / context.behavior.robot.drives.rate) {}

  void run() {
    const auto& joints = b().robot.joints;
    // Ideal actuators: tables are for another robot of the family.
    if (!std::ranges::any_of(joints, has_actuator)) return;
    std::set<std::pair<int, int>> used;  // table and joint
    for (const ControlSpec& control : b().controls) {
      for (std::size_t j = 0; j < control.torque_loops.size(); ++j) {
        if (control.torque_loops[j] >= 0) {
          used.emplace(control.torque_loops[j], static_cast<int>(j));
        }
      }
    }
    for (const auto& [table, joint] : used) judge(table, joint);
    report();
  }

 private:
  const Behavior& b() const { return context_.behavior; }
  static bool has_actuator(const model::JointDescription& joint) {
    return joint.spring > 0.0 && joint.rotor > 0.0;
  }

  void judge(int index, int joint) {
    const TorqueLoopTable& table = b().torque_loops[at(index)];
    const model::JointDescription& description = b().robot.joints[at(joint)];
    if (!has_actuator(description)) {
      context_.findings.add(
          Severity::error, table.mark, "no-actuator", description.name,
          fmt::format("joint '{}' has no series-elastic actuator (sea) in robot '{}': "
                      "torque_loop '{}' cannot apply to it",
                      description.name, b().robot.name, table.name));
      return;
    }
    const TorqueLoopGains gains = torque_loop_gains(b(), index, joint, b().values);
    if (is_unknown(table, gains)) return;
    if (hal::gives_no_torque(gains) && !b().robot.drives.torque_loop.empty()) {
      context_.findings.add(Severity::warning, table.mark, "idle-torque-loop", table.name,
                            fmt::format("torque_loop '{}' gives '{}' no torque at all: expected p "
                                        "(and velocity_p of a cascade) above 0; p and i of the "
                                        "robot's own loops are of their type only",
                                        table.name, description.name));
    }
    const JointLoop loop(description, context_.behavior.robot.drives, gains);
    if (find_unstable(table, joint, loop, Severity::error, "")) return;
    const bool passive = !find_active(table, joint, loop, "");
    for (std::size_t k = 0; k < table.slots.size(); ++k) {
      if (table.slots[k] < 0) continue;
      const ParameterInfo& info = b().parameters[at(b().parameter_of_slot(table.slots[k]))];
      if (!info.live || !info.has_range()) continue;
      for (const double end : {info.min, info.max}) {
        TorqueLoopGains edited = gains;
        edited.*model::kTorqueLoopGainKeys[k].member = end;
        const JointLoop at_end(description, context_.behavior.robot.drives, edited);
        const std::string where = fmt::format(" at the end of the range of '{}'", info.name);
        if (!find_unstable(table, joint, at_end, Severity::warning, where) && passive) {
          find_active(table, joint, at_end, where);
        }
      }
    }
  }

  bool is_unknown(const TorqueLoopTable& table, const TorqueLoopGains& gains) const {
    return table.type == TorqueLoopGains::Type::direct && gains.damping == 0.0 &&
           b().robot.drives.torque_loop.empty() &&
           table.slots[index_of(&TorqueLoopGains::damping)] < 0;
  }

  static std::size_t index_of(Gain gain) {
    const auto* const found =
        std::ranges::find(model::kTorqueLoopGainKeys, gain, &model::TorqueLoopKey::member);
    return static_cast<std::size_t>(found - model::kTorqueLoopGainKeys.data());
  }

  // Of the gain's value for a joint; if the table does not name it, of the first that it does.
  core::Mark mark_of(const TorqueLoopTable& table, Gain gain, int joint) const {
    const std::size_t own = index_of(gain);
    if (table.slots[own] >= 0) return table.marks[own][at(joint)];
    for (std::size_t k = 0; k < table.slots.size(); ++k) {
      if (table.slots[k] >= 0) return table.marks[k][at(joint)];
    }
    return table.mark;
  }

  bool find_unstable(const TorqueLoopTable& table, int joint, const JointLoop& loop,
                     Severity severity, const std::string& where) {
    const double growth = loop.growth(loop.gains());
    if (growth <= 1.0 + kGrowthRounding) return false;
    const Remedy remedy = loop.stable_remedy();
    add(table, joint, remedy, severity, "unstable-torque-loop", where, growth,
        fmt::format("at {:g} Hz an error grows {}; {}", b().robot.drives.rate, growth_text(growth),
                    remedy_text(loop.gains(), remedy)));
    return true;
  }

  bool find_active(const TorqueLoopTable& table, int joint, const JointLoop& loop,
                   const std::string& where) {
    const double margin = loop.passivity(loop.gains());
    if (margin >= 0.0) return false;
    const Remedy remedy = loop.passive_remedy();
    add(table, joint, remedy, Severity::warning, "active-torque-loop", where, -margin,
        fmt::format("it can give energy to what the joint holds (margin {:.3g}); {}", margin,
                    remedy_text(loop.gains(), remedy)));
    return true;
  }

  std::string growth_text(double growth) const {
    if (growth > 1.1) return fmt::format("{:.3g} times in each step", growth);
    return fmt::format("by e in {:.3g} s", period_ / std::log(growth));
  }

  // `i 900 1/s: at most 412 1/s with this p, d and rotor`.
  static std::string remedy_text(const TorqueLoopGains& gains, const Remedy& remedy) {
    const auto with_unit = [&](double value, Gain gain, int digits) {
      const auto& key = model::kTorqueLoopGainKeys[index_of(gain)];
      const std::string unit = core::unit_text(key.dimension(gains.type));
      return fmt::format("{:.{}g}{}{}", value, digits, unit.empty() ? "" : " ", unit);
    };
    const std::string name(model::kTorqueLoopGainKeys[index_of(remedy.gain)].name);
    std::string bound = with_unit(remedy.bound, remedy.gain, 4);
    if (bound == with_unit(gains.*remedy.gain, remedy.gain, 6)) {
      bound = with_unit(remedy.bound, remedy.gain, 8);
    }
    std::string text =
        fmt::format("{} {}: {} {}", name, with_unit(gains.*remedy.gain, remedy.gain, 6),
                    remedy.at_least ? "at least" : "at most", bound);
    if (remedy.velocity_bound >= 0.0) {
      text +=
          " and velocity_i " + with_unit(remedy.velocity_bound, &TorqueLoopGains::velocity_i, 4);
    }
    text += remedy.alone ? ", without integrals," : "";
    text += " with this ";
    for (const model::TorqueLoopKey& key : model::kTorqueLoopGainKeys) {
      if (key.member == remedy.gain || gains.*key.member == 0.0 || !key.belongs_to(gains.type) ||
          key.member == &TorqueLoopGains::forward || key.member == &TorqueLoopGains::observer) {
        continue;
      }
      text += fmt::format("{}, ", key.name);
    }
    if (text.ends_with(", ")) text.replace(text.size() - 2, 2, " and ");
    return text + "rotor";
  }

  // Joints whose gain is the same text share a finding, with the figures of the worst one.
  void add(const TorqueLoopTable& table, int joint, const Remedy& remedy, Severity severity,
           const char* id, const std::string& where, double badness, const std::string& text) {
    const core::Mark mark = mark_of(table, remedy.gain, joint);
    const std::string subject = table.name + where;
    Found& found = found_[{mark.file, mark.line, mark.column, id, subject}];
    const std::string& name = b().robot.joints[at(joint)].name;
    const bool worse = found.joint.empty() || badness > found.badness;
    ++found.count;
    if (!worse) return;
    found.mark = mark;
    found.severity = severity;
    found.badness = badness;
    found.joint = name;
    found.text = text;
  }

  void report() {
    for (const auto& [key, found] : found_) {
      const auto& [file, line, column, id, subject] = key;
      const std::string table = subject.substr(0, subject.find(' '));
      const std::string others = found.count > 1
                                     ? fmt::format(" (and in {} more joint{})", found.count - 1,
                                                   found.count > 2 ? "s" : "")
                                     : "";
      context_.findings.add(
          found.severity, found.mark, id, subject,
          fmt::format("torque_loop '{}' {} in '{}'{}{}: {}", table,
                      id == "active-torque-loop" ? "is not passive" : "is unstable", found.joint,
                      others, subject.substr(table.size()), found.text));
    }
    context_.findings.settle(1);
  }

  PhysicsContext& context_;
  double period_;  // s
  // By place, id, and table with the end of a range.
  std::map<std::tuple<int, int, int, std::string, std::string>, Found> found_;
};

}  // namespace

void check_torque_loops(PhysicsContext& context) { TorqueLoopCheck(context).run(); }

}  // namespace footfall::behaviors
