// MJCF text of a world; see scene.h.
#include "sim/scene.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "sim/footholds.h"

namespace footfall::sim {
namespace {

const char* integrator_name(Integrator i) {
  switch (i) {
    case Integrator::euler:
      return "Euler";
    case Integrator::rk4:
      return "RK4";
    case Integrator::implicit:
      return "implicit";
  }
  return "Euler";
}

const char* solver_name(Solver s) {
  switch (s) {
    case Solver::newton:
      return "Newton";
    case Solver::cg:
      return "CG";
    case Solver::pgs:
      return "PGS";
  }
  return "Newton";
}

// The ground's friction must apply: with equal priority MuJoCo takes the larger one of a pair. All
// that defaults of the robot's file could change is written out.
std::string contact_attributes(const WorldDescription& world, int group = 0) {
  const PhysicsSettings& p = world.physics;
  return fmt::format(
      "contype=\"1\" conaffinity=\"1\" margin=\"0\" gap=\"0\" group=\"{}\" "
      "priority=\"1\" condim=\"3\" friction=\"{:.17g} 0 0\" solref=\"{:.17g} {:.17g}\" "
      "solimp=\"{:.17g} {:.17g} {:.17g}\"",
      group, world.friction, p.solref[0], p.solref[1], p.solimp[0], p.solimp[1], p.solimp[2]);
}

std::string plane_xml(const std::string& name, const std::string& attributes) {
  return fmt::format(
      "<geom name=\"{}\" type=\"plane\" pos=\"0 0 0\" quat=\"1 0 0 0\" size=\"0 0 .5\" {}/>\n",
      name, attributes);
}

// The unit quaternion (w x y z) of Rz(yaw) Ry(pitch) Rx(roll).
std::array<double, 4> quaternion_of(const std::array<double, 3>& turn) {
  const double cr = std::cos(0.5 * turn[0]), sr = std::sin(0.5 * turn[0]);
  const double cp = std::cos(0.5 * turn[1]), sp = std::sin(0.5 * turn[1]);
  const double cy = std::cos(0.5 * turn[2]), sy = std::sin(0.5 * turn[2]);
  return {cr * cp * cy + sr * sp * sy, sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy,
          cr * cp * sy - sr * sp * cy};
}

std::string box_xml(const std::string& name, const TerrainBox& box, const std::string& attributes) {
  const model::TerrainPiece piece = piece_of(box);
  const std::array<double, 4> q = quaternion_of(box.turn);
  return fmt::format(
      "<geom name=\"{}\" type=\"box\" quat=\"{:.17g} {:.17g} {:.17g} {:.17g}\" "
      "pos=\"{:.17g} {:.17g} {:.17g}\" size=\"{:.17g} {:.17g} {:.17g}\" {}/>\n",
      name, q[0], q[1], q[2], q[3], piece.centre[0], piece.centre[1], piece.centre[2],
      piece.half[0], piece.half[1], piece.half[2], attributes);
}

std::string terrain_xml(const WorldDescription& world) {
  std::string xml;
  int index = 0;
  for (const TerrainBox& box : world.terrain) {
    xml += box_xml(fmt::format("terrain_{}", index++), box, contact_attributes(world));
  }
  return xml;
}

// Of Footholds; a group that is not drawn.
std::string footholds_xml(const model::RobotDescription& robot, const WorldDescription& world) {
  if (!(world.height_error > 0.0)) return {};
  constexpr int kHidden = 5;
  const std::string attributes = contact_attributes(world, kHidden);
  std::string xml;
  for (std::size_t c = 0; c < robot.contacts.size(); ++c) {
    xml += plane_xml(foothold_name(c, 0), attributes);
    for (std::size_t k = 0; k < world.terrain.size(); ++k) {
      xml += box_xml(foothold_name(c, k + 1), world.terrain[k], attributes);
    }
  }
  return xml;
}

}  // namespace

std::string scene_xml(const model::RobotDescription& robot, const WorldDescription& world) {
  const PhysicsSettings& p = world.physics;
  const double timestep = robot.period_s() / p.steps_per_tick;
  std::string xml = "<mujoco model=\"footfall\">\n";
  xml += "<compiler discardvisual=\"true\"/>\n";
  xml += fmt::format("<include file=\"{}\"/>\n", robot.model_path);
  // Behind the robot's file: what is written last applies.
  xml += fmt::format(
      "<option timestep=\"{:.17g}\" integrator=\"{}\" solver=\"{}\" cone=\"{}\" "
      "impratio=\"{:.17g}\" iterations=\"{}\" tolerance=\"{:.17g}\"/>\n",
      timestep, integrator_name(p.integrator), solver_name(p.solver),
      p.cone == Cone::elliptic ? "elliptic" : "pyramidal", p.impratio, p.iterations, p.tolerance);
  xml += "<size njmax=\"-1\" nconmax=\"-1\" nstack=\"-1\"/>\n";
  xml += "<worldbody>\n";
  xml += plane_xml("ground", contact_attributes(world));
  xml += terrain_xml(world) + footholds_xml(robot, world);
  xml += "</worldbody>\n</mujoco>\n";
  return xml;
}

}  // namespace footfall::sim
