// All physics checks of one behavior; see check.h.
#include "behaviors/check/physics/check.h"

#include <fmt/format.h>

#include <set>

#include "behaviors/check/physics/configurations.h"
#include "behaviors/check/physics/parts.h"
#include "behaviors/check/physics/postures.h"
#include "core/index.h"
#include "model/check/check.h"

namespace footfall::behaviors {
namespace {

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
    out.insert(out.end(),
               {-2, internal.instance, internal.contact_a, internal.contact_b, internal.reference});
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

}  // namespace

void check_physics(const Behavior& behavior, core::Diagnostics& diagnostics,
                   const PhysicsWorld& world) {
  if (!behavior.has_robot) return;
  if (!model::check_model(behavior.robot, diagnostics)) return;
  model::ControlModel model(behavior.robot);
  PhysicsLaw law(behavior, model);
  const std::vector<model::State> postures = physics_postures(behavior.robot);
  PhysicsFindings findings;
  PhysicsContext context = {behavior, model, law, postures, findings, world};
  std::set<std::vector<int>> judged;
  for (const auto& [index, state] : controlling_states(behavior)) {
    const ControlSpec& control = behavior.controls[at(index)];
    if (!judged.insert(signature(behavior, control)).second) continue;
    if (judged.size() > kMaxJudged) {
      diagnostics.warning(behavior.states.front().mark, "too-many",
                          fmt::format("physics is judged in the first {} different configurations, "
                                      "and not in the others",
                                      kMaxJudged));
      break;
    }
    check_contact_types(behavior, control, findings);
    for (const model::State& posture : postures) {
      model.update(posture);
      check_ranks(context, control, behavior.states[at(state)].mark);
    }
    findings.settle(static_cast<int>(postures.size()));
    check_internal_forces(context, control);
  }
  check_references(context);
  check_feed_forward(context);
  check_gains(context);
  check_force_feedback(context);
  check_planners(context);
  check_torque_steps(context);
  findings.report(diagnostics);
}

}  // namespace footfall::behaviors
