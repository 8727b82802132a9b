// Forces that the simulator has and A q̈ + b + g = τ has not: springs, dampers, friction, stops,
// tendons, equality constraints.
#include <fmt/format.h>

#include <array>

#include "core/index.h"
#include "model/check/context.h"

namespace footfall::model {
namespace {

void check_forces(ModelContext& c, int j) {
  const mjModel& m = c.m;
  const int dof = m.jnt_dofadr[j];
  const bool base = m.jnt_type[j] == mjJNT_FREE;
  const std::string joint = base ? "the floating base" : "joint " + c.name(mjOBJ_JOINT, j);
  const auto tell = [&](double value, const char* attribute, const char* what) {
    if (value == 0.0) return;
    c.warn(c.place(mjOBJ_JOINT, j, attribute),
           fmt::format("{} has {} {:g}, which acts in the simulator only: the control model has no "
                       "passive forces, so tasks lag or the robot falls; expected 0",
                       joint, what, value));
  };
  tell(m.jnt_stiffness[j], "stiffness", "a spring of stiffness");
  tell(m.dof_damping[dof], "damping", "damping");
  tell(m.dof_frictionloss[dof], "frictionloss", "dry friction");
  if (base && m.dof_armature[dof] != 0.0) {
    c.refuse(c.place(mjOBJ_JOINT, j, "armature"),
             fmt::format("the floating base has armature {:g}, an inertia without a mass: the "
                         "control model's centre of mass would be wrong; expected 0",
                         m.dof_armature[dof]));
  }
}

void check_stop(ModelContext& c, int j) {
  const mjModel& m = c.m;
  const JointDescription* const joint = c.joint(j);
  if (joint == nullptr || m.jnt_limited[j] == 0) return;
  const double* const range = m.jnt_range + 2 * j;
  constexpr double kSame = 1e-6;  // rad; rounding of degrees written with few digits
  if (range[0] > joint->position_min + kSame || range[1] < joint->position_max - kSame) {
    c.warn(c.place(mjOBJ_JOINT, j, "range"),
           fmt::format("joint '{}' stops at {:.4g} and {:.4g} deg in the simulator, inside the "
                       "robot file's {:.4g} to {:.4g} deg: the control model has no stops",
                       joint->name, degrees(range[0]), degrees(range[1]),
                       degrees(joint->position_min), degrees(joint->position_max)));
  }
  if (m.jnt_margin[j] > 0.0) {
    c.warn(c.place(mjOBJ_JOINT, j, "margin"),
           fmt::format("the stops of joint '{}' act {:.3g} deg before its limits (margin), in the "
                       "simulator only; expected 0",
                       joint->name, degrees(m.jnt_margin[j])));
  }
  const double* const solref = m.jnt_solref + mjNREF * j;
  if (solref[0] != 0.02 || solref[1] != 1.0) {  // MuJoCo's defaults
    c.warn(c.place(mjOBJ_JOINT, j, "solreflimit"),
           fmt::format("the stops of joint '{}' are of another stiffness than MuJoCo's own "
                       "(solreflimit), in the simulator only",
                       joint->name));
  }
}

void check_tendon(ModelContext& c, int t) {
  const mjModel& m = c.m;
  const char* attribute = nullptr;
  if (m.tendon_limited[t] != 0) attribute = "range";
  if (m.tendon_frictionloss[t] != 0.0) attribute = "frictionloss";
  if (m.tendon_damping[t] != 0.0) attribute = "damping";
  if (m.tendon_stiffness[t] != 0.0) attribute = "stiffness";
  if (attribute == nullptr) return;
  c.refuse(c.place(mjOBJ_TENDON, t, attribute),
           fmt::format("tendon {} pulls in the simulator ({}), and the control model has no "
                       "tendons; expected none",
                       c.name(mjOBJ_TENDON, t), attribute));
}

}  // namespace

void check_passive(ModelContext& c) {
  for (int j = 0; j < c.m.njnt; ++j) {
    check_forces(c, j);
    check_stop(c, j);
  }
  for (int t = 0; t < c.m.ntendon; ++t) check_tendon(c, t);
  for (int e = 0; e < c.m.neq; ++e) {
    if (c.m.eq_active[e] == 0) continue;
    c.refuse(c.place(mjOBJ_EQUALITY, e),
             "an equality constraint acts in the simulator, and the control model has none: its "
             "torques would fight it; expected no <equality>");
  }
}

}  // namespace footfall::model
