// The law of external aids: one-body springs of worlds and holds. MuJoCo would integrate a weld or
// a tendon implicitly, but only aids known when the model is compiled, and not axis by axis.
#pragma once

#include <array>

#include "model/aids/springs.h"

struct mjModel_;
struct mjData_;

namespace footfall::sim {

struct ActiveAxis {
  bool acts = false;
  bool one_sided = false;    // with travel
  bool per_inertia = false;  // stiffness and damping are per mass or inertia: 1/s^2, 1/s
  double stiffness = 0.0;
  double damping = 0.0;
  double anchor = 0.0;           // m, of x y z
  double low = 0.0, high = 0.0;  // travel from the anchor
};

struct ActiveRope {
  bool acts = false;
  std::array<double, 3> to{}, from{};  // m, world; the body's frame
  double length = 0.0, stiffness = 0.0, damping = 0.0;
};

struct ActiveSprings {
  int body = 0;  // 0: none
  // Whether rotation has the same two-sided spring about all axes: then the torque is along the
  // rotation vector, and damping along the angular velocity.
  bool alike_turns = false;
  // A whole hold takes the state at the beginning of the last physics step, which MuJoCo has at
  // hand and which its critical damping tolerates; anything else needs the present one.
  bool present = true;
  std::array<ActiveAxis, 6> axes{};
  std::array<double, 4> orientation{};  // w x y z, anchored
  ActiveRope rope;
};

// The force of an axis; `behind`: anchor minus position; `inertia`: mass or rotational inertia for
// per_inertia. One-sided, it never points outwards: damping alone would let a rope push.
double spring_force(const ActiveAxis& axis, double inertia, double behind, double rate) noexcept;
// The pull of a rope whose ends are this far apart, m, and part with `rate`, m/s; 0 or more, N.
double rope_tension(const ActiveRope& rope, double distance, double rate) noexcept;

// Mass (of the whole robot) or rotational inertia that critical damping is for. The latter is the
// least diagonal element of what a free joint sees, of any other body its least principal one.
double mass_behind(const mjModel_& model, int body) noexcept;
double inertia_behind(const mjModel_& model, const mjData_& data, int body) noexcept;

// Anchors springs where the body is now, except for axes that say `at`. hands: rad/s.
ActiveSprings attach_springs(const mjModel_& model, const mjData_& data, int body,
                             const model::BodySprings& springs, double hands) noexcept;

// Adds force and torque to the body's external ones.
void apply_springs(const mjModel_& model, mjData_& data, const ActiveSprings& springs) noexcept;

}  // namespace footfall::sim
