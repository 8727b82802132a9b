// All physics checks of one behavior; see check.h.
#include "behaviors/check/physics/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "behaviors/check/physics/configurations.h"
#include "behaviors/check/physics/parts.h"
#include "behaviors/check/physics/postures.h"
#include "behaviors/compiled/times.h"
#include "core/index.h"
#include "model/check/check.h"

namespace footfall::behaviors {
namespace {

model::ModelDeviation deviation_of(const PhysicsWorld& world) {
  model::ModelDeviation deviation;
  deviation.terrain = world.terrain;
  return deviation;
}

// Maximum number of configurations evaluated; parallel regions can multiply beyond reasonable time.
constexpr std::size_t kMaxJudged = 1000;

// Contacts, tasks and internal forces as numbers; controls with equal signatures are evaluated
// once.
std::vector<int> signature(const Behavior& behavior, const ControlSpec& control) {
  std::vector<int> out = control.contacts;
  for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
    const TaskSpec& task = behavior.tasks[at(k)];
    out.insert(out.end(), {-1, task.instance, task.priority, static_cast<int>(task.frame)});
    for (int a = task.axes.first; a < task.axes.end(); ++a) {
      out.push_back(behavior.axes[at(a)].axis);
    }
  }
  for (int k = control.internals.first; k < control.internals.end(); ++k) {
    const InternalSpec& internal = behavior.internals[at(k)];
    out.insert(out.end(), {-2, internal.instance, internal.value, internal.statics});
    out.insert(out.end(), internal.contacts.begin(), internal.contacts.end());
  }
  return out;
}

// Reports contacts that the control law would treat as points.
void check_contact_types(const Behavior& behavior, const ControlSpec& control,
                         PhysicsFindings& findings) {
  for (const int c : control.contacts) {
    const model::ContactDescription& contact = behavior.robot.contacts[at(c)];
    if (contact.type == model::ContactType::point) continue;
    findings.add(
        core::Severity::error, contact.type_mark, "unsupported", contact.name,
        fmt::format("contact '{}' is of type '{}', which is not available in this version: "
                    "the control law knows points; give it several of them",
                    contact.name,
                    contact.type == model::ContactType::surface ? "surface" : "fixed"));
  }
  findings.settle(1);
}

// Contacts, ranks and internal forces of every configuration; false if there are too many.
bool check_configurations(PhysicsContext& context) {
  std::set<std::vector<int>> judged;
  for (const auto& [index, state] : controlling_states(context.behavior)) {
    const ControlSpec& control = context.behavior.controls[at(index)];
    if (!judged.insert(signature(context.behavior, control)).second) continue;
    if (judged.size() > kMaxJudged) return false;
    check_contact_types(context.behavior, control, context.findings);
    for (const model::State& posture : context.postures) {
      context.model.update(posture);
      check_ranks(context, control, context.behavior.states[at(state)].mark);
    }
    context.findings.settle(static_cast<int>(context.postures.size()));
    check_internal_forces(context, control);
  }
  return true;
}

}  // namespace

void check_first_support(const Behavior& behavior, const std::string& unaided,
                         core::Diagnostics& diagnostics) {
  const FirstControl first = first_control(behavior);
  if (unaided.empty() || first.control < 0 || first.control >= std::ssize(behavior.controls)) {
    return;
  }
  const ControlSpec& control = behavior.controls[at(first.control)];
  if (!control.contacts.empty() || control.tasks.count == 0) return;
  const StateInfo& state = behavior.states[at(first.state)];
  diagnostics.warning(
      state.mark, "no-support",
      fmt::format("'{}' begins the run and relies on no contact, but nothing in the world '{}' "
                  "holds the robot: it falls at once; expected a world whose `constraints:` do, as "
                  "a rope or a hoist",
                  state.path, unaided));
}

void check_physics(const Behavior& behavior, core::Diagnostics& diagnostics,
                   const PhysicsWorld& world) {
  if (!behavior.has_robot) return;
  if (!model::check_model(behavior.robot, diagnostics)) return;
  model::ControlModel model(behavior.robot, deviation_of(world));
  PhysicsLaw law(behavior, model);
  const std::vector<model::State> postures = physics_postures(behavior.robot, model, world);
  PhysicsFindings findings;
  PhysicsContext context = {behavior, model, law, postures, findings, world};
  if (!check_configurations(context)) {
    diagnostics.warning(behavior.states.front().mark, "too-many",
                        fmt::format("physics is judged in the first {} different configurations, "
                                    "and not in the others",
                                    kMaxJudged));
  }
  check_first_support(behavior, world.unaided, diagnostics);
  check_references(context);
  check_feed_forward(context);
  check_gains(context);
  check_torque_loops(context);
  check_force_feedback(context);
  check_planners(context);
  check_torque_steps(context);
  findings.report(diagnostics);
  if (!diagnostics.has_errors()) check_live_ranges(behavior, world, diagnostics);
}

std::function<void(const Behavior&, core::Diagnostics&)> physics_check(const PhysicsWorld& world) {
  return [world](const Behavior& behavior, core::Diagnostics& diagnostics) {
    try {
      check_physics(behavior, diagnostics, world);
    } catch (const std::exception& error) {
      diagnostics.error({diagnostics.add_file(behavior.robot.path), 0, 0}, "model", error.what());
    }
  };
}

struct EditedValues::Impl {
  Impl(const Behavior& of, const PhysicsWorld& in)
      : behavior(of),
        world(in),
        model(behavior.robot, deviation_of(world)),
        law(behavior, model),
        postures(physics_postures(behavior.robot, model, world)) {
    const auto weighted = [](const AxisSpec& axis) { return axis.weight >= 0; };
    all = !behavior.internals.empty() || std::ranges::any_of(behavior.axes, weighted);
    const auto computed = [](const AxisSpec& axis) {
      return std::ranges::any_of(axis.computed, [](int gain) { return gain >= 0; });
    };
    gains = std::ranges::any_of(behavior.axes, computed);
    for (const AxisSpec& axis : behavior.axes) note_reference(axis.value);
    for (const WaypointSpec& point : behavior.waypoints) {
      for (const int to : point.to) note_reference(to);
    }
  }
  void note_reference(int expression) {
    if (expression < 0) return;
    for (const int parameter : dependence_of(behavior, expression).parameters) {
      in_references.insert(parameter);
    }
  }
  // Whether the values differ from the behavior's own in a parameter of a kind: else what only
  // depends on those was judged before the run.
  template <class Kind>
  bool changed(std::span<const double> values, const Kind& kind) const {
    for (std::size_t p = 0; p < behavior.parameters.size(); ++p) {
      const ParameterInfo& info = behavior.parameters[p];
      if (!kind(static_cast<int>(p))) continue;
      for (int k = info.slot; k < info.slot + info.size; ++k) {
        if (values[at(k)] != original[at(k)]) return true;
      }
    }
    return false;
  }
  Behavior behavior;
  PhysicsWorld world;
  model::ControlModel model;
  PhysicsLaw law;
  std::vector<model::State> postures;
  std::vector<double> original = behavior.values;
  bool all = false;    // whether ranks and forces may depend on values
  bool gains = false;  // whether gains may depend on parameters
  std::set<int> in_references;
};

EditedValues::EditedValues(const Behavior& behavior, const PhysicsWorld& world)
    : impl_(behavior.has_robot ? std::make_unique<Impl>(behavior, world) : nullptr) {}
EditedValues::~EditedValues() = default;

std::vector<core::Diagnostic> EditedValues::errors(std::span<const double> values) {
  if (impl_ == nullptr) return {};
  Impl& m = *impl_;
  const auto is_gain = [&m](int p) { return m.behavior.parameters[at(p)].gain; };
  const bool gains = m.gains || m.changed(values, is_gain);
  const bool references = m.changed(values, [&m](int p) { return m.in_references.contains(p); });
  m.behavior.values.assign(values.begin(), values.end());
  PhysicsFindings findings;
  PhysicsContext context = {m.behavior, m.model, m.law, m.postures, findings, m.world};
  if (m.all) check_configurations(context);
  if (references) check_references(context);
  if (gains) check_gains(context);
  if (gains) check_torque_loops(context);
  check_force_feedback(context);
  check_planners(context);
  core::Diagnostics diagnostics;
  for (const BadTime& time : bad_times(m.behavior)) {
    diagnostics.error(
        time.use->mark, "out-of-range",
        fmt::format("a time in state '{}' {}", m.behavior.states[at(time.use->state)].path,
                    bad_time_text(time)));
  }
  findings.report(diagnostics);
  std::vector<core::Diagnostic> errors;
  for (const core::Diagnostic& item : diagnostics.all()) {
    if (item.severity == core::Severity::error) errors.push_back(item);
  }
  return errors;
}

}  // namespace footfall::behaviors
