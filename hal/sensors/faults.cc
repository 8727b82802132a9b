// Sensors that fail on purpose; see faults.h.
#include "hal/sensors/faults.h"

namespace footfall::hal {

void SensorFaults::start() {
  failing_ = {};
  real_.start();
}

// What a simulator tells beside its sensors (truth, warnings) goes on unless all fails.
bool SensorFaults::read(Sensors& sensors) noexcept {
  const bool fresh = real_.read(fresh_);
  if (failing(SensorGroup::all)) return false;
  const auto gyro = sensors.gyro;
  const auto accelerometer = sensors.accelerometer;
  sensors = fresh_;
  if (failing(SensorGroup::imu)) {
    sensors.gyro = gyro;
    sensors.accelerometer = accelerometer;
    sensors.imu_fresh = false;
  }
  if (failing(SensorGroup::mocap)) sensors.mocap_fresh = false;
  return fresh;
}

}  // namespace footfall::hal
