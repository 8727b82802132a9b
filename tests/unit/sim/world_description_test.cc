// World files: a whole one, the default, each mistake at its place, and nothing ignored in silence.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "sim/world/description.h"

namespace footfall::sim {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

constexpr std::string_view kWorld = R"(world: 1
name: lab
doc: "All that a world can say."
ground: {friction: 0.7, terrain: [{box: {at: [0.8 m, 0 m], size: [0.6 m, 1.5 m, 7 cm]}}]}
surface: {ramps: [{from: 0.1 m, to: 0.5 m, rise: 7 cm}, {from: 1.1 m, to: 1.5 m, rise: -7 cm}]}
actuators: {model: series_elastic, command_delay: 667 us, coulomb: 1 Nm}
sensors:
  joint: {resolution: 3.8e-4 rad}
  gyro: {noise: 0.01 rad/s, bias: 0.25 deg/s}
  mocap: {rate: 480 Hz, delay: 5 ms, noise: 1 mm, occlusion: 5 %}
  switch: {delay: 2 ms, threshold: 20 N}
control_model: {mass: "+5 %", com: {torso: [1 cm, 0 m, 0 m]}}
constraints: {planarizer: {body: torso, y: {stiffness: 20000 N/m}}}
planner_latency: 5 ms
physics:
  {timestep_divisor: 4, integrator: implicit, solver: pgs, cone: pyramidal, impratio: 1,
   iterations: 50, tolerance: 1e-6, solref: [10 ms, 1], solimp: [0.9, 0.95, 1 mm]}
)";

class WorldDescriptionTest : public testing::Test {
 protected:
  WorldDescriptionTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
  }
  ~WorldDescriptionTest() override { std::filesystem::remove_all(folder_); }

  WorldDescription load(std::string_view text) {
    std::ofstream(path()) << text;
    diagnostics_ = {};
    return load_world(path(), diagnostics_);
  }
  std::string path() const { return (folder_ / "lab.yaml").string(); }

  // The problems so far, without the path before the line.
  std::string problems() const {
    std::string out = diagnostics_.to_string();
    for (std::size_t i = out.find(path()); i != std::string::npos; i = out.find(path())) {
      out.erase(i, path().size() + 1);
    }
    return out;
  }
  std::string problems_of(std::string_view text) {
    load(text);
    return problems();
  }

  std::filesystem::path folder_;
  core::Diagnostics diagnostics_;
};

TEST_F(WorldDescriptionTest, AWholeFileIsRead) {
  const WorldDescription world = load(kWorld);
  ASSERT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(world.name, "lab");
  EXPECT_EQ(world.friction, 0.7);
  ASSERT_EQ(world.terrain.size(), 1u);
  EXPECT_EQ(world.terrain[0].at, (std::array<double, 2>{0.8, 0.0}));
  EXPECT_EQ(world.terrain[0].size, (std::array<double, 3>{0.6, 1.5, 0.07}));
  ASSERT_EQ(world.surface.ramps.size(), 2u);
  EXPECT_EQ(world.surface.ramps[1].rise, -0.07);
  EXPECT_EQ(world.actuators.model, ActuatorModel::series_elastic);
  EXPECT_DOUBLE_EQ(world.actuators.command_delay, 667e-6);
  EXPECT_EQ(world.actuators.coulomb, 1.0);
  EXPECT_EQ(world.sensors.errors.joint_resolution, 3.8e-4);
  EXPECT_DOUBLE_EQ(world.sensors.errors.imu.gyro.bias, 0.25 * kDegree);
  EXPECT_EQ(world.sensors.errors.mocap.rate, 480);
  EXPECT_DOUBLE_EQ(world.sensors.errors.mocap.occlusion, 0.05);
  EXPECT_EQ(world.sensors.errors.switches.threshold, 20);
  EXPECT_DOUBLE_EQ(world.control_model.mass_scale, 1.05);
  EXPECT_EQ(world.control_model.com_shift.at("torso"), (std::array<double, 3>{0.01, 0, 0}));
  EXPECT_EQ(world.constraints[0].name, "planarizer");
  EXPECT_DOUBLE_EQ(world.planner_latency, 5e-3);
  EXPECT_EQ(world.physics.steps_per_tick, 4);
  EXPECT_EQ(world.physics.integrator, Integrator::implicit);
  EXPECT_EQ(world.physics.solver, Solver::pgs);
  EXPECT_EQ(world.physics.cone, Cone::pyramidal);
  EXPECT_EQ(world.physics.solref, (std::array<double, 2>{0.01, 1.0}));
  EXPECT_EQ(world.physics.solimp, (std::array<double, 3>{0.9, 0.95, 0.001}));
}

TEST_F(WorldDescriptionTest, TheDefaultIsFlatAndIdeal) {
  const WorldDescription world;
  EXPECT_EQ(world.friction, 0.9);
  EXPECT_TRUE(world.terrain.empty());
  EXPECT_EQ(world.actuators.model, ActuatorModel::ideal);
  EXPECT_EQ(world.actuators.command_delay, 0.0);
  EXPECT_EQ(world.control_model.mass_scale, 1.0);
  EXPECT_TRUE(world.constraints.empty());
  EXPECT_EQ(world.physics.steps_per_tick, 2);
  EXPECT_EQ(world.physics.integrator, Integrator::euler);
  EXPECT_EQ(world.physics.solver, Solver::newton);
  EXPECT_EQ(world.physics.cone, Cone::elliptic);
  EXPECT_EQ(world.physics.impratio, 10.0);
  check_supported(world, diagnostics_);
  EXPECT_EQ(diagnostics_.to_string(), "");
}

TEST_F(WorldDescriptionTest, EverythingOfItIsSimulated) {
  check_supported(load(kWorld), diagnostics_);
  EXPECT_EQ(problems(), "");
}

TEST_F(WorldDescriptionTest, ADelayAndAWrongControlModelAreSupported) {
  const WorldDescription world = load(
      "world: 1\nactuators: {model: ideal, command_delay: 2 ms}\n"
      "control_model: {mass: \"-10 %\"}\n");
  check_supported(world, diagnostics_);
  EXPECT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(world.name, "lab");  // the file's own
  EXPECT_DOUBLE_EQ(world.control_model.mass_scale, 0.9);
  EXPECT_DOUBLE_EQ(world.actuators.command_delay, 2e-3);
}

TEST_F(WorldDescriptionTest, ImperfectionsOfSpringsNeedSpringsInTheActuators) {
  const WorldDescription world =
      load("world: 1\nactuators: {command_delay: 1 ms, coulomb: 1 Nm, spring: 3 %}\n");
  check_supported(world, diagnostics_);
  EXPECT_EQ(problems(),
            "2:43: error: 'coulomb' has no effect on ideal actuators: expected 'model: "
            "series_elastic' beside it\n"
            "2:57: error: 'spring' has no effect on ideal actuators: expected 'model: "
            "series_elastic' beside it\n");
}

TEST_F(WorldDescriptionTest, MistakesAreErrorsAtTheirPlace) {
  EXPECT_EQ(problems_of("robot: 1\n"),
            "1:1: error: not a world file: expected 'world: 1' as the first key, got 'robot'\n");
  EXPECT_EQ(problems_of("world: 1\nground: {fricton: 0.7}\n"),
            "2:10: error: unknown key 'fricton' (did you mean 'friction'?)\n");
  EXPECT_EQ(problems_of("world: 1\nground: {friction: -1}\n"),
            "2:20: error: expected a plain number, 0 to 10, got '-1'\n");
  EXPECT_EQ(problems_of("world: 1\nplanner_latency: 5 mm\n"),
            "2:18: error: expected a time, got '5 mm'\n");
  EXPECT_EQ(problems_of("world: 1\nplanner_latency: -5 ms\n"),
            "2:18: error: expected a time, at least 0 s, got '-5 ms'\n");
  EXPECT_EQ(problems_of("world: 1\nactuators: {model: perfect}\n"),
            "2:20: error: expected an actuator model: ideal or series_elastic, got 'perfect'\n");
  EXPECT_EQ(problems_of("world: 1\ncontrol_model: {mass: 105 %}\n"),
            "2:23: error: expected a change with its sign, such as \"+5 %\", got '105 %'\n");
  EXPECT_EQ(problems_of("world: 1\nground: {terrain: [{box: {at: [0, 0], size: [1, 0, 1]}}]}\n"),
            "2:45: error: expected lengths above zero for a box\n");
  EXPECT_EQ(problems_of("world: 1\nground: {terrain: [{ball: {}}]}\n"),
            "2:20: error: the key 'box' is missing\n"
            "2:21: error: unknown key 'ball', expected box\n");
  EXPECT_EQ(problems_of("world: 1\nsurface: {ramps: [{from: 1 m, to: 0 m, rise: 1 cm}]}\n"),
            "2:19: error: expected 'from' before 'to' in a ramp\n");
  EXPECT_EQ(problems_of("world: 1\nphysics: {timestep_divisor: 0, solver: quick}\n"),
            "2:29: error: expected a whole number from 1 to 1000, got '0'\n"
            "2:40: error: expected newton, cg or pgs, got 'quick'\n");
}

TEST_F(WorldDescriptionTest, AWorldIsFoundByFileOrName) {
  load(kWorld);
  EXPECT_EQ(find_world_file(path(), {}), path());
  const std::filesystem::path home = folder_ / "sim" / "worlds";
  std::filesystem::create_directories(home);
  std::ofstream(home / "ice.yaml") << kWorld;
  EXPECT_EQ(find_world_file("ice", {"/nowhere", folder_.string()}), (home / "ice.yaml").string());
  EXPECT_EQ(find_world_file("mars", {folder_.string()}), "");
}

TEST_F(WorldDescriptionTest, TheFrictionOnTopWinsAndTwoInOneFileAreRefused) {
  std::ofstream(folder_ / "drawn.yaml") << "world: 1\nvariation: {friction: {range: [0.7, 1]}}\n";
  const WorldDescription given = load("world: 1\nbase: drawn.yaml\nground: {friction: 0.2}\n");
  EXPECT_EQ(problems(), "");
  EXPECT_EQ(given.friction, 0.2);
  EXPECT_EQ(given.variation.least_friction(), std::nullopt);
  std::ofstream(folder_ / "given.yaml") << "world: 1\nground: {friction: 0.2}\n";
  const WorldDescription drawn =
      load("world: 1\nbase: given.yaml\nvariation: {friction: {range: [0.7, 1]}}\n");
  EXPECT_EQ(problems(), "");
  EXPECT_EQ(drawn.variation.least_friction(), 0.7);
  const WorldDescription off =
      load("world: 1\nbase: drawn.yaml\nground: {friction: 0.2}\nvariation: off\n");
  EXPECT_EQ(problems(), "");
  EXPECT_EQ(off.friction, 0.2);
}

}  // namespace
}  // namespace footfall::sim
