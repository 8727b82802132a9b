// Sensors that fail on purpose keep their last value, group by group.
#include <gtest/gtest.h>

#include <algorithm>

#include "hal/sensors/faults.h"

namespace footfall::hal {
namespace {

// Each number of a tick is the tick's, each flag is set.
Sensors sensors_of(double tick) {
  Sensors s;
  s.time_ns = static_cast<std::int64_t>(tick);
  s.q.fill(tick);
  s.qd.fill(tick + 0.1);
  s.tau.fill(tick + 0.2);
  s.gyro.fill(tick + 0.3);
  s.accelerometer.fill(tick + 0.4);
  s.contact.fill(true);
  s.force.fill({tick, tick, tick});
  s.has_truth = s.body_contact = s.backend_fault = true;
  s.p_WB.fill(tick);
  s.q_WB.fill(tick);
  s.v_WB.fill(tick);
  s.w_WB_B.fill(tick);
  return s;
}

class Counting final : public Hardware {
 public:
  std::string name() const override { return "counting"; }
  void start() override {}
  bool read(Sensors& sensors) noexcept override {
    sensors = sensors_of(++tick);
    return true;
  }
  void write(const Commands&) noexcept override {}
  void safe_stop() noexcept override {}
  double tick = 0.0;
};

class SensorFaultsTest : public testing::Test {
 protected:
  // Read once with all sensors well, once while `group` fails.
  Sensors read_while_failing(SensorGroup group, bool* fresh = nullptr) {
    sensors_.read(seen_);
    sensors_.fail(group, true);
    const bool result = sensors_.read(seen_);
    if (fresh != nullptr) *fresh = result;
    return seen_;
  }
  Counting real_;
  SensorFaults sensors_{real_};
  Sensors seen_;
};

TEST_F(SensorFaultsTest, AnImuThatFailsKeepsItsValuesAndIsNotFresh) {
  const Sensors s = read_while_failing(SensorGroup::imu);
  EXPECT_EQ(s.gyro[0], 1.3);
  EXPECT_EQ(s.accelerometer[2], 1.4);
  EXPECT_FALSE(s.imu_fresh);
  EXPECT_EQ(s.q[0], 2.0);
  EXPECT_EQ(s.time_ns, 2);
  EXPECT_TRUE(s.mocap_fresh);
  sensors_.fail(SensorGroup::imu, false);
  sensors_.read(seen_);
  EXPECT_EQ(seen_.gyro[0], 3.3);
  EXPECT_TRUE(seen_.imu_fresh);
}

TEST_F(SensorFaultsTest, JointsThatFailKeepTheirValuesWhileTheOthersGoOn) {
  const Sensors s = read_while_failing(SensorGroup::joints);
  EXPECT_EQ(s.q[63], 1.0);
  EXPECT_EQ(s.qd[0], 1.1);
  EXPECT_EQ(s.tau[0], 1.2);
  EXPECT_EQ(s.gyro[0], 2.3);
  EXPECT_EQ(s.force[0][1], 2.0);
}

TEST_F(SensorFaultsTest, ATruthThatFailsIsNotKnown) {
  const Sensors s = read_while_failing(SensorGroup::truth);
  EXPECT_FALSE(s.has_truth);
  EXPECT_EQ(s.p_WB[0], 1.0);
  EXPECT_TRUE(s.body_contact);
}

TEST_F(SensorFaultsTest, NothingNewArrivesWhenAllSensorsFail) {
  bool fresh = true;
  const Sensors s = read_while_failing(SensorGroup::all, &fresh);
  EXPECT_FALSE(fresh);
  EXPECT_EQ(s.time_ns, 1);
  EXPECT_EQ(s.q[0], 1.0);
}

TEST_F(SensorFaultsTest, EveryFieldIsReadWhileNoneFails) {
  sensors_.read(seen_);
  const Sensors want = sensors_of(1.0);
  for_each_field(kSensorFields, [&](const auto& field) {
    EXPECT_EQ(seen_.*field.member, want.*field.member) << field.name;
  });
  for_each_field(kFlagFields, [&](const auto& field) {
    EXPECT_EQ(seen_.*field.member, want.*field.member) << field.doc;
  });
}

TEST_F(SensorFaultsTest, AnImuThatIsFrozenKeepsItsValuesAndIsSaidToBeNew) {
  sensors_.read(seen_);
  sensors_.freeze(SensorGroup::imu, true);
  sensors_.read(seen_);
  EXPECT_EQ(seen_.gyro[0], 1.3);
  EXPECT_EQ(seen_.accelerometer[2], 1.4);
  EXPECT_TRUE(seen_.imu_fresh);
  EXPECT_EQ(seen_.q[0], 2.0);
  sensors_.freeze(SensorGroup::imu, false);
  sensors_.read(seen_);
  EXPECT_EQ(seen_.gyro[0], 3.3);
}

TEST_F(SensorFaultsTest, WhereMarkersAreLostTwoAreSeenAtMost) {
  class ThreeMarkers final : public Hardware {
   public:
    std::string name() const override { return "three"; }
    void start() override {}
    bool read(Sensors& sensors) noexcept override {
      sensors.marker_seen = {false, true, true, true};
      return true;
    }
    void write(const Commands&) noexcept override {}
    void safe_stop() noexcept override {}
  } real;
  SensorFaults sensors(real);
  Sensors s;
  sensors.hide_markers(true);
  sensors.read(s);
  EXPECT_EQ(std::ranges::count(s.marker_seen, true), 2);
  EXPECT_TRUE(s.mocap_fresh);
  sensors.hide_markers(false);
  sensors.read(s);
  EXPECT_EQ(std::ranges::count(s.marker_seen, true), 3);
}

}  // namespace
}  // namespace footfall::hal
