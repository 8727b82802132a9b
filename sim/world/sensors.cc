// Reading and checking of sensor errors; see sensors.h.
#include "sim/world/sensors.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "core/yaml/value_reader.h"
#include "hal/sensors/mocap.h"
#include "sim/world/keys.h"

namespace footfall::sim {
namespace {

using core::Diagnostics;
using core::YamlNode;

struct InertialBounds {
  double noise, bias, walk;
};

// Far beyond every real sensor: a larger number is a unit or an exponent gone wrong.
constexpr double kLargestCount = 0.1;                              // rad, of an encoder
constexpr InertialBounds kGyroBounds{10.0, 1.0, 1.0};              // rad/s
constexpr InertialBounds kAccelerometerBounds{100.0, 10.0, 10.0};  // m/s^2
constexpr double kLargestMiss = 0.1;                               // m, of a marker
constexpr double kMostLost = 0.99;                                 // of what motion capture sees
constexpr double kLargestThreshold = 1e4;                          // N, of a foot switch
constexpr double kLongestWait = 1.0;                               // s, of a report
constexpr double kLargestTurn = 0.1;  // rad, three of them are still a small rotation
constexpr double kFastestFrames = 1e4, kSlowestFrames = 1e-2;  // Hz
constexpr double kShortestSpell = 1e-6, kLongestSpell = 1e3;   // s

struct ErrorKey {
  std::string_view name;
  core::Dimension dimension;
  double least, most;
  double* out;
  std::string_view what = {};
};

class SensorReader {
 public:
  SensorReader(SensorSettings& sensors, Diagnostics& diagnostics)
      : sensors_(sensors), diagnostics_(diagnostics) {}

  void section(const YamlNode& node, const std::string& name, const core::KeyTable& table,
               const std::vector<ErrorKey>& keys) {
    const YamlNode* const map = node.find(name);
    if (map == nullptr) return;
    if (!core::expect_map(*map, fmt::format("a map of the imperfections of '{}'", name),
                          diagnostics_)) {
      return;
    }
    core::check_keys(*map, table, diagnostics_);
    for (const ErrorKey& key : keys) {
      const YamlNode* const value = map->find(key.name);
      if (value == nullptr) continue;
      *key.out =
          core::read_bounded(*value, key.dimension, key.least, key.most, diagnostics_, key.what)
              .value_or(*key.out);
      sensors_.keys.push_back(
          {fmt::format("{}.{}", name, key.name), diagnostics_.file(value->mark.file), value->mark});
    }
  }

  void inertial(const YamlNode& node, const std::string& name, const core::KeyTable& table,
                core::Dimension dimension, std::string_view what, const InertialBounds& most,
                hal::InertialErrors& out) {
    section(node, name, table,
            {{"noise", dimension, 0.0, most.noise, &out.noise, what},
             {"bias", dimension, 0.0, most.bias, &out.bias, what},
             {"walk", dimension, 0.0, most.walk, &out.walk, what}});
  }

  // Values of one file that nothing depends on; over those of a base they may stay.
  void refuse_idle_values() {
    const hal::MocapErrors& mocap = sensors_.errors.mocap;
    const auto find = [this](std::string_view name) {
      return std::ranges::find(sensors_.keys, name, &SensorSettings::Key::name);
    };
    const auto spell = find("mocap.spell"), occlusion = find("mocap.occlusion");
    if (spell != sensors_.keys.end() && !(mocap.occlusion > 0.0) &&
        (occlusion == sensors_.keys.end() || occlusion->file == spell->file)) {
      diagnostics_.error(spell->mark, "unsupported",
                         "'spell' has no effect: expected 'occlusion' above zero beside it");
    }
    const double frames = mocap.delay * std::max(mocap.rate, 1.0);
    if (const auto delay = find("mocap.delay");
        delay != sensors_.keys.end() && frames > hal::Mocap::kLongestLine - 2) {
      diagnostics_.error(delay->mark, "out-of-range",
                         fmt::format("{:g} frames would be on their way: expected a delay of at "
                                     "most {:g} s at this rate",
                                     frames, (hal::Mocap::kLongestLine - 2) / mocap.rate));
    }
  }

 private:
  SensorSettings& sensors_;
  Diagnostics& diagnostics_;
};

bool is_of(std::string_view name, std::string_view sensor) {
  return name.starts_with(sensor) && name[sensor.size()] == '.';
}

}  // namespace

void read_sensors(const YamlNode& node, SensorSettings& sensors, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "a map of sensors", diagnostics)) return;
  core::check_keys(node, kWorldSensorsKeys, diagnostics);
  SensorReader reader(sensors, diagnostics);
  hal::SensorErrors& errors = sensors.errors;
  reader.section(
      node, "joint", kJointSensorKeys,
      {{"resolution", core::kNone, 0.0, kLargestCount, &errors.joint_resolution, "an angle"}});
  reader.inertial(node, "gyro", kGyroKeys, core::kRate, "an angular velocity", kGyroBounds,
                  errors.imu.gyro);
  reader.inertial(node, "accelerometer", kAccelerometerKeys, core::kAcceleration, {},
                  kAccelerometerBounds, errors.imu.accelerometer);
  reader.section(node, "imu", kImuSensorKeys,
                 {{"mount", core::kNone, 0.0, kLargestTurn, &errors.imu.mount, "an angle"}});
  hal::MocapErrors& mocap = errors.mocap;
  reader.section(
      node, "mocap", kMocapSensorKeys,
      {{"rate", core::kRate, kSlowestFrames, kFastestFrames, &mocap.rate, "a rate in Hz"},
       {"delay", core::kTime, 0.0, kLongestWait, &mocap.delay},
       {"noise", core::kLength, 0.0, kLargestMiss, &mocap.noise},
       {"occlusion", core::kNone, 0.0, kMostLost, &mocap.occlusion},
       {"spell", core::kTime, kShortestSpell, kLongestSpell, &mocap.spell},
       {"dropped", core::kNone, 0.0, kMostLost, &mocap.dropped},
       {"placement", core::kLength, 0.0, kLargestMiss, &mocap.placement}});
  hal::SwitchErrors& switches = errors.switches;
  reader.section(node, "switch", kSwitchKeys,
                 {{"delay", core::kTime, 0.0, kLongestWait, &switches.delay},
                  {"jitter", core::kTime, 0.0, kLongestWait, &switches.jitter},
                  {"threshold", core::kForce, 0.0, kLargestThreshold, &switches.threshold},
                  {"bounce", core::kTime, 0.0, kLongestWait, &switches.bounce}});
  reader.refuse_idle_values();
}

void check_sensors(const SensorSettings& sensors, const model::RobotDescription& robot,
                   Diagnostics& diagnostics) {
  const auto tell = [&](std::string_view sensor, const char* lacking, const char* declaration) {
    for (const SensorSettings::Key& key : sensors.keys) {
      if (!is_of(key.name, sensor)) continue;
      core::Mark mark = key.mark;
      mark.file = diagnostics.add_file(key.file);
      diagnostics.warning(mark, "no-sensor",
                          fmt::format("'sensors: {{{}}}' has no effect: robot '{}' has no {} "
                                      "('sensors: {{{}}}' of its file)",
                                      sensor, robot.name, lacking, declaration));
      return;
    }
  };
  if (robot.sensors.imu_site.empty()) {
    for (const char* sensor : {"gyro", "accelerometer", "imu"}) {
      tell(sensor, "IMU", "imu: {site: NAME}");
    }
  }
  if (robot.sensors.mocap_sites.empty()) {
    tell("mocap", "markers of motion capture", "mocap: {sites: [NAME, ...]}");
  }
  if (robot.sensors.switches.empty()) tell("switch", "foot switches", "switches: [CONTACT, ...]");
}

hal::SensorPlaces sensor_places(const model::SensorMounts& mounts,
                                const model::RobotDescription& robot) {
  hal::SensorPlaces places;
  places.joints = robot.joint_count();
  places.contacts = static_cast<int>(robot.contacts.size());
  for (const int contact : robot.sensors.switches) {
    places.has_switch[static_cast<std::size_t>(contact)] = true;
  }
  places.has_imu = mounts.has_imu;
  places.p_BI = mounts.p_BI;
  places.R_BI = mounts.R_BI;
  places.markers = static_cast<int>(mounts.markers.size());
  for (std::size_t m = 0; m < mounts.markers.size(); ++m) places.p_BM[m] = mounts.markers[m].p_BM;
  return places;
}

}  // namespace footfall::sim
