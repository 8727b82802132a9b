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

bool is_perfect(const hal::Sensors& sensors) noexcept {
  return sensors.has_truth && !sensors.sensor_truth;
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
      joint_count_(robot.joints.size()),
      period_ns_(std::llround(robot.period_s() * 1e9)),
      imu_limit_(ticks_of(robot.imu_age, robot)),
      mocap_limit_(ticks_of(robot.mocap_age, robot)),
      torque_step_(robot.torque_step_limit) {}

SensorFindings SensorWatch::check(const hal::Sensors& sensors, bool fresh) noexcept {
  SensorFindings findings;
  ++clock_ticks_;
  ++imu_ticks_;
  ++mocap_ticks_;
  for (Repeats* const part : {&imu_, &gyro_, &accelerometer_}) part->ticks += needs_imu_ ? 1 : 0;
  frame_ = joints_new_ = false;
  if (fresh) {
    watch_clock(sensors, findings);
    watch_joints(sensors);
    joints_new_ = true;
    spoiled_ = needs_state_ && repair(sensors);
    hidden_ = false;
    usable_ = spoiled_ ? &repaired_ : &sensors;
    watch_imu(*usable_);
    watch_mocap(*usable_);
  } else {
    hide_news(sensors);
  }
  findings.infinite = spoiled_;
  findings.joints_stale = joints_.ticks > imu_limit_;
  findings.imu_stale =
      std::max({imu_ticks_, imu_.ticks, gyro_.ticks, accelerometer_.ticks}) > imu_limit_;
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

void SensorWatch::watch_joints(const hal::Sensors& sensors) noexcept {
  if (!needs_state_) return;
  const auto repeats = [&](const auto& now, const auto& before) {
    return same(std::span(now).first(joint_count_), std::span(before).first(joint_count_));
  };
  if (driven_) ++joints_.ticks;
  joints_.next(repeats(sensors.q, last_.q) && repeats(sensors.motor, last_.motor) &&
                   repeats(sensors.tau, last_.tau),
               !is_perfect(sensors));
  if (joints_.repeated) return;
  commands_at_change_ = commands_;
  driven_ = false;
}

void SensorWatch::commanded(const hal::Commands& commands) noexcept {
  for (std::size_t j = 0; j < joint_count_; ++j) {
    driven_ = driven_ || std::abs(commands.tau[j] - commands_at_change_.tau[j]) > torque_step_;
  }
  commands_ = commands;
}

// Of a real IMU, or one with errors, two samples never agree to the last bit. Of a simulated one a
// sensor may be without errors beside one with some: it moves by whole counts until it rests.
void SensorWatch::watch_imu(const hal::Sensors& sensors) noexcept {
  if (!sensors.imu_fresh) return;
  imu_ticks_ = 0;
  const bool gyro = same(sensors.gyro, last_.gyro);
  const bool accelerometer = same(sensors.accelerometer, last_.accelerometer);
  imu_.next(gyro && accelerometer, !is_perfect(sensors));
  const std::int64_t rest = sensors.has_truth ? imu_limit_ : 0;
  gyro_.next(gyro, !sensors.has_truth, rest);
  accelerometer_.next(accelerometer, !sensors.has_truth, rest);
  last_.gyro = sensors.gyro;
  last_.accelerometer = sensors.accelerometer;
}

void SensorWatch::watch_mocap(const hal::Sensors& sensors) noexcept {
  if (needs_mocap_) {
    for (std::int64_t& ticks : marker_ticks_) ++ticks;
  }
  if (!sensors.mocap_fresh) return;
  if (!needs_mocap_) {
    mocap_ticks_ = 0;
    return;
  }
  int seen = 0, moved = 0;
  for (std::size_t m = 0; m < sensors.marker.size(); ++m) {
    if (!sensors.marker_seen[m]) continue;
    ++seen;
    if (mocap_known_ && same(sensors.marker[m], last_.marker[m])) continue;
    moved += mocap_known_ ? 1 : 0;
    last_.marker[m] = sensors.marker[m];
    marker_ticks_[m] = 0;
  }
  mocap_moved_ = mocap_moved_ || moved > 0;
  mocap_known_ = mocap_known_ || seen > 0;
  // A frame that is the last one once more says nothing new: the estimator does not get it.
  if (seen > 0 && mocap_moved_ && moved == 0) copy(sensors).mocap_fresh = false;
  if (moved > 0 && moved < seen && !is_perfect(sensors)) seen -= hide_frozen(sensors, moved);
  frame_ = seen >= kFewestMarkers && (moved > 0 || !mocap_moved_);
}

// Markers that repeat while others move; how many. Where those are too few for an attitude the
// robot may just rest within the resolution, so that it takes as long as a frozen frame.
int SensorWatch::hide_frozen(const hal::Sensors& sensors, int moved) noexcept {
  int hidden = 0;
  for (std::size_t m = 0; m < sensors.marker.size(); ++m) {
    const std::int64_t allowed = moved >= kFewestMarkers ? 0 : mocap_limit_;
    if (!sensors.marker_seen[m] || marker_ticks_[m] <= allowed) continue;
    copy(sensors).marker_seen[m] = false;
    ++hidden;
  }
  return hidden;
}

hal::Sensors& SensorWatch::copy(const hal::Sensors& sensors) noexcept {
  if (usable_ != &repaired_) repaired_ = sensors;
  usable_ = &repaired_;
  return repaired_;
}

// Once for any number of reads that bring nothing.
void SensorWatch::hide_news(const hal::Sensors& sensors) noexcept {
  if (!hidden_ && !spoiled_) repaired_ = sensors;
  repaired_.imu_fresh = repaired_.mocap_fresh = false;
  hidden_ = true;
  usable_ = &repaired_;
}

void SensorWatch::used(int markers) noexcept {
  if (frame_ && markers > 0) mocap_ticks_ = 0;
}

// Whether there was anything to repair. What is finite becomes the last good value.
bool SensorWatch::repair(const hal::Sensors& sensors) noexcept {
  const auto bad_joints = [&](const auto& values) {
    return !all_finite(std::span(values).first(joint_count_));
  };
  const bool joints = bad_joints(sensors.q) || bad_joints(sensors.qd) || bad_joints(sensors.tau) ||
                      bad_joints(sensors.motor);
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
    last_.motor = sensors.motor;
  }
  if (!joints && !imu && !markers) return false;
  repaired_ = sensors;
  if (joints) {
    joints_new_ = false;
    repaired_.q = last_.q;
    repaired_.qd = last_.qd;
    repaired_.tau = last_.tau;
    repaired_.motor = last_.motor;
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
  if (old.needs_state_) joints_ = old.joints_;
  imu_ = old.imu_;
  gyro_ = old.gyro_;
  accelerometer_ = old.accelerometer_;
  mocap_moved_ = old.needs_mocap_ && old.mocap_moved_;
  mocap_known_ = old.needs_mocap_ && old.mocap_known_;
  marker_ticks_ = old.marker_ticks_;
  commands_ = old.commands_;
  commands_at_change_ = old.commands_at_change_;
  driven_ = old.driven_;
  last_ = old.last_;
}

}  // namespace footfall::engine
