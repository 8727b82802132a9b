// What the simulated robot measures, against the simulator's own state.
#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <vector>

#include "core/realtime/allocation_count.h"
#include "model/sensor_mounts.h"
#include "sim/mujoco_backend.h"
#include "tests/support/hume.h"

namespace footfall::tests {
namespace {

using Vector3 = std::array<double, 3>;

class Sensing : public testing::Test {
 protected:
  static sim::WorldDescription lab() {
    core::Diagnostics diagnostics;
    auto world = sim::load_world(FOOTFALL_SOURCE_DIR "/sim/worlds/lab.yaml", diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
    world.noise_seed = 5;
    return world;
  }

  // The robot falls and swings its legs.
  static void move(sim::MujocoBackend& backend, int tick) {
    hal::Commands commands;
    for (std::size_t j = 0; j < 6; ++j) {
      commands.tau[j] = 15.0 * std::sin(0.02 * tick + static_cast<double>(j));
    }
    backend.write(commands);
  }

  static std::vector<hal::Sensors> measured(sim::MujocoBackend& backend, int ticks) {
    std::vector<hal::Sensors> out(1);
    backend.start();
    for (int k = 0; k < ticks; ++k) {
      backend.read(out.back());
      move(backend, k);
      if (k + 1 < ticks) out.push_back(out.back());
    }
    return out;
  }

  model::RobotDescription robot = load_hume();
  double period = robot.period_s();
};

// R(t) = R(t-T) exp(gyro T), and v_I(t) = v_I(t-T) + (R(t-T/2) accelerometer + g) T: a thousand
// ticks of integration end where the simulator is. Round-off of a tick is 1e-16 of an angle and of
// a velocity; 1e-9 leaves room for a thousand of them.
TEST_F(Sensing, ThePerfectImuIntegratesToTheStateOfTheSimulator) {
  sim::MujocoBackend backend(robot, {});
  const auto all = measured(backend, 1000);
  const model::SensorMounts mounts = model::sensor_mounts(robot);
  const auto imu_velocity = [&](const hal::Sensors& s) {
    Vector3 arm{}, v{};
    mju_cross(arm.data(), s.w_WB_B.data(), mounts.p_BI.data());
    mju_rotVecQuat(v.data(), arm.data(), s.q_WB.data());
    mju_addTo3(v.data(), s.v_WB.data());
    return v;
  };
  std::array<double, 4> q = all[0].q_WB;
  Vector3 v = imu_velocity(all[0]);
  for (std::size_t k = 1; k < all.size(); ++k) {
    Vector3 w{}, f{};  // base axes
    mju_mulMatVec(w.data(), mounts.R_BI.data(), all[k].gyro.data(), 3, 3);
    mju_mulMatVec(f.data(), mounts.R_BI.data(), all[k].accelerometer.data(), 3, 3);
    std::array<double, 4> middle = q;
    mju_quatIntegrate(middle.data(), w.data(), 0.5 * period);
    mju_quatIntegrate(q.data(), w.data(), period);
    mju_rotVecQuat(f.data(), f.data(), middle.data());
    for (std::size_t i = 0; i < 3; ++i) v[i] += (f[i] - (i == 2 ? 9.81 : 0.0)) * period;
  }
  double along = 0.0;
  for (std::size_t i = 0; i < 4; ++i) along += q[i] * all.back().q_WB[i];
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(q[i], std::copysign(1.0, along) * all.back().q_WB[i], 1e-9);
  }
  const Vector3 truth = imu_velocity(all.back());
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(v[i], truth[i], 1e-9);
}

TEST_F(Sensing, PerfectMarkersAreAtTheirSites) {
  sim::MujocoBackend backend(robot, {});
  measured(backend, 200);
  hal::Sensors s;
  backend.read(s);
  mj_kinematics(backend.model(), backend.data());
  const model::SensorMounts mounts = model::sensor_mounts(robot);
  ASSERT_GT(mounts.markers.size(), 3u);
  for (std::size_t m = 0; m < mounts.markers.size(); ++m) {
    const int site = mj_name2id(backend.model(), mjOBJ_SITE, mounts.markers[m].name.c_str());
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(s.marker[m][k], backend.data()->site_xpos[3 * site + static_cast<int>(k)], 1e-12);
    }
  }
}

// Late frames show where the sites were at the exposure: between two ticks, on the straight line.
TEST_F(Sensing, LateMarkersAreWhereTheirSitesWereAtTheExposure) {
  sim::WorldDescription world;
  world.sensors.errors.mocap = {.rate = 480.0, .delay = 5e-3};
  sim::MujocoBackend backend(robot, world), perfect(robot, {});
  const auto late = measured(backend, 500), now = measured(perfect, 500);
  int frames = 0;
  for (std::size_t k = 0; k < late.size(); ++k) {
    if (!late[k].mocap_fresh) continue;
    // Ticks; before the start the base was where it starts.
    const double exposure = std::max(static_cast<double>(k) - late[k].mocap_age / period, 0.0);
    const auto before = static_cast<std::size_t>(exposure + 1e-9);
    const double part = exposure - static_cast<double>(before);
    for (std::size_t i = 0; i < 3; ++i) {
      const double a = now[before].marker[0][i], b = now[before + 1].marker[0][i];
      EXPECT_NEAR(late[k].marker[0][i], a + part * (b - a), 0x1p-20);
    }
    ++frames;
  }
  EXPECT_GT(frames, 150);
}

TEST_F(Sensing, TheTruthBesideErrorsIsTheSimulatorsState) {
  sim::MujocoBackend backend(robot, lab());
  measured(backend, 300);
  hal::Sensors s;
  backend.read(s);
  EXPECT_TRUE(s.sensor_truth);
  const mjModel* m = backend.model();
  mjData* d = backend.data();
  for (std::size_t j = 0; j < robot.joints.size(); ++j) {
    const int joint = mj_name2id(m, mjOBJ_JOINT, robot.joints[j].name.c_str());
    EXPECT_EQ(s.true_q[j], d->qpos[m->jnt_qposadr[joint]]);
    EXPECT_EQ(s.true_qd[j], d->qvel[m->jnt_dofadr[joint]]);
    EXPECT_LE(std::abs(s.q[j] - s.true_q[j]), 0.5 * 3.8e-4 + 1e-12);
  }
  mj_forward(m, d);
  mj_subtreeVel(m, d);
  const int base = mj_name2id(m, mjOBJ_BODY, robot.floating_base.c_str());
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(s.true_com[k], d->subtree_com[3 * base + static_cast<int>(k)], 1e-12);
    EXPECT_NEAR(s.true_com_velocity[k], d->subtree_linvel[3 * base + static_cast<int>(k)], 1e-12);
  }
}

// Errors of sensors do not act on the robot: with the same torques its motion is the same.
TEST_F(Sensing, ErrorsOfSensorsDoNotMoveTheRobot) {
  sim::WorldDescription world;
  world.sensors = lab().sensors;
  sim::MujocoBackend with(robot, world), without(robot, {});
  const auto a = measured(with, 400), b = measured(without, 400);
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].p_WB, b[k].p_WB) << k;
    ASSERT_EQ(a[k].q_WB, b[k].q_WB);
    ASSERT_EQ(a[k].force, b[k].force);
    ASSERT_EQ(a[k].true_q, b[k].q);
  }
}

TEST_F(Sensing, ASeedRepeatsItsRunBitForBit) {
  sim::WorldDescription world = lab();
  sim::MujocoBackend first(robot, world), second(robot, world);
  world.noise_seed = 6;
  sim::MujocoBackend other(robot, world);
  const auto a = measured(first, 300), b = measured(second, 300), c = measured(other, 300);
  for (std::size_t k = 0; k < a.size(); ++k) {
    hal::for_each_field(hal::kSensorFields, [&](const auto& field) {
      ASSERT_EQ(a[k].*field.member, b[k].*field.member) << field.name << " " << k;
    });
  }
  EXPECT_NE(a.back().gyro, c.back().gyro);
  EXPECT_NE(a.back().marker, c.back().marker);
}

TEST_F(Sensing, ReadsAndWritesInTheLabAllocateNothing) {
  sim::MujocoBackend backend(robot, lab());
  backend.start();
  hal::Sensors s;
  backend.read(s);
  move(backend, 0);
  core::arm_allocation_count(true);
  const std::int64_t before = core::allocation_count();
  for (int k = 1; k < 300; ++k) {
    backend.read(s);
    move(backend, k);
  }
  core::arm_allocation_count(false);
  EXPECT_EQ(core::allocation_count(), before);
}

}  // namespace
}  // namespace footfall::tests
