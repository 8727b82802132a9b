// The tick over the stub backend and over MuJoCo: it runs, repeats bit for bit, allocates nothing.
#include "engine/tick/control_loop.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <set>

#include "engine/log/writer.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

constexpr const char* kStand = R"(
behavior: 1
robot: hume
machine:
  safe: limp
  states:
    both:
      contacts: [right_foot, left_foot]
      tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}
      transitions: [{when: "not contact.left_foot", to: one}]
    one:
      contacts: [right_foot]
      tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}
      transitions: [{when: "contact.left_foot", to: both}]
    limp: {contacts: [], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 5}}}}
)";

constexpr const char* kFloat = R"(
behavior: 1
robot: hume
machine:
  states:
    float: {contacts: [], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}}
)";

double fastest_joint(const hal::Sensors& sensors, int joints) {
  double fastest = 0.0;
  for (int j = 0; j < joints; ++j) {
    fastest = std::max(fastest, std::abs(sensors.qd[static_cast<std::size_t>(j)]));
  }
  return fastest;
}

std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(ControlLoop, WhatIsNotInForceHasNoValue) {
  StubRig rig(R"(
behavior: 1
robot: hume
machine:
  states:
    both:
      contacts: [right_foot, left_foot]
      internal: {push: {between: all, reference: 20 N, convention: sum}}
      tasks: {rest: {type: joint_damping, gains: {kd: 2}}}
      transitions: [{when: "task.later.error < 1 m", to: never}, {after: 10 ms, to: one}]
    one:
      contacts: [right_foot]
      tasks: {later: {type: com_position, axes: [z], reference: 0.8 m, gains: {kp: 1}}}
    never: {}
)");
  rig.loop->start();
  const auto value = [&](const char* name) {
    return rig.loop->signals()[rig.loop->signals().find(name)];
  };
  for (int k = 0; k < 5; ++k) rig.loop->tick();
  EXPECT_EQ(rig.state(), "both");
  EXPECT_TRUE(std::isnan(value("task.later.error")));
  EXPECT_TRUE(std::isnan(value("task.later.reference.z")));
  EXPECT_TRUE(std::isfinite(value("task.rest.error")));
  EXPECT_DOUBLE_EQ(value("internal.push.reference"), 20.0);  // as the behavior writes it
  for (int k = 0; k < 15; ++k) rig.loop->tick();
  EXPECT_EQ(rig.state(), "one");
  EXPECT_TRUE(std::isfinite(value("task.later.error")));
  EXPECT_TRUE(std::isnan(value("task.rest.authority")));
  EXPECT_TRUE(std::isnan(value("internal.push.measured")));
}

TEST(ControlLoop, TicksOnTheStubBackend) {
  StubRig rig(kStand);
  rig.loop->start();
  EXPECT_EQ(rig.loop->ticks(), 0);
  for (int k = 0; k < 300; ++k) EXPECT_EQ(rig.loop->tick(), engine::LoopState::running);
  EXPECT_EQ(rig.loop->ticks(), 300);
  EXPECT_DOUBLE_EQ(rig.loop->time(), 0.2);
  // The backend counted the same ticks: its clock was read at the beginning of the last one.
  EXPECT_NEAR(static_cast<double>(rig.loop->sensors().time_ns), 299e9 / 1500.0, 1.0);
  EXPECT_EQ(rig.state(), "both");
}

TEST(ControlLoop, ScriptedContactsChangeTheState) {
  StubRig rig(kStand, 1e6, [](int contact, double time) {
    return contact == 0 || time < 0.0995 || time > 0.1995;
  });
  rig.loop->start();
  std::vector<std::pair<std::int64_t, std::string>> changes;
  std::string state;
  for (int k = 0; k < 450; ++k) {
    rig.loop->tick();
    if (rig.state() != state) changes.emplace_back(k, state = rig.state());
  }
  // The switch opens at 0.0995 s, sampled at tick 150 (0.1 s), and closes so that 300 sees it.
  using Change = std::pair<std::int64_t, std::string>;
  EXPECT_EQ(changes, (std::vector<Change>{{0, "both"}, {150, "one"}, {300, "both"}}));
  EXPECT_EQ(rig.loop->signals()[rig.behavior->layout.support[1]], 1.0);
}

TEST(ControlLoop, JointDampingStopsTheJoints) {
  StubRig rig(kFloat, 0.1);
  rig.hardware->add = [](hal::Commands& commands, std::int64_t tick) {
    if (tick < 15) commands.tau[1] += 1.0;  // a kick of 10 ms
  };
  rig.loop->start();
  double fastest = 0.0;
  for (int k = 0; k < 100; ++k) {
    rig.loop->tick();
    fastest = std::max(fastest, fastest_joint(rig.loop->sensors(), 6));
  }
  EXPECT_GT(fastest, 0.01);
  // I q̈ = -kd Λ q̇ with Λ positive definite: smallest eigenvalue above 0.005 kg m² (the shank's
  // about its own centre is 0.003, about the knee 0.02), so the rate is at least 1/s.
  for (int k = 0; k < 15000; ++k) rig.loop->tick();
  EXPECT_LT(fastest_joint(rig.loop->sensors(), 6), std::exp(-5.0) * fastest);
}

TEST(ControlLoop, AllocatesNothingInAnyState) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  Rig rig("balance");
  rig.loop->start();
  std::vector<char> seen(rig.behavior->states.size(), 0);
  const AllocationGuard guard;
  for (int k = 0; k < 3000; ++k) {
    rig.loop->sense();
    rig.loop->compute();
    for (const int s : rig.loop->machine().active_atomic()) seen[static_cast<std::size_t>(s)] = 1;
    rig.loop->actuate();
  }
  rig.loop->machine().enter_safe();
  for (int k = 0; k < 10; ++k) {
    rig.loop->tick();
    for (const int s : rig.loop->machine().active_atomic()) seen[static_cast<std::size_t>(s)] = 1;
  }
  rig.loop->safe_stop();
  EXPECT_EQ(guard.allocations(), 0);
  for (std::size_t s = 0; s < seen.size(); ++s) {
    if (rig.behavior->states[s].kind != behaviors::StateKind::atomic) continue;
    EXPECT_TRUE(seen[s]) << rig.behavior->states[s].path << " was never active";
  }
}

TEST(ControlLoop, FaultsAndTheirReactionsAllocateNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  StubRig rig(kStand);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    if (tick == 50) sensors.qd[2] = std::nan("");
    if (tick == 80) sensors.body_contact = true;
  };
  rig.loop->start();
  const AllocationGuard guard;
  for (int k = 0; k < 100; ++k) rig.loop->tick();
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(rig.loop->state(), engine::LoopState::fallen);
}

TEST(ControlLoop, TwoRunsAreEqualBitForBitAndSoAreTheirLogs) {
  constexpr int kTicks = 2000;
  std::vector<double> first;
  std::vector<std::string> logs;
  for (const char* name : {"a", "b"}) {
    Rig rig("balance");
    const std::string path = testing::TempDir() + "footfall_" + std::to_string(getpid()) + name;
    engine::LogHeader header;
    header.rate_mhz = 1'500'000;
    engine::LogWriter log(path, rig.behavior->signals, header);
    rig.loop->start();
    const auto size = static_cast<std::size_t>(rig.loop->signals().size());
    const bool again = !first.empty();
    for (std::size_t k = 0; k < kTicks; ++k) {
      rig.loop->tick();
      const double* values = rig.loop->signals().values();
      log.tick(static_cast<std::int64_t>(k), rig.loop->sensors(), true, rig.loop->commands(),
               values, k % 500 == 0);
      if (!again) first.insert(first.end(), values, values + size);
      if (again && std::memcmp(first.data() + k * size, values, size * sizeof(double)) != 0) {
        FAIL() << "tick " << k << " differs";
      }
    }
    log.close();
    logs.push_back(slurp(path));
    std::filesystem::remove(path);
  }
  EXPECT_GT(logs[0].size(), 100000U);
  EXPECT_TRUE(logs[0] == logs[1]);
}

}  // namespace
}  // namespace footfall::tests
