// The physics behind every figure, asserted on the compiled model, and what the backend adds to it:
// delay, pushes, contact forces, faults, seeds.
#include "sim/mujoco_backend.h"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "tests/support/rig.h"
#include "tests/unit/sim/mujoco_test_support.h"

namespace footfall::tests {
namespace {

int geom(const mjModel* m, const char* name) { return mj_name2id(m, mjOBJ_GEOM, name); }

TEST_F(Mujoco, TheCompiledModelIsThePhysicsThatFiguresName) {
  auto backend = started();
  const mjModel* m = backend.model();
  EXPECT_EQ(m->jnt_type[0], mjJNT_FREE);
  EXPECT_EQ(m->body_parentid[1], 0);
  for (int i = 1; i < m->njnt; ++i) EXPECT_EQ(m->jnt_type[i], mjJNT_HINGE);
  for (const char* foot : {"right_foot", "left_foot"}) {
    const int g = geom(m, foot);
    ASSERT_GE(g, 0);
    EXPECT_EQ(m->geom_type[g], mjGEOM_SPHERE);
    EXPECT_LE(m->geom_size[3 * g], 0.025);
    EXPECT_EQ(m->geom_condim[g], 3);
  }
  EXPECT_EQ(m->geom_condim[geom(m, "ground")], 3);
  for (int i = 0; i < m->nv; ++i) {
    EXPECT_EQ(m->dof_damping[i], 0.0);
    EXPECT_EQ(m->dof_armature[i], 0.0);
    EXPECT_EQ(m->dof_frictionloss[i], 0.0);
  }
  for (int i = 0; i < m->njnt; ++i) EXPECT_EQ(m->jnt_stiffness[i], 0.0);
  EXPECT_EQ(m->neq, 0);
  EXPECT_EQ(m->nmocap, 0);
  EXPECT_EQ(m->ntendon, 0);
  EXPECT_EQ(m->npair, 0);
  EXPECT_EQ(m->nexclude, 0);
  EXPECT_LE(m->opt.timestep, 1.0 / 3000.0 + 1e-15);
  EXPECT_EQ(m->opt.disableflags, 0);
  EXPECT_EQ(m->opt.density, 0.0);
  EXPECT_EQ(m->opt.viscosity, 0.0);
  EXPECT_DOUBLE_EQ(m->opt.gravity[2], -9.81);
  EXPECT_NEAR(m->body_subtreemass[1], 20.0, 0.01);
  for (int i = 0; i < 6 * m->nbody; ++i) EXPECT_EQ(backend.data()->xfrc_applied[i], 0.0);
}

TEST_F(Mujoco, TheFactsOfTheSummaryAreThoseOfTheModel) {
  auto backend = started();
  const sim::PhysicsFacts facts = backend.facts();
  EXPECT_DOUBLE_EQ(facts.timestep, backend.model()->opt.timestep);
  EXPECT_EQ(facts.friction, 0.9);
  EXPECT_EQ(facts.foot_radius_max, 0.025);
  EXPECT_EQ(facts.condim_max, 3);
  EXPECT_EQ(facts.damping_max, 0.0);
  EXPECT_EQ(facts.armature_max, 0.0);
  EXPECT_EQ(facts.equalities, 0);
  EXPECT_EQ(facts.mocap_bodies, 0);
  EXPECT_NEAR(facts.mass, 20.0, 0.01);
}

TEST_F(Mujoco, ALegCanTouchTheOtherLegAndTheTorsoAndThatIsSeen) {
  auto backend = started();
  backend.start();
  lift(backend);
  mjData* d = backend.data();
  d->qpos[7] = 0.3;  // both legs inwards by 0.24 m: they cross
  d->qpos[10] = -0.3;
  backend.write({});
  hal::Sensors sensors;
  backend.read(sensors);
  ASSERT_GT(d->ncon, 0);
  EXPECT_TRUE(sensors.body_contact);
  EXPECT_FALSE(sensors.contact[0]);  // a foot switch closes on the ground only
  EXPECT_FALSE(sensors.contact[1]);
}

TEST_F(Mujoco, TheGroundsFrictionIsTheContactsFriction) {
  for (const double friction : {0.3, 0.9, 1.5}) {
    sim::WorldDescription world;
    world.friction = friction;
    auto backend = started(world);
    backend.start();
    for (int k = 0; k < 10; ++k) backend.write({});
    const mjModel* m = backend.model();
    const mjData* d = backend.data();
    int feet = 0;
    for (int i = 0; i < d->ncon; ++i) {
      const int other = d->contact[i].geom1 == geom(m, "ground") ? d->contact[i].geom2 : -1;
      if (other != geom(m, "right_foot") && other != geom(m, "left_foot")) continue;
      ++feet;
      EXPECT_EQ(d->contact[i].dim, 3);
      EXPECT_DOUBLE_EQ(d->contact[i].friction[0], friction);
      EXPECT_DOUBLE_EQ(d->contact[i].friction[1], friction);
    }
    EXPECT_EQ(feet, 2);
  }
}

TEST_F(Mujoco, APushedFootSlidesAtTheFrictionOfTheWorld) {
  for (const double friction : {0.3, 0.9}) {
    sim::WorldDescription world;
    world.friction = friction;
    auto backend = started(world);
    backend.start();
    backend.push(backend.find_body("right_shank"), 2000.0, 0.0, 0.02);
    double largest = 0.0;
    for (int k = 0; k < 30; ++k) {
      backend.write({});
      hal::Sensors s;
      backend.read(s);
      const double normal = s.force[0][2];
      if (normal > 1.0)
        largest = std::max(largest, std::hypot(s.force[0][0], s.force[0][1]) / normal);
    }
    // The elliptic cone is exact up to the solver's tolerance.
    EXPECT_NEAR(largest, friction, 1e-3 * friction);
  }
}

TEST_F(Mujoco, ACommandActsExactlyTheDelayLater) {
  for (const int delay : {0, 1, 5, 6}) {
    sim::WorldDescription world;
    world.physics.steps_per_tick = 1;
    world.actuators.command_delay = delay / 1500.0;
    auto backend = started(world);
    backend.start();
    hal::Commands commands;
    commands.tau[1] = 3.0;
    for (int step = 0; step < 12; ++step) {
      backend.write(commands);
      hal::Sensors sensors;
      backend.read(sensors);
      EXPECT_EQ(sensors.tau[1], step < delay ? 0.0 : 3.0) << "delay " << delay << " step " << step;
    }
  }
}

TEST_F(Mujoco, ADelayOfTwoMillisecondsIsThreeTicksOfTwoSteps) {
  sim::WorldDescription world;
  world.actuators.command_delay = 2e-3;
  auto backend = started(world);
  backend.start();
  hal::Commands commands;
  commands.tau[1] = 3.0;
  for (int tick = 0; tick < 6; ++tick) {
    backend.write(commands);
    hal::Sensors sensors;
    backend.read(sensors);
    EXPECT_EQ(sensors.tau[1], tick < 3 ? 0.0 : 3.0) << tick;
    EXPECT_EQ(sensors.time_ns, (tick + 1) * 1'000'000'000LL / 1500);
  }
}

TEST_F(Mujoco, TorquesAreLimitedByTheMotor) {
  auto backend = started();
  backend.start();
  hal::Commands commands;
  commands.tau[0] = 1000.0;
  commands.tau[2] = -1000.0;
  backend.write(commands);
  hal::Sensors sensors;
  backend.read(sensors);
  EXPECT_EQ(sensors.tau[0], 50.0);
  EXPECT_EQ(sensors.tau[2], -100.0);
}

// Sum of the ground's forces over every physics step = change of momentum + weight times time:
// whatever the robot does meanwhile. This also fixes sign and axes of the sensed forces.
TEST_F(Mujoco, ContactForcesCarryTheWeightUpwards) {
  sim::WorldDescription world;
  world.physics.steps_per_tick = 1;  // a reading for each physics step
  Rig rig("balance", world);
  rig.loop->start();
  const Vector3 before = momentum(*rig.backend);
  const double step = rig.loop->period();
  Vector3 impulse{};
  constexpr int kTicks = 450;  // 0.3 s of standing and shifting
  for (int k = 0; k < kTicks; ++k) {
    rig.loop->tick();
    hal::Sensors sensors;
    rig.backend->read(sensors);
    for (std::size_t foot = 0; foot < 2; ++foot) {
      EXPECT_GE(sensors.force[foot][2], 0.0);
      EXPECT_EQ(sensors.force[foot][2] > 0.0, sensors.contact[foot]);
      for (std::size_t i = 0; i < 3; ++i) impulse[i] += step * sensors.force[foot][i];
    }
  }
  mj_forward(rig.backend->model(), rig.backend->data());
  const Vector3 after = momentum(*rig.backend);
  const double carried = rig.backend->facts().mass * 9.81 * kTicks * step;  // about 59 N s
  EXPECT_NEAR(impulse[0], after[0] - before[0], 1e-3 * carried);
  EXPECT_NEAR(impulse[1], after[1] - before[1], 1e-3 * carried);
  EXPECT_NEAR(impulse[2], after[2] - before[2] + carried, 1e-3 * carried);
  EXPECT_NEAR(after[2] - before[2], 0.0, 0.02 * carried);  // it stood
}

TEST_F(Mujoco, AStateThatIsNotANumberIsAFaultAndStaysOne) {
  for (const bool position : {false, true}) {
    auto backend = started();
    backend.start();
    for (int k = 0; k < 20; ++k) backend.write({});
    hal::Sensors sensors;
    backend.read(sensors);
    EXPECT_FALSE(sensors.backend_fault);
    (position ? backend.data()->qpos : backend.data()->qvel)[8] =
        std::numeric_limits<double>::quiet_NaN();
    for (int k = 0; k < 50; ++k) {
      backend.write({});
      backend.read(sensors);
      EXPECT_TRUE(sensors.backend_fault) << k;
    }
  }
}

TEST_F(Mujoco, AnExplosionEndsTheLoopAsAFall) {
  Rig rig("balance");
  rig.loop->start();
  for (int k = 0; k < 20; ++k) rig.loop->tick();
  rig.backend->data()->qvel[7] = 1e12;
  for (int k = 0; k < 3; ++k) rig.loop->tick();
  EXPECT_EQ(rig.loop->state(), engine::LoopState::fallen);
  EXPECT_EQ(rig.loop->faults().of(core::Fault::simulator_warning), 1);
}

TEST_F(Mujoco, ARunBeginsAsItWasDrawn) {
  model::Draw drawn;
  drawn.joints = {0.01, -0.02, 0.03, 0.0, 0.005, -0.006};
  drawn.velocity = {0.02, -0.03};
  drawn.rates = {0.1, -0.2, 0.3};
  drawn.friction = 0.65;
  auto backend = started(sim::with_draw({}, drawn));
  backend.start();
  hal::Sensors sensors;
  backend.read(sensors);
  for (std::size_t j = 0; j < 6; ++j) {
    EXPECT_DOUBLE_EQ(sensors.q[j], robot.joints[j].posture + drawn.joints[j]);
  }
  EXPECT_EQ(sensors.v_WB, (Vector3{0.02, -0.03, 0.0}));
  EXPECT_EQ(sensors.w_WB_B, drawn.rates);
  EXPECT_EQ(backend.facts().friction, 0.65);
}

TEST_F(Mujoco, StartsUprightAtRestWithItsFeetOnTheGround) {
  auto backend = started();
  backend.start();
  hal::Sensors sensors;
  backend.read(sensors);
  EXPECT_NEAR(sensors.p_WB[2], robot.standing_height, 1e-3);
  EXPECT_EQ(sensors.q_WB, (std::array<double, 4>{1, 0, 0, 0}));
  EXPECT_EQ(sensors.v_WB, (Vector3{}));
  for (std::size_t j = 0; j < 6; ++j) EXPECT_EQ(sensors.q[j], robot.joints[j].posture);
  const mjModel* m = backend.model();
  for (const char* foot : {"right_foot", "left_foot"}) {
    EXPECT_NEAR(backend.data()->geom_xpos[3 * geom(m, foot) + 2], 0.025, 1e-6);
  }
}

TEST_F(Mujoco, AfterASafeStopNoTorqueActs) {
  auto backend = started();
  backend.start();
  hal::Commands commands;
  commands.tau[1] = 3.0;
  backend.write(commands);
  backend.safe_stop();
  backend.write(commands);
  hal::Sensors sensors;
  backend.read(sensors);
  EXPECT_EQ(sensors.tau[1], 0.0);
  backend.start();
  backend.write(commands);
  backend.read(sensors);
  EXPECT_EQ(sensors.tau[1], 3.0);
}

TEST_F(Mujoco, ARobotFileThatDoesNotFitItsModelIsRefused) {
  const auto message = [this] {
    try {
      started();
      return std::string("no error");
    } catch (const std::runtime_error& error) {
      return std::string(error.what());
    }
  };
  model::RobotDescription whole = robot;
  robot.joints[2].name = "no_such_knee";
  EXPECT_NE(message().find("error: no joint 'no_such_knee' in the model"), std::string::npos);
  robot = whole;
  robot.contacts[0].site = "imu";
  EXPECT_NE(message().find("error: contact 'right_foot' has no collision sphere"),
            std::string::npos);
  robot = whole;
  robot.model_path = "/no/such/model.xml";
  EXPECT_NE(message().find("error: "), std::string::npos);
}

}  // namespace
}  // namespace footfall::tests
