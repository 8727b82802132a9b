// Columns of the logged inputs, and the way there and back.
#include "engine/tick/input_row.h"

#include <gtest/gtest.h>

#include <bit>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace footfall::engine {
namespace {

// Two joints and one contact, written out: the order of the columns is the log's format.
TEST(InputLayout, ColumnsKeepTheirNamesAndOrder) {
  const InputLayout layout({{"hip", "knee"}, {"foot"}});
  const std::vector<std::string> names = {
      "command.hip",      "command.knee", "time_ns",      "flags",           "qd.hip",
      "qd.knee",          "q.hip",        "q.knee",       "tau.hip",         "tau.knee",
      "gyro.x",           "gyro.y",       "gyro.z",       "accelerometer.x", "accelerometer.y",
      "accelerometer.z",  "force.foot.x", "force.foot.y", "force.foot.z",    "v_WB.x",
      "v_WB.y",           "v_WB.z",       "p_WB.x",       "p_WB.y",          "p_WB.z",
      "q_WB.w",           "q_WB.x",       "q_WB.y",       "q_WB.z",          "w_WB_B.x",
      "w_WB_B.y",         "w_WB_B.z",     "motor.hip",    "motor.knee",      "motor_torque.hip",
      "motor_torque.knee"};
  EXPECT_EQ(layout.names(), names);
}

// What only estimators need stands behind the rest.
TEST(InputLayout, MarkersAndTruthsHaveColumnsWhereTheStateIsEstimated) {
  const InputLayout without({{"hip"}, {"foot"}});
  const InputLayout layout(
      {.joints = {"hip"}, .contacts = {"foot"}, .markers = {"a", "b"}, .estimation = true});
  const std::vector<std::string> more = {"marker.a.x",
                                         "marker.a.y",
                                         "marker.a.z",
                                         "marker.b.x",
                                         "marker.b.y",
                                         "marker.b.z",
                                         "mocap_age",
                                         "true_qd.hip",
                                         "true_q.hip",
                                         "true_com_velocity.x",
                                         "true_com_velocity.y",
                                         "true_com_velocity.z",
                                         "true_com.x",
                                         "true_com.y",
                                         "true_com.z",
                                         "true_gyro_bias.x",
                                         "true_gyro_bias.y",
                                         "true_gyro_bias.z",
                                         "true_accelerometer_bias.x",
                                         "true_accelerometer_bias.y",
                                         "true_accelerometer_bias.z"};
  std::vector<std::string> names = without.names();
  names.insert(names.end(), more.begin(), more.end());
  EXPECT_EQ(layout.names(), names);
}

// Distinct values return through a row, those of a hidden marker too.
TEST(InputLayout, AFrameOfMotionCaptureReturnsBitForBit) {
  const InputLayout layout(
      {.joints = {"hip"}, .contacts = {"foot"}, .markers = {"a", "b"}, .estimation = true});
  hal::Sensors sensors, back;
  sensors.marker[0] = {0.1, 0.2, 0.3};
  sensors.marker[1] = {0.4, 0.5, 0.6};
  sensors.marker_seen[1] = true;
  sensors.mocap_age = 0.005;
  sensors.sensor_truth = true;
  sensors.true_q[0] = 0.7;
  sensors.true_accelerometer_bias = {0.8, 0.9, 1.0};
  sensors.has_motors = true;
  std::vector<std::uint64_t> row(static_cast<std::size_t>(layout.columns()));
  hal::Commands commands;
  layout.pack(sensors, true, commands, row.data());
  EXPECT_EQ(row[2] & (std::uint64_t{3} << 40U), std::uint64_t{2} << 40U);  // flags
  layout.unpack(row.data(), back, commands);
  EXPECT_EQ(back.marker, sensors.marker);
  EXPECT_EQ(back.marker_seen, sensors.marker_seen);
  EXPECT_EQ(back.mocap_age, sensors.mocap_age);
  EXPECT_TRUE(back.sensor_truth);
  EXPECT_TRUE(back.has_motors);
  EXPECT_EQ(back.true_q, sensors.true_q);
  EXPECT_EQ(back.true_accelerometer_bias, sensors.true_accelerometer_bias);
}

TEST(InputLayout, PositionsAreTheIntegralsOfTheirVelocities) {
  const InputLayout layout({{"hip", "knee"}, {"foot"}});
  const std::vector<std::pair<int, int>> pairs = {{4, 6}, {5, 7}, {19, 22}, {20, 23}, {21, 24}};
  EXPECT_EQ(layout.integrals(), pairs);
  EXPECT_EQ(layout.quaternions(), std::vector<int>{25});
}

TEST(InputLayout, FlagsHaveTheBitsOfTheLogFormat) {
  const InputLayout layout({{"hip"}, {"left", "right"}});
  std::vector<std::uint64_t> row(static_cast<std::size_t>(layout.columns()));
  hal::Sensors sensors;
  sensors.imu_fresh = sensors.mocap_fresh = false;
  const auto flags = [&](bool fresh) {
    layout.pack(sensors, fresh, {}, row.data());
    return row[2];
  };
  EXPECT_EQ(flags(false), 0u);
  EXPECT_EQ(flags(true), 1u);
  sensors.has_truth = true;
  EXPECT_EQ(flags(false), 2u);
  sensors.body_contact = true;
  EXPECT_EQ(flags(false), 2u + 4u);
  sensors.backend_fault = true;
  EXPECT_EQ(flags(false), 2u + 4u + 8u);
  sensors.imu_fresh = true;
  EXPECT_EQ(flags(false), 2u + 4u + 8u + 16u);
  sensors.mocap_fresh = true;
  EXPECT_EQ(flags(false), 2u + 4u + 8u + 16u + 32u);
  sensors.has_motors = true;
  EXPECT_EQ(flags(false), 2u + 4u + 8u + 16u + 32u + 72'057'594'037'927'936u);
  sensors.has_motors = false;
  sensors.contact[1] = true;
  EXPECT_EQ(flags(false), 2u + 4u + 8u + 16u + 32u + 512u);
  sensors.contact[0] = true;
  EXPECT_EQ(flags(true), 1u + 2u + 4u + 8u + 16u + 32u + 256u + 512u);
}

// Distinct bits in every word: what a row holds is what unpack() and pack() return.
TEST(InputLayout, ARowReturnsBitForBit) {
  const InputLayout layout({{"hip", "knee", "ankle"}, {"left", "right"}});
  std::vector<std::uint64_t> row, back(static_cast<std::size_t>(layout.columns()));
  for (std::uint64_t k = 0; k < back.size(); ++k) row.push_back(0x7ff8'0000'0000'0001U + 3 * k);
  row[4] = 1 + 2 + 16 + 512;  // flags, behind three commands and the time
  hal::Sensors sensors;
  hal::Commands commands;
  EXPECT_TRUE(layout.unpack(row.data(), sensors, commands));
  EXPECT_TRUE(sensors.contact[1]);
  EXPECT_FALSE(sensors.contact[0]);
  EXPECT_EQ(std::bit_cast<std::uint64_t>(commands.tau[2]), row[2]);
  EXPECT_EQ(sensors.time_ns, static_cast<std::int64_t>(row[3]));
  layout.pack(sensors, true, commands, back.data());
  EXPECT_EQ(back, row);
}

std::string row_of(std::string_view name, std::string_view parts, std::string_view unit) {
  return "| `" + std::string(name) + std::string(parts) + "` | " + std::string(unit) + " |\n";
}

template <typename Value>
std::string parts_of() {
  if constexpr (std::is_same_v<Value, double>) {
    return "";
  } else {
    constexpr std::size_t kSize = std::tuple_size_v<Value>;
    return (kSize == core::kMaxJoints     ? ".JOINT"
            : kSize == core::kMaxContacts ? ".CONTACT"
            : kSize == core::kMaxMarkers  ? ".MARKER"
            : kSize == 4                  ? ".w x y z"
                                          : ".x y z") +
           parts_of<typename Value::value_type>();
  }
}

TEST(InputLayout, TheDocumentOfTheLogHasEveryColumnAndFlag) {
  std::string table;
  const auto add = [&]<typename Owner, typename Value>(const hal::NumberField<Owner, Value>& f) {
    table += row_of(f.name, parts_of<Value>(), f.unit);
  };
  hal::for_each_field(hal::kCommandFields, add);
  table += row_of("time_ns", "", "ns, integer") + row_of("flags", "", "integer");
  hal::for_each_field(hal::kSensorFields, add);
  std::string flags = "| 1 | something new arrived |\n";
  hal::for_each_field(hal::kFlagFields, [&]<typename Value>(const hal::FlagField<Value>& f) {
    const char* each = "";
    if constexpr (!std::is_same_v<Value, bool>) {
      each = std::tuple_size_v<Value> == core::kMaxMarkers ? " << m" : " << c";
    }
    flags += "| " + std::to_string(f.bit) + each + " | " + std::string(f.doc) + " |\n";
  });
  std::ifstream in(FOOTFALL_SOURCE_DIR "/docs/log.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find(table), std::string::npos) << "docs/log.md needs this table:\n" << table;
  EXPECT_NE(text.find(flags), std::string::npos) << "docs/log.md needs this table:\n" << flags;
}

}  // namespace
}  // namespace footfall::engine
