// The simulated world of a `world: 1` file: ground, actuators, imperfections, and the physics
// engine's settings. Load time only; the MuJoCo backend builds its scene from it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "model/aids/springs.h"
#include "model/control_model.h"
#include "model/height_surface.h"
#include "model/variation/variation.h"
#include "sim/world/actuators.h"
#include "sim/world/by_joint.h"
#include "sim/world/ground.h"
#include "sim/world/sensors.h"

namespace footfall::sim {

enum class Integrator { euler, rk4, implicit };
enum class Solver { newton, cg, pgs };
enum class Cone { elliptic, pyramidal };

// MuJoCo's settings, on which all results depend.
struct PhysicsSettings {
  int steps_per_tick = 2;  // `timestep_divisor`: at 1500 Hz a physics step is 1/3000 s
  Integrator integrator = Integrator::euler;
  Solver solver = Solver::newton;
  Cone cone = Cone::elliptic;
  double impratio = 10.0;
  int iterations = 100;     // maximum number of solver iterations
  double tolerance = 1e-8;  // of the solver
  // Contact time constant (s) and damping ratio. 1 ms is three physics steps: a softer ground lags
  // behind changing forces so much that task accelerations miss their command by 0.03 rad/s^2.
  std::array<double, 2> solref{0.001, 1.0};
  std::array<double, 3> solimp{0.95, 0.99, 0.001};  // contact impedance: d0, dwidth, width (m)
  // rad/s, natural frequency of held bodies: critically damped for the mass of the whole robot,
  // whose weight displaces it by g/w^2 = 4 mm.
  double hands = 50.0;
};

// What holds the robot where there is no physics (`--backend stub`): each joint is an inertia on a
// spring to its start.
struct StandSettings {
  double inertia = 0.1;       // kg m^2, of every joint
  double stiffness = 2000.0;  // N m/rad; with 100 N m a joint turns by 3 deg
  double damping = 20.0;      // N m s/rad
  double swing = 0.28;        // s, from a foot's release to its touchdown
};

// How a run begins beside the nominal posture at rest.
struct StartOffsets {
  std::vector<double> joints;        // rad, by joint of the robot file; empty: 0
  std::array<double, 2> velocity{};  // m/s, of the base, x and y
  std::array<double, 3> rates{};     // rad/s, of the base, about its axes
};

// The default values describe the default world: flat ground, friction 0.9, ideal actuators and
// sensors, planner latency 2 ms.
struct WorldDescription {
  std::string name = "flat";
  std::string doc;
  std::string path;  // empty for the default
  double friction = 0.9;
  double height_error = 0.0;  // m, largest: the ground's height is drawn anew for every step
  std::vector<TerrainBox> terrain;
  TerrainBelief belief = TerrainBelief::exact;  // what control_model.terrain was made by
  model::HeightSurface surface;                 // nominal CoM height follows this surface
  ActuatorSettings actuators;
  SensorSettings sensors;
  std::uint64_t noise_seed = 0;         // of the sensors' errors and of the ground's height
  model::ModelDeviation control_model;  // model errors: `mass: "+5 %"` is mass_scale 1.05; terrain
  std::vector<model::NamedLink> links;  // of its `com` and its constraints
  std::vector<model::BodySprings> constraints;
  ByJoint start_joints;           // rad, beside the robot's posture
  double start_height = 0.0;      // m, of the lowest foot above the ground
  ByJoint axis_tilts;             // rad, each joint's frame about its z, in the simulation only
  double planner_latency = 2e-3;  // s, between planner request and plan, in lock-step
  model::Variation variation;     // what a seed draws
  StartOffsets start;             // what was drawn
  PhysicsSettings physics;
  StandSettings stand;
};

// Search folders for `base: NAME`: sim/worlds in each folder of `search`.
std::vector<std::string> world_folders(const std::vector<std::string>& search);

// Values over those of a world's file, by dotted key: {"actuators.coulomb", "2 Nm"}.
using WorldSettings = std::vector<std::pair<std::string, std::string>>;

// Loads a world file. Problems are added to diagnostics, those of a setting at `--set world.KEY`;
// the result is valid only without errors. `search`: folders of sim/worlds/NAME.yaml, after those
// of the file and above it.
WorldDescription load_world(const std::string& path, core::Diagnostics& diagnostics,
                            const std::vector<std::string>& search = {},
                            const WorldSettings& settings = {});

// The world of one run: friction, start, control model and delay as drawn, noise of the same seed.
WorldDescription with_draw(WorldDescription world, const model::Draw& drawn);

// Reports everything that a world asks for and this simulator does not support (id "unsupported"),
// so that nothing in a file is ignored silently.
void check_supported(const WorldDescription& world, core::Diagnostics& diagnostics);

// Angles of a robot's joints beside its posture, in which it starts before anything is drawn;
// reports joints that it does not have.
std::vector<double> start_joints(const ByJoint& given, const model::RobotDescription& robot,
                                 core::Diagnostics& diagnostics);

// The tilts of a robot's joints; reports joints that it does not have.
std::vector<double> axis_tilts(const WorldDescription& world, const model::RobotDescription& robot,
                               core::Diagnostics& diagnostics);

// Reports what actuators need and the robot lacks, what its drives cannot be simulated with, and
// draws of actuators that are ideal.
void check_actuators(const WorldDescription& world, const model::RobotDescription& robot,
                     core::Diagnostics& diagnostics);

// Reports links named by the world that a robot does not have; `bodies`: names of its model's.
void check_links(const WorldDescription& world, const std::vector<std::string>& bodies,
                 core::Diagnostics& diagnostics);

// Finds a world by name: NAME itself if it is a file, else DIR/sim/worlds/NAME.yaml for each folder
// of `search` in turn; empty if not found.
std::string find_world_file(const std::string& name, const std::vector<std::string>& search);

}  // namespace footfall::sim
