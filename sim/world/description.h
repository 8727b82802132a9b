// The world a robot is put into, as its `world: 1` file says: ground, actuators, imperfections,
// and the physics engine's settings. Load time only; the MuJoCo backend builds its scene from it.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "model/control_model.h"
#include "model/height_surface.h"

namespace footfall::sim {

// A box standing on the ground plane, axis-parallel.
struct TerrainBox {
  std::array<double, 2> at{};    // m, centre in the world's x y
  std::array<double, 3> size{};  // m, full length, width, height above the plane
  core::Mark mark;
};

enum class ActuatorModel { ideal, series_elastic };

struct ActuatorSettings {
  ActuatorModel model = ActuatorModel::ideal;
  double command_delay = 0.0;  // s, from the tick's write to the torque
  double coulomb = 0.0;        // N m, friction of every joint
  core::Mark mark;             // of the section; likewise below
  core::Mark coulomb_mark;
};

// What the sensors add to the truth; 0 is perfect. `marks` has the place of every key that was
// written, by dotted name ("gyro.noise").
struct SensorSettings {
  double joint_resolution = 0.0;  // rad
  double gyro_noise = 0.0;        // rad/s, standard deviation
  double gyro_bias = 0.0;         // rad/s
  double mocap_rate = 0.0;        // Hz, 0: every tick
  double mocap_delay = 0.0;       // s
  double mocap_noise = 0.0;       // m, standard deviation
  double mocap_occlusion = 0.0;   // probability of a marker being hidden, 0..1
  double switch_delay = 0.0;      // s
  double switch_threshold = 0.0;  // N
  std::vector<std::pair<std::string, core::Mark>> marks;
};

enum class Integrator { euler, rk4, implicit };
enum class Solver { newton, cg, pgs };
enum class Cone { elliptic, pyramidal };

// MuJoCo's settings behind every figure.
struct PhysicsSettings {
  int steps_per_tick = 2;  // `timestep_divisor`: at 1500 Hz a physics step is 1/3000 s
  Integrator integrator = Integrator::euler;
  Solver solver = Solver::newton;
  Cone cone = Cone::elliptic;
  double impratio = 10.0;
  int iterations = 100;     // of the solver, at most
  double tolerance = 1e-8;  // of the solver
  // Contact time constant (s) and damping ratio. 1 ms is three physics steps: a softer ground lags
  // behind changing forces so much that task accelerations miss their command by 0.03 rad/s^2.
  std::array<double, 2> solref{0.001, 1.0};
  std::array<double, 3> solimp{0.95, 0.99, 0.001};  // contact impedance: d0, dwidth, width (m)
  // rad/s, of people's hands that hold: critically damped for the mass of the whole robot, whose
  // weight moves them by g/w^2: 4 mm.
  double hands = 50.0;
};

// A named external aid (a boom, a planarizer): none unless the world names it.
struct ConstraintName {
  std::string name;
  core::Mark mark;
};

// The default is the world when none is given: flat ground, friction 0.9, ideal actuators and
// sensors, a plan arrives 2 ms after it was asked for.
struct WorldDescription {
  std::string name = "flat";
  std::string doc;
  std::string path;  // empty for the default
  double friction = 0.9;
  std::vector<TerrainBox> terrain;
  model::HeightSurface surface;  // that the CoM's height is to follow
  ActuatorSettings actuators;
  SensorSettings sensors;
  model::ModelDeviation control_model;  // what the controller believes, against the truth:
                                        // `mass: "+5 %"` is mass_scale 1.05
  std::vector<ConstraintName> constraints;
  double planner_latency = 2e-3;  // s, in lock-step
  double start_velocity =
      0.0;  // m/s, standard deviation of the base's horizontal velocity at start
  PhysicsSettings physics;
};

// Loads a world file. Problems go to diagnostics; the result is meaningful only without errors.
WorldDescription load_world(const std::string& path, core::Diagnostics& diagnostics);

// Reports, each at its place, what a world asks for and this simulator cannot do yet (id
// "unsupported"): nothing a file says is ignored in silence.
void check_supported(const WorldDescription& world, core::Diagnostics& diagnostics);

// Where a world is found by name: NAME itself if it is a file, else DIR/sim/worlds/NAME.yaml for
// each folder of `search` in turn; empty if nowhere.
std::string find_world_file(const std::string& name, const std::vector<std::string>& search);

}  // namespace footfall::sim
