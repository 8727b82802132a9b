// What the hardware is told of the control law: gains of torque loops and supporting contacts, when
// they change and not else; and torque loops edited while the robot steps on its springs.
#include "engine/links/hardware_link.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "engine/edits/door.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

// A robot that notes what it is told.
class Told final : public hal::Hardware {
 public:
  std::string name() const override { return "told"; }
  void start() override {}
  bool read(hal::Sensors& sensors) noexcept override {
    sensors.has_truth = true;
    sensors.p_WB = {0.0, 0.0, 0.84};
    sensors.contact = {true, true};
    sensors.q = {0.0, -0.487, 0.998, 0.0, -0.487, 0.998};
    return true;
  }
  void write(const hal::Commands&) noexcept override { ++writes; }
  void safe_stop() noexcept override {}
  bool uses_torque_loop() const override { return elastic; }
  void set_support(std::uint64_t contacts) noexcept override { support = contacts; }
  void set_torque_loop(int joint, const hal::TorqueLoopGains& to) noexcept override {
    gains[static_cast<std::size_t>(joint)] = to;
    ++changes;
  }

  bool elastic = true;
  std::array<hal::TorqueLoopGains, 6> gains{};
  std::uint64_t support = 0;
  int changes = 0, writes = 0;
};

constexpr const char* kScheduled = R"(
behavior: 1
robot: hume
torque_loop:
  stiff: {type: direct, damps: spring, p: 20, d: 40}
  soft: {type: direct, damps: spring, p: {"*hip": 9, "*knee": 7}, d: 30}
machine:
  states:
    both: {contacts: [right_foot, left_foot], torque_loop: {right_leg: stiff, left_leg: stiff}, after: 10 ms, to: one}
    one: {contacts: [right_foot], torque_loop: {right_leg: stiff, left_leg: soft}}
)";

TEST(HardwareLink, GainsFollowTheStateByJointAndAreToldOnce) {
  const auto behavior = load_inline(kScheduled);
  Told robot;
  engine::ControlLoop loop(*behavior, robot, {});
  loop.start();
  loop.tick();
  EXPECT_EQ(robot.changes, 6);
  for (const auto& gains : robot.gains) EXPECT_EQ(gains.p, 20.0);
  EXPECT_EQ(robot.support, 0b11U);
  while (loop.time() < 0.02) loop.tick();
  EXPECT_EQ(robot.changes, 9);  // the left leg's
  EXPECT_EQ(robot.gains[2].p, 20.0);
  EXPECT_EQ(robot.gains[3].p, 20.0);  // not in the table: as the robot's drives have it
  EXPECT_EQ(robot.gains[4].p, 9.0);
  EXPECT_EQ(robot.gains[5].p, 7.0);
  EXPECT_EQ(robot.gains[5].damping, 30.0);
  EXPECT_EQ(robot.support, 0b01U);
}

TEST(HardwareLink, IdealActuatorsAreToldNothingOfTorqueLoops) {
  const auto behavior = load_inline(kScheduled);
  Told robot;
  robot.elastic = false;
  engine::ControlLoop loop(*behavior, robot, {});
  loop.start();
  while (loop.time() < 0.02) loop.tick();
  EXPECT_EQ(robot.changes, 0);
  EXPECT_EQ(robot.support, 0b01U);
}

TEST(HardwareLink, ATickWithChangesAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  const auto behavior = load_inline(kScheduled);
  Told robot;
  engine::ControlLoop loop(*behavior, robot, {});
  loop.start();
  const AllocationGuard guard;
  for (int k = 0; k < 30; ++k) loop.tick();
  EXPECT_EQ(guard.allocations(), 0);
}

// 1000 edits of one to three gains of the torque loops, one in 36 ms, while the robot steps in the
// world `sea` with other gains in stance than in swing. The measured torque may step by what its
// command does, and 2 N m more.
TEST(HardwareLink, AThousandLiveEditsWhileSteppingOnSpringsNeitherFellNorJolt) {
  core::Diagnostics problems;
  const std::string root = FOOTFALL_SOURCE_DIR;
  Rig rig(root + "/tests/runs/regression/behaviors/scheduled.yaml",
          sim::load_world(root + "/sim/worlds/sea.yaml", problems));
  ASSERT_EQ(problems.to_string(), "");
  const behaviors::Behavior& b = *rig.behavior;
  std::mt19937_64 random(11);
  std::vector<const behaviors::ParameterInfo*> loops;
  for (const auto& info : b.parameters) {
    if (info.name.starts_with("torque_loop.")) loops.push_back(&info);
  }
  ASSERT_EQ(loops.size(), 4u);
  rig.loop->start();
  hal::Sensors before = rig.loop->sensors();
  double jolt = 0.0, commanded = 0.0;
  int edits = 0, applied = 0;
  for (int tick = 0; edits < 1000 || tick % 54 != 0; ++tick) {
    if (tick > 3000 && tick % 54 == 0) {
      engine::EditBatch batch;
      std::ranges::shuffle(loops, random);
      for (std::size_t k = 0; k < 1 + random() % 3; ++k) {
        std::uniform_real_distribution<double> within(loops[k]->min, loops[k]->max);
        batch.values.push_back({loops[k]->slot + static_cast<int>(random() % 6), within(random)});
      }
      ASSERT_TRUE(rig.loop->edits().submit(batch).accepted());
      ++edits;
    }
    const hal::Commands last = rig.loop->commands();
    rig.loop->tick();
    for (engine::EditAnswer answer; rig.loop->edits().take_answer(answer);) {
      applied += answer.outcome == engine::EditOutcome::applied;
    }
    ASSERT_EQ(rig.loop->state(), engine::LoopState::running) << rig.loop->time();
    double step = 0.0;
    for (std::size_t j = 0; j < 6; ++j) {
      step = std::max(step, std::abs(rig.loop->sensors().tau[j] - before.tau[j]));
      commanded = std::max(commanded, std::abs(rig.loop->commands().tau[j] - last.tau[j]));
    }
    jolt = std::max(jolt, step);
    before = rig.loop->sensors();
  }
  EXPECT_EQ(applied, 1000);
  EXPECT_LE(jolt, commanded + 2.0);
  RecordProperty("edits", applied);
  RecordProperty("torque_step", std::to_string(jolt));
  RecordProperty("command_step", std::to_string(commanded));
}

}  // namespace
}  // namespace footfall::tests
