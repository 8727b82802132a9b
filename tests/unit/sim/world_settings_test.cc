// The world sets physics and ground, whatever options and defaults a robot's file has.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "sim/mujoco_backend.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

TEST(WorldSettings, ApplyWhateverTheRobotsFileSays) {
  model::RobotDescription robot = load_hume();
  const model::RobotDescription plain = robot;
  const std::string path = testing::TempDir() + "/footfall_settings.xml";
  std::ofstream(path) << "<mujoco><option timestep=\"0.004\" integrator=\"RK4\" solver=\"PGS\" "
                         "iterations=\"3\" impratio=\"1\" cone=\"pyramidal\" gravity=\"1 0 -2\" "
                         "density=\"9\" wind=\"1 1 1\" collision=\"predefined\"><flag "
                         "contact=\"disable\" energy=\"enable\"/></option><size njmax=\"1\"/>"
                         "<default><geom contype=\"0\" conaffinity=\"0\" margin=\"0.1\" "
                         "gap=\"0.05\"/></default><include file=\""
                      << robot.model_path << "\"/></mujoco>";
  sim::MujocoBackend expected(plain, {});
  robot.model_path = path;
  sim::MujocoBackend backend(robot, {});
  const mjOption &is = backend.model()->opt, &should = expected.model()->opt;
  EXPECT_EQ(is.timestep, should.timestep);
  EXPECT_EQ(is.integrator, should.integrator);
  EXPECT_EQ(is.solver, should.solver);
  EXPECT_EQ(is.iterations, should.iterations);
  EXPECT_EQ(is.impratio, should.impratio);
  EXPECT_EQ(is.cone, should.cone);
  EXPECT_EQ(is.density, 0.0);
  EXPECT_EQ(is.collision, should.collision);
  EXPECT_EQ(is.disableflags, 0);
  EXPECT_EQ(is.enableflags, 0);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(is.gravity[k], should.gravity[k]);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(is.wind[k], 0.0);
  const int ground = mj_name2id(backend.model(), mjOBJ_GEOM, "ground");
  EXPECT_EQ(backend.model()->geom_contype[ground], 1);
  EXPECT_EQ(backend.model()->geom_conaffinity[ground], 1);
  EXPECT_EQ(backend.model()->geom_margin[ground], 0.0);
  EXPECT_EQ(backend.model()->geom_gap[ground], 0.0);
  EXPECT_GT(backend.model()->njmax, 1);
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace footfall::tests
