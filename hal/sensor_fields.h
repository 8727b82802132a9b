// What is measured and commanded in a tick, and one table of it: the columns of the log, replay,
// and sensors that fail on purpose derive from the table. A member without a row does not compile
// (sensor_fields.cc).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/capacities.h"

namespace footfall::hal {

// Measured once a tick. Arrays have the order of the robot file; unused entries are 0.
struct Sensors {
  std::int64_t time_ns = 0;                                       // backend's clock at sampling
  std::array<double, core::kMaxJoints> q{};                       // joint position, rad
  std::array<double, core::kMaxJoints> qd{};                      // joint velocity, rad/s
  std::array<double, core::kMaxJoints> tau{};                     // joint torque measured, N m
  std::array<double, 3> gyro{};                                   // rad/s, IMU frame
  std::array<double, 3> accelerometer{};                          // m/s^2, IMU frame
  std::array<bool, core::kMaxContacts> contact{};                 // foot switch closed
  std::array<std::array<double, 3>, core::kMaxContacts> force{};  // N, ground on robot, world

  // Of series-elastic actuators, seen from the joint; else 0, and `has_motors` is false.
  std::array<double, core::kMaxJoints> motor{};         // motor angle, rad
  std::array<double, core::kMaxJoints> motor_torque{};  // N m, mean since the last tick
  bool has_motors = false;                              // the two above are reported

  bool imu_fresh = true;    // new IMU data arrived
  bool mocap_fresh = true;  // a frame of motion capture arrived: the three members below are new
  std::array<std::array<double, 3>, core::kMaxMarkers> marker{};  // m, world
  std::array<bool, core::kMaxMarkers> marker_seen{};              // false: hidden, position unknown
  double mocap_age = 0.0;                                         // s, from exposure to this tick

  bool has_truth = false;                  // a simulator provides the base's true state below
  std::array<double, 3> p_WB{};            // base origin, m, world
  std::array<double, 4> q_WB{1, 0, 0, 0};  // base orientation, w x y z
  std::array<double, 3> v_WB{};            // velocity of the base origin, m/s, world
  std::array<double, 3> w_WB_B{};          // angular velocity, rad/s, base frame
  // The truth where sensors have errors: then `sensor_truth` is set.
  bool sensor_truth = false;
  std::array<double, core::kMaxJoints> true_q{};    // rad
  std::array<double, core::kMaxJoints> true_qd{};   // rad/s
  std::array<double, 3> true_com{};                 // m, world
  std::array<double, 3> true_com_velocity{};        // m/s, world
  std::array<double, 3> true_gyro_bias{};           // rad/s, IMU frame
  std::array<double, 3> true_accelerometer_bias{};  // m/s^2, IMU frame

  std::array<double, 3> aid_force{};  // N, of external aids on the robot, world, mean over the tick
                                      // (simulator)
  bool body_contact = false;          // a body other than a declared contact touches (simulator)
  bool backend_fault = false;         // the backend raised a warning or reset itself (simulator)
  bool motor_saturated = false;       // a motor gave less than its torque loop asked for
};

// Written once a tick.
struct Commands {
  std::array<double, core::kMaxJoints> tau{};  // joint torque, N m
};

// Sensors that fail together: their fields then keep the last value.
enum class SensorGroup : std::uint8_t {
  joints,    // encoders and torque sensors
  imu,       // gyroscope and accelerometer
  contacts,  // foot switches and force sensors
  mocap,     // motion capture
  truth,     // the base's true state, of a simulator
  backend,   // the backend's own reports
  all,       // everything: read() reports that nothing new arrived
  count,
};

// One number, or an array of them: by joint (kMaxJoints), by contact (kMaxContacts), by marker
// (kMaxMarkers), x y z (3), a unit quaternion w x y z (4), or an array of such arrays.
template <typename Owner, typename Value>
struct NumberField {
  Value Owner::*member;
  std::string_view name;  // stem of its columns in the log: q.JOINT, force.CONTACT.x
  std::string_view unit;  // SI
  SensorGroup group = SensorGroup::backend;
  std::string_view rate = {};  // name of the field that is its derivative; empty: none
  // Only estimators need it: it has columns in the log where the state is estimated, or sensors
  // have errors.
  bool estimation = false;
  // Of external aids: it has columns where the world has some.
  bool aids = false;
};

// A truth value, or one by contact or marker.
template <typename Value>
struct FlagField {
  Value Sensors::*member;
  std::uint64_t bit;  // in the column `flags`; that of contact or marker k is bit << k
  std::string_view doc;
  SensorGroup group;
  bool validity = false;  // false while its group fails; else it keeps the last value, too
};

// In the order of the log's columns: new rows go to the end.
inline constexpr std::tuple kCommandFields{
    NumberField{&Commands::tau, "command", "N m"},
};
inline constexpr std::tuple kSensorFields{
    NumberField{&Sensors::qd, "qd", "rad/s", SensorGroup::joints},
    NumberField{&Sensors::q, "q", "rad", SensorGroup::joints, "qd"},
    NumberField{&Sensors::tau, "tau", "N m", SensorGroup::joints},
    NumberField{&Sensors::gyro, "gyro", "rad/s", SensorGroup::imu},
    NumberField{&Sensors::accelerometer, "accelerometer", "m/s^2", SensorGroup::imu},
    NumberField{&Sensors::force, "force", "N", SensorGroup::contacts},
    NumberField{&Sensors::v_WB, "v_WB", "m/s", SensorGroup::truth},
    NumberField{&Sensors::p_WB, "p_WB", "m", SensorGroup::truth, "v_WB"},
    NumberField{&Sensors::q_WB, "q_WB", "", SensorGroup::truth},
    NumberField{&Sensors::w_WB_B, "w_WB_B", "rad/s", SensorGroup::truth},
    NumberField{&Sensors::motor, "motor", "rad", SensorGroup::joints},
    NumberField{&Sensors::motor_torque, "motor_torque", "N m", SensorGroup::joints},
    NumberField{&Sensors::marker, "marker", "m", SensorGroup::mocap, {}, true},
    NumberField{&Sensors::mocap_age, "mocap_age", "s", SensorGroup::mocap, {}, true},
    NumberField{&Sensors::true_qd, "true_qd", "rad/s", SensorGroup::truth, {}, true},
    NumberField{&Sensors::true_q, "true_q", "rad", SensorGroup::truth, "true_qd", true},
    NumberField{
        &Sensors::true_com_velocity, "true_com_velocity", "m/s", SensorGroup::truth, {}, true},
    NumberField{&Sensors::true_com, "true_com", "m", SensorGroup::truth, "true_com_velocity", true},
    NumberField{&Sensors::true_gyro_bias, "true_gyro_bias", "rad/s", SensorGroup::truth, {}, true},
    NumberField{&Sensors::true_accelerometer_bias,
                "true_accelerometer_bias",
                "m/s^2",
                SensorGroup::truth,
                {},
                true},
    NumberField{&Sensors::aid_force, "aid_force", "N", SensorGroup::backend, {}, false, true},
};
// Bit 1 is of the read as a whole: something new arrived.
inline constexpr std::uint64_t kFreshBit = 1;
inline constexpr std::tuple kFlagFields{
    FlagField{&Sensors::has_truth, 2, "the base's true state is known", SensorGroup::truth, true},
    FlagField{&Sensors::body_contact, 4, "another body touches", SensorGroup::backend},
    FlagField{&Sensors::backend_fault, 8, "the backend has a fault", SensorGroup::backend},
    FlagField{&Sensors::imu_fresh, 16, "the IMU's data are new", SensorGroup::imu, true},
    FlagField{&Sensors::mocap_fresh, 32, "motion capture's data are new", SensorGroup::mocap, true},
    FlagField{&Sensors::motor_saturated, 64, "a motor gave less than its loop asked for",
              SensorGroup::joints},
    FlagField{&Sensors::sensor_truth, 128, "sensors have errors; the truth is known",
              SensorGroup::truth, true},
    FlagField{&Sensors::contact, 256, "contact c is closed", SensorGroup::contacts},
    FlagField{&Sensors::marker_seen, std::uint64_t{1} << 40U, "marker m is seen",
              SensorGroup::mocap},
    FlagField{&Sensors::has_motors, std::uint64_t{1} << 56U, "the joints' motors are reported",
              SensorGroup::joints},
};

// Calls visit(field) for each row of a table.
template <typename Table, typename Visit>
constexpr void for_each_field(const Table& table, Visit&& visit) {
  std::apply([&](const auto&... field) { (visit(field), ...); }, table);
}

}  // namespace footfall::hal
