// Internal forces against the friction cone; see parts.h.
//
// The robot is at rest: every task at its reference, no feedback. The law's contact forces are
// those of eq. (30) under its torques ([Kim16] Appendix A), including the internal forces of eqs.
// (39)-(44). With f_n along the normal of the believed ground a foot slips if |f - f_n n| > mu f_n,
// and pulls if f_n < 0; mu is the lesser of the robot file's for the foot and, in `run`, scenarios
// and sweeps, the world's.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "behaviors/check/physics/parts.h"

namespace footfall::behaviors {
namespace {

using core::Severity;

// The foot that a set of internal forces violates most.
struct Overload {
  int contact = -1;  // index into the robot's contacts
  double normal = 0.0, tangential = 0.0;
};

class ForceCheck {
 public:
  ForceCheck(PhysicsContext& context, const ControlSpec& control)
      : context_(context), control_(control), values_(context.behavior) {}

  void run() {
    const std::vector<double> none(static_cast<std::size_t>(control_.internals.count), 0.0);
    const std::vector<double> all = references();
    judge_rank(all);
    context_.findings.settle(1);
    int judged = 0;
    for (const model::State& posture : context_.postures) {
      context_.model.update(posture);
      if (overload(none)) {  // the robot cannot stand in this posture by itself
        if (&posture == context_.postures.data() && !context_.world.terrain.boxes.empty()) {
          ++judged;
          if (known_) judge_hold(all);
        }
        continue;
      }
      ++judged;
      for (int k = 0; k < control_.internals.count; ++k) {
        if (holds(k)) judge(k, all);
      }
    }
    context_.findings.settle(judged);
  }

 private:
  const InternalSpec& spec(int k) const {
    return context_.behavior.internals[static_cast<std::size_t>(control_.internals.first + k)];
  }

  // Whether all of a force's feet are in contact here; a state may inherit others.
  bool holds(int k) const {
    const auto& contacts = control_.contacts;
    return std::all_of(spec(k).contacts.begin(), spec(k).contacts.begin() + spec(k).contact_count,
                       [&](int c) { return std::ranges::find(contacts, c) != contacts.end(); });
  }

  // Internal forces in N at each contact, NaN: by statics. Those that change with time or
  // measurements, or pass through 0 N as they begin, are not known (known_) and count as 0.
  std::vector<double> references() {
    std::vector<double> values;
    for (int k = 0; k < control_.internals.count; ++k) {
      const InternalSpec& force = spec(k);
      const bool at_once = force.reference.kind != ReferenceSpec::Kind::trajectory &&
                           values_.of(force.ramp).value_or(0.0) <= 0.0;
      if (force.statics >= 0 && at_once) {
        values.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      const Dependence needs = dependence_of(context_.behavior, force.value);
      const bool fixed = force.statics < 0 && needs.fixed();
      values.push_back(fixed ? force.scale * values_.of(force.value).value_or(0.0) : 0.0);
      known_ = known_ && fixed && at_once;
    }
    return values;
  }

  // The lesser of what the robot's file claims for its foot and what the world's ground has.
  double friction(const model::ContactDescription& contact) const {
    return std::min(contact.friction, context_.world.friction.value_or(contact.friction));
  }

  std::optional<Overload> overload(const std::vector<double>& internal) {
    const RestSolution solution = context_.law.rest(control_, internal);
    in_force_ = solution.internal;
    std::optional<Overload> worst;
    double worst_excess = 0.0;
    for (std::size_t i = 0; i < control_.contacts.size(); ++i) {
      const auto& contact =
          context_.behavior.robot.contacts[static_cast<std::size_t>(control_.contacts[i])];
      const auto& f = solution.forces[i];
      const auto& n = context_.model.contact_normal(control_.contacts[i]);
      const double normal = f[0] * n[0] + f[1] * n[1] + f[2] * n[2];
      const double tangential =
          std::hypot(f[0] - normal * n[0], f[1] - normal * n[1], f[2] - normal * n[2]);
      const double excess = tangential - friction(contact) * normal;
      if (excess <= worst_excess) continue;
      worst_excess = excess;
      worst = {control_.contacts[i], normal, tangential};
    }
    return worst;
  }

  // In the posture of the start: forces that cannot be commanded one by one, such as all six
  // tensions of four feet on a plane. `between: all` asks for no more than there is.
  void judge_rank(const std::vector<double>& all) {
    std::set<int> names;
    int count = 0, last = 0;
    for (int k = 0; k < control_.internals.count; ++k) {
      if (!holds(k)) continue;
      names.insert(spec(k).instance);
      ++count;
      last = k;
    }
    if (static_cast<int>(names.size()) < count || context_.postures.empty()) return;
    context_.model.update(context_.postures.front());
    const int rank = context_.law.rest(control_, all).internal_rank;
    if (rank >= count) return;
    const core::Mark mark = spec(last).mark;
    context_.findings.add(
        Severity::error, mark, "dependent-forces", {},
        fmt::format(
            "{} internal forces, but the feet in contact bear only {} that are independent "
            "of each other{}",
            count, rank,
            control_.contacts.size() == 4 ? ": on level ground five tensions and the warp" : ""));
  }

  // Where feet stand on slopes too steep for them, internal forces have to hold them: those of the
  // law, at the start of a world with such terrain.
  void judge_hold(const std::vector<double>& all) {
    const auto found = overload(all);
    if (!found) return;
    const std::string with =
        control_.internals.count == 0
            ? "without an internal force"
            : fmt::format("with internal force '{}' of {:g} N at each foot", name(0), in_force_[0]);
    report(0, *found, Severity::error, with + " the robot cannot stand where the world starts it",
           {});
  }

  // An internal force is the cause if the law leaves the cone with it and not without it.
  void judge(int k, const std::vector<double>& all) {
    std::vector<double> without = all;
    without[static_cast<std::size_t>(k)] = 0.0;
    if (overload(without)) without.assign(all.size(), 0.0);  // several causes: test this one alone
    std::vector<double> with = without;
    with[static_cast<std::size_t>(k)] = all[static_cast<std::size_t>(k)];
    if (const auto found = overload(with)) {
      report(k, *found, Severity::error, leaves_cone(k, {}), {});
      return;
    }
    for (const int parameter : dependence_of(context_.behavior, spec(k).value).parameters) {
      judge_range(k, parameter, with);
    }
  }

  // Tests each parameter at the ends of its range, because edits may set it there.
  void judge_range(int k, int parameter, std::vector<double> internal) {
    const ParameterInfo& info = context_.behavior.parameters[static_cast<std::size_t>(parameter)];
    if (!info.has_range() || info.variable) return;
    for (const double end : {info.min, info.max}) {
      StaticValues edited(context_.behavior);
      for (int i = 0; i < info.size; ++i) {
        edited.parameters()[static_cast<std::size_t>(info.slot + i)] = end;
      }
      const auto value = edited.of(spec(k).value);
      if (!value) continue;
      internal[static_cast<std::size_t>(k)] = spec(k).scale * *value;
      if (const auto found = overload(internal)) {
        const std::string where = fmt::format(" at the end of the range of '{}'", info.name);
        report(k, *found, Severity::warning, leaves_cone(k, where), where);
        return;
      }
    }
  }

  // Of a law without internal forces: its first task.
  core::Mark first_mark() const {
    const Range& tasks = control_.tasks;
    return tasks.count > 0 ? context_.behavior.tasks[static_cast<std::size_t>(tasks.first)].mark
                           : core::Mark{};
  }

  const std::string& name(int k) const {
    return context_.behavior.internal_instances[static_cast<std::size_t>(spec(k).instance)];
  }

  std::string leaves_cone(int k, const std::string& where) const {
    return fmt::format(
        "internal force '{}' of {:g} N at each foot leaves the friction cone{}: standing still",
        name(k), in_force_[static_cast<std::size_t>(k)], where);
  }

  void report(int k, const Overload& found, Severity severity, const std::string& what,
              const std::string& subject) {
    const Behavior& b = context_.behavior;
    const auto& contact = b.robot.contacts[static_cast<std::size_t>(found.contact)];
    const std::string slips =
        found.normal <= 0.0
            ? fmt::format("{} would pull on the ground", contact.name)
            : fmt::format(
                  "{} would slip: {:.0f} N along the ground, at most {:g} x {:.0f} N = {:.0f} N{}",
                  contact.name, found.tangential, friction(contact), found.normal,
                  friction(contact) * found.normal,
                  friction(contact) < contact.friction ? " (friction of the world)" : "");
    const core::Mark mark = control_.internals.count > 0 ? spec(k).mark : first_mark();
    context_.findings.add(severity, mark, "friction-cone", subject,
                          fmt::format("{}, {}", what, slips));
  }

  PhysicsContext& context_;
  const ControlSpec& control_;
  StaticValues values_;
  bool known_ = true;             // all internal forces at the start
  std::vector<double> in_force_;  // N at each contact, of the law judged last
};

}  // namespace

void check_internal_forces(PhysicsContext& context, const ControlSpec& control) {
  if (control.internals.count > 0 || !context.world.terrain.boxes.empty()) {
    ForceCheck(context, control).run();
  }
}

}  // namespace footfall::behaviors
