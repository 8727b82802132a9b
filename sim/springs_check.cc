// Stability of external aids; see springs_check.h.
//
// Springs act as external forces, which MuJoCo holds constant over a step h. Euler (and `implicit`,
// which knows nothing of external forces) makes of m x'' = -k x - c x'
//     v+ = v - h (k x + c v)/m,   x+ = x + h v+.
// With a = h^2 k/m and b = h c/m the map (x, h v) has trace 2 - a - b and determinant 1 - b. Its
// eigenvalues are within the unit circle iff |det| < 1 and |trace| < 1 + det:
//     a + 2 b < 4,   that is   h^2 k + 2 h c < 4 m
// (b = 0: on the circle, energy is bounded). With rk4 the force is constant over the step, too:
//     v+ = v + h f/m,  x+ = x + h v + h^2 f/(2 m):  stable iff  a/2 < b < 2,
// so that there a spring needs a damping c > h k/2.
//
// For several springs K and C are matrices, M the inertia of the robot. An eigenvector of the
// recursion has the Rayleigh quotients k, c, m, hence h^2 K + 2 h C < 4 M suffices. The kinetic
// energy is at least that of the body alone: M of the robot, in every posture and in every contact,
// is at least mass and inertia of this body, about its centre of mass, where the springs act. So
// the bounds are of the body alone, for the sum of all springs on an axis; for rotation the least
// principal inertia. Where rotation has not the same spring about all axes, the matrix J of
// sim/springs.cc, whose norm is (t/2)/sin(t/2) <= pi/2, makes up to (pi/2)^2 of K and C.
#include "sim/springs_check.h"

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "model/mjcf.h"
#include "sim/scene.h"
#include "sim/springs.h"

namespace footfall::sim {
namespace {

struct AxisSum {
  double stiffness = 0.0, damping = 0.0;
};
using Sums = std::map<std::pair<int, std::size_t>, AxisSum>;  // by body and axis

class SpringsCheck {
 public:
  SpringsCheck(const WorldDescription& world, const model::RobotDescription& robot,
               core::Diagnostics& diagnostics)
      : world_(world),
        model_(model::compile_mjcf(scene_xml(robot, world), robot.model_path), mj_deleteModel),
        data_(mj_makeData(model_.get()), mj_deleteData),
        diagnostics_(diagnostics) {
    for (const model::JointDescription& joint : robot.joints) {
      const int id = mj_name2id(model_.get(), mjOBJ_JOINT, joint.name.c_str());
      if (id >= 0) data_->qpos[model_->jnt_qposadr[id]] = joint.posture;
    }
    mj_forward(model_.get(), data_.get());
  }

  void add(const model::BodySprings& aid, Sums& sums) {
    const int body = mj_name2id(model_.get(), mjOBJ_BODY, aid.body.name.c_str());
    if (body <= 0) return;
    const ActiveSprings springs = attach_springs(*model_, *data_, body, aid, world_.physics.hands);
    if (aid.rope) judge_rope(aid, springs.rope, body);
    for (std::size_t k = 0; k < springs.axes.size(); ++k) {
      const ActiveAxis& axis = springs.axes[k];
      if (!axis.acts) continue;
      const bool line = k < model::kFirstAngle;
      const double behind =
          line ? mass_behind(*model_, body) : inertia_behind(*model_, *data_, body);
      const double scale = axis.per_inertia ? behind : 1.0;
      AxisSum& sum = sums[{body, k}];
      const AxisSum before = sum;
      sum.stiffness += scale * axis.stiffness;
      sum.damping += scale * axis.damping;
      const auto& own = aid.axes[k];
      if (own && (own->stiffness || own->damping)) {
        judge(aid, k, before, sum, least_inertia(body, line, springs.alike_turns), behind);
      }
    }
  }

 private:
  // What the bounds are of: the body's own mass or inertia, less where J may enlarge the springs.
  double least_inertia(int body, bool line, bool alike_turns) const {
    if (line) return model_->body_mass[body];
    const double* inertia = model_->body_inertia + 3 * body;
    constexpr double kMostOfJ = std::numbers::pi * std::numbers::pi / 4.0;
    return std::min({inertia[0], inertia[1], inertia[2]}) / (alike_turns ? 1.0 : kMostOfJ);
  }

  // A pull at an arm r from the body's CoM meets at least the mass 1/(1/m + r^2/I), I the least
  // principal inertia.
  void judge_rope(const model::BodySprings& aid, const ActiveRope& rope, int body) {
    double arm = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double r = rope.from[k] - model_->body_ipos[3 * body + static_cast<int>(k)];
      arm += r * r;
    }
    const double* inertia = model_->body_inertia + 3 * body;
    const double least = std::min({inertia[0], inertia[1], inertia[2]});
    const double mass = 1.0 / (1.0 / model_->body_mass[body] + arm / least);
    const double h = model_->opt.timestep;
    const bool rk4 = world_.physics.integrator == Integrator::rk4;
    const bool stable =
        rk4 ? h * rope.damping < 2.0 * mass && 2.0 * rope.damping > h * rope.stiffness
            : h * h * rope.stiffness + 2.0 * h * rope.damping < 4.0 * mass;
    if (stable) return;
    core::Mark mark = aid.rope->mark;
    mark.file = diagnostics_.add_file(aid.rope->file);
    diagnostics_.error(
        mark, "out-of-range",
        fmt::format("the physics step of 1/{:.0f} s does not integrate the rope of '{}' stably: "
                    "{:.3g} N/m and {:.3g} N s/m on {:.3g} kg, as its arm has it",
                    1.0 / h, aid.body.name, rope.stiffness, rope.damping, mass));
  }

  void judge(const model::BodySprings& aid, std::size_t k, const AxisSum& before,
             const AxisSum& sum, double inertia, double behind) {
    const model::AxisSpring& spring = *aid.axes[k];
    const double h = model_->opt.timestep;
    const bool rk4 = world_.physics.integrator == Integrator::rk4;
    const double most_damping = 2.0 * inertia / h - before.damping;
    double most = 0.0;  // stiffness
    bool stable = false;
    if (rk4) {
      most = sum.damping < 2.0 * inertia / h ? 2.0 * sum.damping / h - before.stiffness : 0.0;
      stable = sum.damping < 2.0 * inertia / h && 2.0 * sum.damping > h * sum.stiffness;
    } else {
      const double room = 4.0 * inertia - h * h * before.stiffness - 2.0 * h * before.damping;
      stable = h * h * sum.stiffness + 2.0 * h * sum.damping < 4.0 * inertia;
      if (spring.damping) {
        most = (room - 2.0 * h * *spring.damping) / (h * h);
      } else if (room > 0.0) {  // h^2 k + 4 h sqrt(k behind) = room
        const double root = (std::sqrt(4.0 * behind + room) - 2.0 * std::sqrt(behind)) / h;
        most = root * root;
      }
    }
    if (!stable) report(aid, k, most, most_damping);
  }

  void report(const model::BodySprings& aid, std::size_t k, double most, double most_damping) {
    const bool line = k < model::kFirstAngle;
    const char* const stiffness = line ? "N/m" : "Nm/rad";
    const char* const damping = line ? "N s/m" : "Nm s/rad";
    const std::string bound = most > 0.0
                                  ? fmt::format("stiffness below {:.3g} {}", most, stiffness)
                                  : fmt::format("damping below {:.3g} {}", most_damping, damping);
    core::Mark mark = aid.axes[k]->mark;
    mark.file = diagnostics_.add_file(aid.axes[k]->file);
    diagnostics_.error(
        mark, "out-of-range",
        fmt::format("the physics step of 1/{:.0f} s integrates the spring '{}' of "
                    "'{}' stably only with {}",
                    1.0 / model_->opt.timestep, model::kSpringAxes[k], aid.body.name, bound));
  }

  const WorldDescription& world_;
  std::unique_ptr<mjModel, void (*)(mjModel*)> model_;
  std::unique_ptr<mjData, void (*)(mjData*)> data_;
  core::Diagnostics& diagnostics_;
};

}  // namespace

void check_springs(const WorldDescription& world, const std::vector<model::BodySprings>& holds,
                   const model::RobotDescription& robot, core::Diagnostics& diagnostics) {
  const bool own_holds = std::ranges::any_of(holds, &model::BodySprings::has_own_values);
  if (world.constraints.empty() && !own_holds) return;  // spares compiling the model
  SpringsCheck check(world, robot, diagnostics);
  Sums sums;
  for (const model::BodySprings& aid : world.constraints) {
    check.add(aid, sums);
    const bool slides = aid.slides != std::array<double, 3>{};
    if (!slides || aid.body.name.empty() || aid.body.name == robot.floating_base) continue;
    core::Mark mark = aid.slides_mark;
    mark.file = diagnostics.add_file(aid.body.file);
    diagnostics.error(mark, "unsupported",
                      fmt::format("'slides' acts on the robot's floating base alone: expected "
                                  "'body: {}', got '{}'",
                                  robot.floating_base, aid.body.name));
  }
  for (const model::BodySprings& hold : holds) {
    if (!hold.has_own_values()) continue;
    Sums with = sums;
    check.add(hold, with);
  }
}

}  // namespace footfall::sim
