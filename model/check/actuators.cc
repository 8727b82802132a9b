// Actuators: the controller writes torques in N m at the joints, and nothing else.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

#include "core/index.h"
#include "model/check/context.h"

namespace footfall::model {
namespace {

const char* transmission(int type) {
  switch (type) {
    case mjTRN_JOINTINPARENT:
      return "a joint in its parent's frame";
    case mjTRN_SLIDERCRANK:
      return "a slider and crank";
    case mjTRN_TENDON:
      return "a tendon";
    case mjTRN_SITE:
      return "a site";
    default:
      return "a body";
  }
}

bool is_motor(const mjModel& m, int a) {
  if (m.actuator_dyntype[a] != mjDYN_NONE || m.actuator_gaintype[a] != mjGAIN_FIXED) return false;
  if (m.actuator_biastype[a] == mjBIAS_NONE) return true;
  const double* const bias = m.actuator_biasprm + mjNBIAS * a;
  return m.actuator_biastype[a] == mjBIAS_AFFINE && bias[0] == 0.0 && bias[1] == 0.0 &&
         bias[2] == 0.0;
}

void check_scale(ModelContext& c, int a, const std::string& joint) {
  const mjModel& m = c.m;
  const double gear = m.actuator_gear[6 * a];
  const double gain = m.actuator_gainprm[mjNGAIN * a];
  if (gear != 1.0) {
    c.refuse(c.place(mjOBJ_ACTUATOR, a, "gear"),
             fmt::format("the actuator of joint '{0}' has gear {1:g}: the simulator would apply "
                         "{1:g} times the torque that the controller writes; expected gear 1, "
                         "limits at the joint",
                         joint, gear));
  }
  if (gain != 1.0) {
    c.refuse(c.place(mjOBJ_ACTUATOR, a, "gainprm"),
             fmt::format("the actuator of joint '{0}' has gain {1:g}: the simulator would apply "
                         "{1:g} times the torque that the controller writes; expected a <motor>",
                         joint, gain));
  }
}

void check_range(ModelContext& c, int a, const JointDescription& joint, const mjtByte* limited,
                 const mjtNum* ranges, const char* attribute) {
  const double* const range = ranges + 2 * a;
  if (limited[a] == 0 || joint.torque_limit <= 0.0) return;
  const double least = std::min(-range[0], range[1]);
  if (least >= joint.torque_limit) return;
  c.refuse(c.place(mjOBJ_ACTUATOR, a, attribute),
           fmt::format("the actuator of joint '{}' is limited to {:g} to {:g} Nm, below the robot "
                       "file's torque of {:g} Nm: the simulator would cut it without a fault",
                       joint.name, range[0], range[1], joint.torque_limit));
}

void check_actuator(ModelContext& c, int a, std::set<int>& driven) {
  const mjModel& m = c.m;
  const std::string name = c.name(mjOBJ_ACTUATOR, a);
  if (m.actuator_trntype[a] != mjTRN_JOINT) {
    c.refuse(c.place(mjOBJ_ACTUATOR, a),
             fmt::format("actuator {} acts on {}, which no torque of a joint stands for; expected "
                         "a <motor> with `joint`",
                         name, transmission(m.actuator_trntype[a])));
    return;
  }
  const int id = m.actuator_trnid[2 * a];
  const JointDescription* const joint = c.joint(id);
  if (joint == nullptr) {
    c.refuse(c.place(mjOBJ_ACTUATOR, a, "joint"),
             fmt::format("actuator {} drives a joint that the robot file does not list", name));
    return;
  }
  if (!driven.insert(id).second) {
    c.refuse(c.place(mjOBJ_ACTUATOR, a),
             fmt::format("joint '{}' has a second actuator: only one gets torques, the other acts "
                         "with a control of 0; expected one <motor>",
                         joint->name));
    return;
  }
  if (!is_motor(m, a)) {
    c.refuse(c.place(mjOBJ_ACTUATOR, a),
             fmt::format("the actuator of joint '{}' is no plain motor: it would take the "
                         "controller's torque in Nm for an angle, a speed or an activation; "
                         "expected a <motor>",
                         joint->name));
    return;
  }
  check_scale(c, a, joint->name);
  check_range(c, a, *joint, m.actuator_ctrllimited, m.actuator_ctrlrange, "ctrlrange");
  check_range(c, a, *joint, m.actuator_forcelimited, m.actuator_forcerange, "forcerange");
}

}  // namespace

void check_actuators(ModelContext& c) {
  std::set<int> driven;
  for (int a = 0; a < c.m.nu; ++a) check_actuator(c, a, driven);
  for (int j = 0; j < c.m.njnt; ++j) {
    const JointDescription* const joint = c.joint(j);
    bool any = false;
    for (int a = 0; a < c.m.nu; ++a) {
      any =
          any || (c.m.actuator_trnid[2 * a] == j && c.m.actuator_trntype[a] <= mjTRN_JOINTINPARENT);
    }
    if (joint == nullptr || any) continue;
    c.refuse(c.place(mjOBJ_JOINT, j),
             fmt::format("joint '{}' has no motor; expected <motor joint=\"{}\"/>", joint->name,
                         joint->name));
  }
}

}  // namespace footfall::model
