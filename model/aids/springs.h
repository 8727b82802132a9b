// External aids: springs between one body of the robot and the world, each axis on its own, and
// ropes. A planarizer, a hoist and a hold differ only in their axes; a harness is a rope. Worlds
// (`constraints:`) and scenarios (`hold:`) read them here; the law is sim/springs.h.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/key_table.h"
#include "core/yaml/yaml.h"
#include "model/variation/variation.h"

namespace footfall::model {

// x y z: the body's centre of mass, world axes, m. roll pitch yaw: components along x y z of the
// rotation vector from the anchored to the present orientation, world axes, rad.
inline constexpr std::array<std::string_view, 6> kSpringAxes = {"x",    "y",     "z",
                                                                "roll", "pitch", "yaw"};
inline constexpr std::size_t kFirstAngle = 3;  // into kSpringAxes

// SI, of lengths or of angles.
struct AxisSpring {
  std::optional<double> stiffness;              // nullopt: of the world's `physics: {hands}`
  std::optional<double> damping;                // nullopt: critical
  std::optional<std::array<double, 2>> travel;  // free within; nullopt: a spring both ways
  std::optional<double> at;                     // of the anchor; nullopt: where the body is
  core::Mark mark;                              // of the stiffness, else of the axis' map
  std::string file;                             // of the mark; an overlay's values are its own
};

// A rope between a point of the body and a fixed place: a spring while it is taut, else nothing.
struct Rope {
  std::array<double, 3> to{};     // m, world
  std::array<double, 3> from{};   // m, of the body's frame
  double length = 0.0;            // m, slack
  double stiffness = 0.0;         // N/m
  std::optional<double> damping;  // N s/m; nullopt: critical for the robot's mass
  core::Mark mark;                // of the stiffness, else of the map
  std::string file;               // of the mark
};

struct BodySprings {
  std::string name;  // empty: a hold
  NamedLink body;
  std::array<std::optional<AxisSpring>, 6> axes;  // by kSpringAxes; nullopt: free
  std::optional<Rope> rope;
  // kg, of what slides along x y z of the world with the origin of the robot's floating base:
  // inertia without weight. No hold has it.
  std::array<double, 3> slides{};
  core::Mark slides_mark;
  bool known = false;  // a constraint: the controller counts on its axes
  bool all = false;    // a hold that names no axes: every axis, of a body that is no root x y z

  // Whether an axis has a stiffness or a damping of its own, which may be unstable.
  bool has_own_values() const;
};

// `constraints:` of a world; `NAME: off` was resolved before.
std::vector<BodySprings> read_constraints(const core::YamlNode& node,
                                          core::Diagnostics& diagnostics);
// `hold:` of a scenario: the name of a body, or a map; without `body`, an error.
BodySprings read_hold(const core::YamlNode& node, core::Diagnostics& diagnostics);

extern const core::KeyTable kConstraintKeys, kHoldKeys;

}  // namespace footfall::model
