// Where a robot's IMU and markers are on its floating base.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/robot/description.h"

struct mjModel_;

namespace footfall::model {

struct Marker {
  std::string name;              // of its site
  std::array<double, 3> p_BM{};  // m, base frame
};

struct SensorMounts {
  bool has_imu = false;
  std::array<double, 3> p_BI{};                           // m, base frame
  std::array<double, 9> R_BI{1, 0, 0, 0, 1, 0, 0, 0, 1};  // row-major, from IMU to base axes
  std::vector<Marker> markers;                            // in the model's order
};

// Throws std::runtime_error with one clear sentence for a site that the model lacks or that is not
// on the floating base, a pattern without a match, and more markers than core::kMaxMarkers.
SensorMounts sensor_mounts(const mjModel_& model, const RobotDescription& robot);
// The same of the robot's own model file.
SensorMounts sensor_mounts(const RobotDescription& robot);

}  // namespace footfall::model
