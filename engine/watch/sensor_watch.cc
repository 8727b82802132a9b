// Ages, frozen data, the clock and values that are not finite; see sensor_watch.h.
#include "engine/watch/sensor_watch.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "behaviors/language/estimators.h"
#include "core/same_bits.h"

namespace footfall::engine {
namespace {

constexpr std::int64_t kClockJump = 10;  // ticks
constexpr int kFewestMarkers = 3;        // fewer do not tell an attitude

bool same(std::span<const double> a, std::span<const double> b) noexcept {
  return std::equal(a.begin(), a.end(), b.begin(),
                    [](double x, double y) { return core::same_bits(x, y); });
}

bool all_finite(std::span<const double> values) noexcept {
  return std::ranges::all_of(values, [](double v) { return std::isfinite(v); });
}

// Ticks without data that are just allowed; a limit that is a whole number of ticks is one of them.
std::int64_t ticks_of(double time, const model::RobotDescription& robot) {
  return static_cast<std::int64_t>(std::floor(time * robot.rate_hz() + 1e-6));
}

}  // namespace

SensorWatch::SensorWatch(const behaviors::EstimatorSpec& spec, const model::RobotDescription& robot)
    : needs_state_(spec.type != behaviors::EstimatorType::true_state),
      needs_imu_(behaviors::estimator_info(spec.type).needs_imu),
      needs_mocap_(behaviors::estimator_info(spec.type).needs_mocap),
      needs_torque_(behaviors::estimator_info(spec.type).needs_contacts &&
                    spec.contact != behaviors::ContactSource::switches),
      joints_(robot.joints.size()),
      period_ns_(std::llround(robot.period_s() * 1e9)),
      imu_limit_(ticks_of(robot.imu_age, robot)),
      mocap_limit_(ticks_of(robot.mocap_age, robot)) {}

SensorFindings SensorWatch::check(const hal::Sensors& sensors, bool fresh) noexcept {
  SensorFindings findings;
  ++clock_ticks_;
  if (fresh) {
    watch_clock(sensors, findings);
    spoiled_ = needs_state_ && repair(sensors);
  }
  usable_ = spoiled_ ? &repaired_ : &sensors;
  frame_ = false;
  if (fresh) {
    watch_imu(*usable_);
    watch_mocap(*usable_);
  } else {
    ++imu_ticks_;
    ++mocap_ticks_;
    hide_frame(*usable_);
  }
  findings.infinite = spoiled_;
  findings.imu_stale = imu_ticks_ > imu_limit_;
  findings.mocap_stale = mocap_ticks_ > mocap_limit_;
  return findings;
}

// Where reads brought nothing the clock has gone on for as many ticks.
void SensorWatch::watch_clock(const hal::Sensors& sensors, SensorFindings& findings) noexcept {
  const std::int64_t step = sensors.time_ns - last_.time_ns;
  if (started_) {
    findings.clock = step < 0 || (step == 0 && clock_moved_) ||
                     (clock_moved_ && step > (clock_ticks_ + kClockJump) * period_ns_);
    clock_moved_ = clock_moved_ || step != 0;
  }
  last_.time_ns = sensors.time_ns;
  clock_ticks_ = 0;
  started_ = true;
}

void SensorWatch::watch_imu(const hal::Sensors& sensors) noexcept {
  ++imu_ticks_;
  if (!sensors.imu_fresh) return;
  const bool moved = imu_known_ && !(same(sensors.gyro, last_.gyro) &&
                                     same(sensors.accelerometer, last_.accelerometer));
  // Of a real IMU, or one with errors, two samples never agree to the last bit.
  const bool perfect = sensors.has_truth && !sensors.sensor_truth;
  imu_moved_ = imu_moved_ || moved || (imu_known_ && !perfect);
  if (moved || !imu_moved_ || !needs_imu_) imu_ticks_ = 0;
  last_.gyro = sensors.gyro;
  last_.accelerometer = sensors.accelerometer;
  imu_known_ = true;
}

void SensorWatch::watch_mocap(const hal::Sensors& sensors) noexcept {
  ++mocap_ticks_;
  if (!sensors.mocap_fresh) return;
  if (!needs_mocap_) {
    mocap_ticks_ = 0;
    return;
  }
  int seen = 0;
  bool moved = false;
  for (std::size_t m = 0; m < sensors.marker.size(); ++m) {
    if (!sensors.marker_seen[m]) continue;
    ++seen;
    moved = moved || (mocap_known_ && !same(sensors.marker[m], last_.marker[m]));
    last_.marker[m] = sensors.marker[m];
  }
  mocap_moved_ = mocap_moved_ || moved;
  mocap_known_ = mocap_known_ || seen > 0;
  frame_ = seen >= kFewestMarkers && (moved || !mocap_moved_);
  if (seen > 0 && mocap_moved_ && !moved) hide_frame(sensors);
}

// A frame that is the last one once more says nothing new: the estimator does not get it.
void SensorWatch::hide_frame(const hal::Sensors& sensors) noexcept {
  if (usable_ != &repaired_) repaired_ = sensors;
  repaired_.mocap_fresh = false;
  usable_ = &repaired_;
}

void SensorWatch::used(int markers) noexcept {
  if (frame_ && markers > 0) mocap_ticks_ = 0;
}

// Whether there was anything to repair. What is finite becomes the last good value.
bool SensorWatch::repair(const hal::Sensors& sensors) noexcept {
  const auto bad_joints = [&](const auto& values) {
    return !all_finite(std::span(values).first(joints_));
  };
  const bool joints =
      bad_joints(sensors.q) || bad_joints(sensors.qd) || (needs_torque_ && bad_joints(sensors.tau));
  const bool imu = needs_imu_ && sensors.imu_fresh &&
                   !(all_finite(sensors.gyro) && all_finite(sensors.accelerometer));
  bool markers = needs_mocap_ && sensors.mocap_fresh && !std::isfinite(sensors.mocap_age);
  for (std::size_t m = 0; needs_mocap_ && m < sensors.marker.size(); ++m) {
    markers = markers || (sensors.marker_seen[m] && !all_finite(sensors.marker[m]));
  }
  if (!joints) {
    last_.q = sensors.q;
    last_.qd = sensors.qd;
    last_.tau = sensors.tau;
  }
  if (!joints && !imu && !markers) return false;
  repaired_ = sensors;
  if (joints) {
    repaired_.q = last_.q;
    repaired_.qd = last_.qd;
    repaired_.tau = last_.tau;
  }
  if (imu) {
    repaired_.gyro = last_.gyro;
    repaired_.accelerometer = last_.accelerometer;
    repaired_.imu_fresh = false;
  }
  for (std::size_t m = 0; markers && m < sensors.marker.size(); ++m) {
    if (std::isfinite(sensors.mocap_age) && all_finite(sensors.marker[m])) continue;
    repaired_.marker[m] = last_.marker[m];
    repaired_.marker_seen[m] = false;
  }
  if (!std::isfinite(sensors.mocap_age)) repaired_.mocap_age = 0.0;
  return true;
}

void SensorWatch::take_over(const SensorWatch& old) noexcept {
  imu_ticks_ = old.imu_ticks_;
  mocap_ticks_ = old.mocap_ticks_;
  clock_ticks_ = old.clock_ticks_;
  started_ = old.started_;
  clock_moved_ = old.clock_moved_;
  // What another estimator does not look at was not watched.
  imu_moved_ = old.imu_moved_;
  imu_known_ = old.imu_known_;
  mocap_moved_ = old.needs_mocap_ && old.mocap_moved_;
  mocap_known_ = old.needs_mocap_ && old.mocap_known_;
  last_ = old.last_;
}

}  // namespace footfall::engine
