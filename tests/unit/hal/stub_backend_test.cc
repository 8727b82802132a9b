// The backend without physics: joints on a stand, their actuators, contacts by law or script.
#include <gtest/gtest.h>

#include <stdexcept>

#include "hal/backends/stub.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/hal/actuator_test_support.h"

namespace footfall::tests {
namespace {

hal::StubSettings two_joints() {
  hal::StubSettings settings;
  settings.joints = 2;
  settings.contacts = 2;
  settings.period = 0.01;
  settings.inertia = 0.5;
  settings.start = {0.1, -0.2};
  settings.base = {0.0, 0.0, 0.84};
  return settings;
}

TEST(StubBackend, StartsWhereItWasTold) {
  hal::StubBackend stub(two_joints());
  stub.start();
  hal::Sensors sensors;
  EXPECT_TRUE(stub.read(sensors));
  EXPECT_DOUBLE_EQ(sensors.q[0], 0.1);
  EXPECT_DOUBLE_EQ(sensors.q[1], -0.2);
  EXPECT_DOUBLE_EQ(sensors.qd[0], 0.0);
  EXPECT_TRUE(sensors.has_truth);
  EXPECT_DOUBLE_EQ(sensors.p_WB[2], 0.84);
  EXPECT_EQ(sensors.time_ns, 0);
}

TEST(StubBackend, IntegratesAConstantTorqueExactly) {
  hal::StubBackend stub(two_joints());
  stub.start();
  hal::Sensors sensors;
  hal::Commands commands;
  commands.tau[0] = 1.0;  // 2 rad/s²
  for (int i = 0; i < 100; ++i) {
    stub.read(sensors);
    stub.write(commands);
  }
  stub.read(sensors);
  EXPECT_EQ(sensors.time_ns, 1'000'000'000);
  EXPECT_NEAR(sensors.q[0], 0.1 + 1.0, 1e-12);
  EXPECT_NEAR(sensors.qd[0], 2.0, 1e-12);
  EXPECT_DOUBLE_EQ(sensors.q[1], -0.2);
  EXPECT_DOUBLE_EQ(sensors.tau[0], 1.0);
}

TEST(StubBackend, ContactsFollowTheScript) {
  hal::StubSettings settings = two_joints();
  settings.contact_script = [](int contact, double time) { return contact == 0 || time > 0.015; };
  hal::StubBackend stub(settings);
  stub.start();
  hal::Sensors sensors;
  for (const bool expected : {false, false, true}) {
    stub.read(sensors);
    EXPECT_TRUE(sensors.contact[0]);
    EXPECT_EQ(sensors.contact[1], expected);
    stub.write({});
  }
}

TEST(StubBackend, WithoutAScriptAllContactsAreClosed) {
  hal::StubBackend stub(two_joints());
  stub.start();
  hal::Sensors sensors;
  stub.read(sensors);
  EXPECT_TRUE(sensors.contact[0]);
  EXPECT_TRUE(sensors.contact[1]);
  EXPECT_FALSE(sensors.contact[2]);
}

TEST(StubBackend, AfterASafeStopTorquesHaveNoEffect) {
  hal::StubBackend stub(two_joints());
  stub.start();
  stub.safe_stop();
  stub.safe_stop();
  hal::Commands commands;
  commands.tau[0] = 5.0;
  stub.write(commands);
  hal::Sensors sensors;
  stub.read(sensors);
  EXPECT_DOUBLE_EQ(sensors.tau[0], 0.0);
  EXPECT_DOUBLE_EQ(sensors.qd[0], 0.0);
}

TEST(StubBackend, ASecondStartBeginsAnew) {
  hal::StubBackend stub(two_joints());
  stub.start();
  hal::Commands commands;
  commands.tau[0] = 5.0;
  stub.write(commands);
  stub.safe_stop();
  stub.start();
  hal::Sensors sensors;
  stub.read(sensors);
  EXPECT_DOUBLE_EQ(sensors.q[0], 0.1);
  stub.write(commands);
  stub.read(sensors);
  EXPECT_GT(sensors.qd[0], 0.0);
}

TEST(StubBackend, RefusesSizesThatDoNotFit) {
  hal::StubSettings settings = two_joints();
  settings.joints = 1000;
  EXPECT_THROW(hal::StubBackend{settings}, std::runtime_error);
  settings = two_joints();
  settings.contacts = 1000;
  EXPECT_THROW(hal::StubBackend{settings}, std::runtime_error);
  settings = two_joints();
  settings.period = 0.0;
  EXPECT_THROW(hal::StubBackend{settings}, std::runtime_error);
  settings = two_joints();
  settings.inertia = -1.0;
  EXPECT_THROW(hal::StubBackend{settings}, std::runtime_error);
  settings = two_joints();
  settings.command_delay = -1;
  EXPECT_THROW(hal::StubBackend{settings}, std::runtime_error);
}

hal::StubSettings elastic_joints() {
  hal::StubSettings settings = two_joints();
  settings.period = 8.0 * kLoopStep;
  settings.inertia = 0.1;
  settings.stiffness = 2000.0;
  settings.damping = 20.0;
  settings.drive.emplace();
  settings.drive->joints.assign(2, {kKnee, kKnee.spring, kDirect});
  settings.drive->step = kLoopStep;
  settings.drive_steps = 8;
  return settings;
}

// With the direct loop's integral the torque comes to its reference; the stand's spring gives way
// by τ/k.
TEST(StubBackend, ASpringyJointOnAStandCarriesTheTorqueThatIsAskedFor) {
  hal::StubBackend stub(elastic_joints());
  stub.start();
  EXPECT_TRUE(stub.uses_torque_loop());
  hal::Sensors sensors;
  hal::Commands commands;
  commands.tau[0] = 40.0;
  for (int k = 0; k < 15000; ++k) {
    stub.read(sensors);
    stub.write(commands);
  }
  EXPECT_NEAR(sensors.tau[0], 40.0, 0.1);
  EXPECT_NEAR(sensors.q[0], 0.1 + 40.0 / 2000.0, 1e-4);
  EXPECT_TRUE(sensors.has_motors);
  EXPECT_NEAR(sensors.motor[0], sensors.q[0] + 40.0 / kKnee.spring, 1e-3);
  EXPECT_NEAR(sensors.motor_torque[0], 40.0, 0.1);  // at rest the motor carries it all
  EXPECT_NEAR(sensors.q[1], -0.2, 1e-12);
}

TEST(StubBackend, ADelayedCommandActsTicksLater) {
  hal::StubSettings settings = two_joints();
  settings.command_delay = 3;
  hal::StubBackend stub(settings);
  stub.start();
  hal::Sensors sensors;
  hal::Commands commands;
  commands.tau[0] = 1.0;
  for (int k = 0; k < 6; ++k) {
    stub.write(commands);
    stub.read(sensors);
    EXPECT_EQ(sensors.tau[0], k < 3 ? 0.0 : 1.0) << k;
  }
}

// A foot that the control law lets go of is in the air for the time of a swing, or until it is
// loaded; a law without any support (flight) leaves the feet as they are.
TEST(StubBackend, ContactsFollowTheControlLaw) {
  hal::StubSettings settings = two_joints();
  settings.swing = 0.045;  // 4.5 periods
  hal::StubBackend stub(settings);
  stub.start();
  hal::Sensors sensors;
  const auto closed = [&] {
    stub.write({});
    stub.read(sensors);
    return std::array{sensors.contact[0], sensors.contact[1]};
  };
  EXPECT_EQ(closed(), (std::array{true, true}));
  stub.set_support(0b01);
  for (int k = 0; k < 4; ++k) EXPECT_EQ(closed(), (std::array{true, false})) << k;
  stub.set_support(0);
  EXPECT_EQ(closed(), (std::array{true, true}));  // touchdown
  stub.set_support(0b11);
  stub.set_support(0b10);
  EXPECT_EQ(closed(), (std::array{false, true}));
  stub.set_support(0b11);
  EXPECT_EQ(closed(), (std::array{true, true}));
}

TEST(StubBackend, ReadingAndWritingAllocateNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  hal::StubBackend stub(two_joints());
  stub.start();
  hal::Sensors sensors;
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    stub.read(sensors);
    stub.write({});
  }
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
