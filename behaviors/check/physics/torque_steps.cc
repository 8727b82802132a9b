// Torque steps where contacts change; see parts.h.
//
// Both laws at rest in the nominal posture: the torque of the old law in the last tick before a
// transition, that of the new law in the first tick after it. A `contact_transition` of the feet in
// question makes the torque continuous ([Kim16] eqs. (1)-(2), docs/notation.md E8).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "behaviors/check/physics/configurations.h"
#include "behaviors/check/physics/parts.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

bool contains(const std::vector<int>& list, int value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

// Whether each contact of `some` is in `known` or in `moved`.
bool covered(const std::vector<int>& some, const std::vector<int>& known,
             const std::vector<int>& moved) {
  return std::all_of(some.begin(), some.end(),
                     [&](int c) { return contains(known, c) || contains(moved, c); });
}

class StepCheck {
 public:
  explicit StepCheck(PhysicsContext& context) : context_(context) {
    context_.model.update(context_.postures.front());
  }

  void run() {
    if (!(context_.behavior.robot.torque_step_limit > 0.0)) return;
    for (const ControlChange& change : control_changes(context_.behavior)) judge(change);
    context_.findings.settle(1);
  }

 private:
  const ControlSpec& control(int index) const { return context_.behavior.controls[at(index)]; }
  const TransitionSpec* transition(const ControlSpec& spec) const {
    if (spec.transition < 0) return nullptr;
    return &context_.behavior.contact_transitions[at(spec.transition)];
  }

  void judge(const ControlChange& change) {
    int before = change.from;
    const TransitionSpec* loading = transition(control(before));
    // Done with its loading, unless the transition is taken beside it, in another region or below.
    const bool loaded = loading != nullptr && loading->loads && loading->toward >= 0 &&
                        context_.behavior.is_descendant(loading->owner, change.domain);
    if (loaded) before = loading->toward;
    const std::vector<int>& left = control(before).contacts;
    const std::vector<int>& now = control(change.to).contacts;
    if (covered(left, now, {}) && covered(now, left, {})) return;
    const TransitionSpec* releasing = transition(control(change.to));
    const bool ramps =
        releasing != nullptr && !releasing->loads && contains(change.entered, releasing->owner);
    if (ramps && covered(left, now, releasing->contacts) && covered(now, left, {})) return;
    report(change, left, now, before);
  }

  void report(const ControlChange& change, const std::vector<int>& left,
              const std::vector<int>& now, int before) {
    const std::vector<double>& a = torque(before);
    const std::vector<double>& b = torque(change.to);
    std::size_t joint = 0;
    double largest = 0.0;
    for (std::size_t j = 0; j < a.size(); ++j) {
      if (std::abs(b[j] - a[j]) <= largest) continue;
      largest = std::abs(b[j] - a[j]);
      joint = j;
    }
    const auto& robot = context_.behavior.robot;
    if (largest <= robot.torque_step_limit) return;
    const TransitionInfo& info = context_.behavior.transitions[at(change.transition)];
    const bool loses = !covered(left, now, {});
    context_.findings.add(
        core::Severity::warning, info.mark, "torque-step", {},
        fmt::format("the torque of '{}' steps by {:.0f} Nm when '{}' is left, from {} to {} (the "
                    "robot's bound is {:g} Nm): ramp it with a contact_transition that {}",
                    robot.joints[joint].name, largest,
                    context_.behavior.states[at(info.source)].path,
                    contacts_text(context_.behavior, left), contacts_text(context_.behavior, now),
                    robot.torque_step_limit,
                    loses ? "releases in the state entered" : "loads in the state left"));
  }

  // Torques of a law at rest, with internal forces of 0 N.
  const std::vector<double>& torque(int index) {
    const auto known = torques_.find(index);
    if (known != torques_.end()) return known->second;
    const ControlSpec& spec = control(index);
    const std::vector<double> none(at(spec.internals.count), 0.0);
    return torques_[index] = context_.law.rest(spec, none).tau;
  }

  PhysicsContext& context_;
  std::map<int, std::vector<double>> torques_;
};

}  // namespace

void check_torque_steps(PhysicsContext& context) { StepCheck(context).run(); }

}  // namespace footfall::behaviors
