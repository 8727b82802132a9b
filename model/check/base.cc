// How the robot starts, and what of its file would become a part of the world.
#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "core/index.h"
#include "model/check/context.h"

namespace footfall::model {
namespace {

// The attribute that turns an element.
std::string_view turning(const ModelContext& c, int body) {
  const MjcfPlace whole = c.place(mjOBJ_BODY, body);
  for (const char* attribute : {"quat", "euler", "axisangle", "xyaxes", "zaxis"}) {
    const MjcfPlace found = c.place(mjOBJ_BODY, body, attribute);
    if (found.line != whole.line || found.column != whole.column) return attribute;
  }
  return {};
}

void check_start(ModelContext& c, int base) {
  const mjModel& m = c.m;
  const double* const q = m.body_quat + 4 * base;
  const double upright = 1.0 - 2.0 * (q[1] * q[1] + q[2] * q[2]);  // z of the base's z axis
  const double tilt = std::acos(std::min(1.0, std::max(-1.0, upright)));
  const double yaw =
      std::atan2(2.0 * (q[0] * q[3] + q[1] * q[2]), 1.0 - 2.0 * (q[2] * q[2] + q[3] * q[3]));
  constexpr double kSmall = 1e-4;  // rad; quaternions written with four digits
  if (tilt > kSmall) {
    c.refuse(c.place(mjOBJ_BODY, base, turning(c, base)),
             fmt::format("the floating base '{}' is tilted by {:.4g} deg: it would start so, and "
                         "the controller takes its z axis for up; expected an upright base (turn "
                         "the shapes inside it instead)",
                         c.robot.floating_base, degrees(tilt)));
  } else if (std::abs(yaw) > kSmall) {
    c.warn(c.place(mjOBJ_BODY, base, turning(c, base)),
           fmt::format("the floating base '{}' is turned by {:.4g} deg about the vertical: the "
                       "robot starts facing that way, while references and goals count from 0",
                       c.robot.floating_base, degrees(yaw)));
  }
  const double* const p = m.body_pos + 3 * base;
  if (std::hypot(p[0], p[1]) > 1e-6) {
    c.warn(c.place(mjOBJ_BODY, base, "pos"),
           fmt::format("the robot starts at x {:g} m, y {:g} m: goals and terrain count from the "
                       "world's origin; expected 0 0",
                       p[0], p[1]));
  }
}

}  // namespace

void check_base(ModelContext& c) {
  const mjModel& m = c.m;
  const int base = mj_name2id(&m, mjOBJ_BODY, c.robot.floating_base.c_str());
  if (base > 0) check_start(c, base);
  for (int b = 1; b < m.nbody; ++b) {
    if (m.body_mocapid[b] >= 0) {
      c.refuse(c.place(mjOBJ_BODY, b),
               fmt::format("body {} is moved from outside (mocap), and nothing moves it here; "
                           "expected the robot only",
                           c.name(mjOBJ_BODY, b)));
    } else if (m.body_weldid[b] == 0) {
      c.refuse(c.place(mjOBJ_BODY, b),
               fmt::format("body {} hangs on the world: the control model does not know what it "
                           "touches; expected the robot only, the world file has the terrain",
                           c.name(mjOBJ_BODY, b)));
    }
  }
  for (int g = 0; g < m.ngeom; ++g) {
    const char* const given = mj_id2name(&m, mjOBJ_GEOM, g);
    const std::string_view name = given == nullptr ? "" : given;
    if (m.geom_bodyid[g] == 0) {
      c.refuse(c.place(mjOBJ_GEOM, g),
               "the model brings a floor or another shape of the world: there would be two; "
               "expected the robot only, the world file has ground and terrain");
    } else if (name == "ground" || name.starts_with("terrain_")) {
      c.refuse(
          c.place(mjOBJ_GEOM, g, "name"),
          fmt::format("the name '{}' is that of a shape of the world; expected another one", name));
    }
  }
}

}  // namespace footfall::model
