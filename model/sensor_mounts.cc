// Sites of the model; see sensor_mounts.h.
#include "model/sensor_mounts.h"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "core/capacities.h"
#include "core/yaml/glob.h"
#include "model/mjcf.h"

namespace footfall::model {
namespace {

[[noreturn]] void refuse(const RobotDescription& robot, const std::string& what) {
  throw std::runtime_error(robot.path + ": error: " + what);
}

void require_on_base(const mjModel& m, const RobotDescription& robot, int site,
                     const std::string& what) {
  const int base = mj_name2id(&m, mjOBJ_BODY, robot.floating_base.c_str());
  if (m.site_bodyid[site] == base) return;
  refuse(robot, what + " is not on the floating base '" + robot.floating_base + "'");
}

}  // namespace

SensorMounts sensor_mounts(const mjModel& m, const RobotDescription& robot) {
  SensorMounts mounts;
  if (const std::string& name = robot.sensors.imu_site; !name.empty()) {
    const int site = mj_name2id(&m, mjOBJ_SITE, name.c_str());
    if (site < 0) refuse(robot, "sensors: no site '" + name + "' in " + robot.model_path);
    require_on_base(m, robot, site, "the IMU's site '" + name + "'");
    mounts.has_imu = true;
    std::copy_n(m.site_pos + 3 * site, 3, mounts.p_BI.begin());
    mju_quat2Mat(mounts.R_BI.data(), m.site_quat + 4 * site);
  }
  std::vector<int> chosen;
  for (const std::string& pattern : robot.sensors.mocap_sites) {
    bool found = false;
    for (int site = 0; site < m.nsite; ++site) {
      const char* const name = mj_id2name(&m, mjOBJ_SITE, site);
      if (name == nullptr || !core::glob_matches(pattern, name)) continue;
      found = true;
      if (std::ranges::find(chosen, site) == chosen.end()) chosen.push_back(site);
    }
    if (!found) refuse(robot, "sensors: no site '" + pattern + "' in " + robot.model_path);
  }
  if (chosen.size() > static_cast<std::size_t>(core::kMaxMarkers)) {
    refuse(robot, "more than " + std::to_string(core::kMaxMarkers) + " markers");
  }
  for (const int site : chosen) {
    Marker marker;
    marker.name = mj_id2name(&m, mjOBJ_SITE, site);
    require_on_base(m, robot, site, "the marker '" + marker.name + "'");
    std::copy_n(m.site_pos + 3 * site, 3, marker.p_BM.begin());
    mounts.markers.push_back(std::move(marker));
  }
  return mounts;
}

SensorMounts sensor_mounts(const RobotDescription& robot) {
  struct Deleter {
    void operator()(mjModel* m) const { mj_deleteModel(m); }
  };
  const std::unique_ptr<mjModel, Deleter> model(load_robot_model(robot.model_path));
  return sensor_mounts(*model, robot);
}

}  // namespace footfall::model
