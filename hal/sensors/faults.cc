// Sensors that fail on purpose; see faults.h.
#include "hal/sensors/faults.h"

namespace footfall::hal {

void SensorFaults::start() {
  failing_ = frozen_ = {};
  hidden_ = false;
  real_.start();
}

bool SensorFaults::read(Sensors& sensors) noexcept {
  const bool fresh = real_.read(fresh_);
  if (failing(SensorGroup::all)) return false;
  sensors.time_ns = fresh_.time_ns;
  for_each_field(kSensorFields, [&](const auto& field) {
    if (failing(field.group) || frozen(field.group)) return;
    sensors.*field.member = fresh_.*field.member;
  });
  for_each_field(kFlagFields, [&](const auto& field) {
    if (failing(field.group)) {
      if (field.validity) sensors.*field.member = {};
    } else if (field.validity || !frozen(field.group)) {
      sensors.*field.member = fresh_.*field.member;
    }
  });
  int seen = 0;
  for (bool& marker : sensors.marker_seen) {
    if (hidden_ && marker && ++seen > static_cast<int>(kFewMarkers)) marker = false;
  }
  return fresh;
}

}  // namespace footfall::hal
