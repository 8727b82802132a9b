// The library's `balance` walking in place in the simulator with its true state, and beside it what
// the sensors of a real robot would have told: for tests and benchmarks of estimators.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <deque>
#include <random>

#include "core/random.h"
#include "tests/support/rig.h"

namespace footfall::tests {

// Standard deviations of a sample unless told otherwise; all zero: perfect sensors.
struct SensorErrors {
  double gyro = 0.0;                  // rad/s
  double gyro_bias = 0.0;             // rad/s, drawn once an axis
  double gyro_walk = 0.0;             // rad/s/sqrt(s)
  double accelerometer = 0.0;         // m/s^2
  double accelerometer_bias = 0.0;    // m/s^2, drawn once an axis
  double encoder = 0.0;               // rad, quantum of the joints' encoders
  double motor = 0.0;                 // rad, quantum of the motors' encoders
  double deflection = 0.0;            // rad, of the springs' measured deflection
  double marker = 0.0;                // m
  double marker_place = 0.0;          // m, drawn once an axis
  double hidden = 0.0;                // share of time, in spells of 100 ms
  double lost = 0.0;                  // share of the frames
  double frame_period = 1.0 / 480.0;  // s
  int frame_ticks = 0;                // age of a frame when it arrives
  int switch_ticks = 0;               // delay of the switches
};

inline SensorErrors laboratory_errors() {
  constexpr double kDegree = 0.017453292519943295;
  return {.gyro = 0.01,
          .gyro_bias = 0.25 * kDegree,
          .gyro_walk = 1e-5,
          .accelerometer = 0.07,
          .accelerometer_bias = 0.03,
          .encoder = 3.8e-4,
          .motor = 1.5e-5,
          .deflection = 1.5e-5,
          .marker = 1e-3,
          .marker_place = 1e-3,
          .hidden = 0.05,
          .lost = 0.01,
          .frame_ticks = 7,
          .switch_ticks = 4};
}

class SensedWalk {
 public:
  SensedWalk(unsigned seed, const SensorErrors& errors, const std::string& behavior = "balance")
      : rig(behavior), errors_(errors), random_(seed) {
    for (std::size_t k = 0; k < 3; ++k) {
      gyro_bias[k] = errors.gyro_bias * normal_(random_);
      accelerometer_bias[k] = errors.accelerometer_bias * normal_(random_);
    }
    for (const model::Marker& m : rig.loop->model().mounts().markers) {
      Eigen::Vector3d place(m.p_BM.data());
      for (int k = 0; k < 3; ++k) place[k] += errors.marker_place * normal_(random_);
      places_.push_back(place);
      hidden_until_.push_back(-1.0);
    }
    rig.loop->start();
    for (const auto& contact : rig.behavior->robot.contacts) {
      supports_.push_back(rig.behavior->signals.find("support." + contact.name));
    }
    sense();
  }
  // Advances a tick; false when the robot has fallen or the behavior has ended.
  bool next() {
    if (rig.loop->tick() != engine::LoopState::running) return false;
    sense();
    return true;
  }
  const model::State& truth() const { return rig.loop->estimate().state; }
  const model::ControlModel& true_model() const { return rig.loop->model(); }

  Rig rig;
  hal::Sensors sensors;  // as measured, without truth
  std::uint64_t support = ~std::uint64_t{0};
  std::array<double, 3> gyro_bias{}, accelerometer_bias{};  // rad/s, m/s^2, IMU frame

 private:
  struct Pose {
    Eigen::Matrix3d R;
    Eigen::Vector3d p;
  };

  double noise(double deviation) { return deviation > 0.0 ? deviation * normal_(random_) : 0.0; }
  static double counted(double angle, double quantum) {
    return quantum > 0.0 ? quantum * std::round(angle / quantum) : angle;
  }

  void sense() {
    const hal::Sensors& exact = rig.loop->sensors();
    const std::array<double, core::kMaxJoints> last_q = sensors.q;
    sensors = exact;
    sensors.has_truth = false;
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(exact.q_WB[0], exact.q_WB[1], exact.q_WB[2], exact.q_WB[3])
            .toRotationMatrix();
    const Pose pose{R, Eigen::Vector3d(exact.p_WB.data())};
    sense_joints(exact, last_q);
    sense_imu(exact, pose);
    sense_markers(pose);
    sense_contacts(exact);
    support = 0;
    for (std::size_t c = 0; c < supports_.size(); ++c) {
      if (rig.loop->signals()[supports_[c]] > 0.5) support |= std::uint64_t{1} << c;
    }
    ++tick_;
  }

  void sense_joints(const hal::Sensors& exact, const std::array<double, core::kMaxJoints>& last) {
    const auto& robot = rig.behavior->robot;
    for (std::size_t j = 0; j < robot.joints.size(); ++j) {
      if (errors_.encoder > 0.0) {
        sensors.q[j] = counted(exact.q[j], errors_.encoder);
        sensors.qd[j] = tick_ > 0 ? (sensors.q[j] - last[j]) / robot.period_s() : 0.0;
      }
      const double spring = robot.joints[j].spring;
      if (errors_.motor > 0.0 && spring > 0.0) {
        sensors.motor[j] = counted(exact.q[j] + exact.tau[j] / spring, errors_.motor);
        sensors.tau[j] += spring * noise(errors_.deflection);
      }
    }
  }

  // Means over the tick: the rotation's logarithm, and the change of the IMU's velocity.
  void sense_imu(const hal::Sensors& exact, const Pose& pose) {
    const double dt = rig.behavior->robot.period_s();
    const Eigen::Vector3d r(rig.loop->model().mounts().p_BI.data());  // the IMU has the base's axes
    const Eigen::Vector3d w(exact.w_WB_B.data());
    const Eigen::Vector3d v = Eigen::Vector3d(exact.v_WB.data()) + pose.R * w.cross(r);
    Eigen::Vector3d rate = w, force = pose.R.transpose() * Eigen::Vector3d(0.0, 0.0, 9.81);
    if (tick_ > 0) {
      const Eigen::AngleAxisd turn(Eigen::Matrix3d(last_pose_.R.transpose() * pose.R));
      rate = turn.angle() / dt * turn.axis();
      const Eigen::AngleAxisd half(0.5 * turn.angle(), turn.axis());
      force = (last_pose_.R * half).transpose() *
              ((v - last_velocity_) / dt + Eigen::Vector3d(0.0, 0.0, rig.loop->model().gravity()));
    }
    for (std::size_t k = 0; k < 3; ++k) {
      gyro_bias[k] += noise(errors_.gyro_walk * std::sqrt(dt));
      sensors.gyro[k] = rate[static_cast<int>(k)] + gyro_bias[k] + noise(errors_.gyro);
      sensors.accelerometer[k] =
          force[static_cast<int>(k)] + accelerometer_bias[k] + noise(errors_.accelerometer);
    }
    last_pose_ = pose;
    last_velocity_ = v;
  }

  void sense_markers(const Pose& pose) {
    const double dt = rig.behavior->robot.period_s();
    poses_.push_back(pose);
    if (poses_.size() > static_cast<std::size_t>(errors_.frame_ticks) + 1) poses_.pop_front();
    sensors.mocap_fresh = false;
    const double now = static_cast<double>(tick_) * dt;
    if (now + 1e-9 < next_frame_) return;
    next_frame_ += errors_.frame_period;
    if (errors_.lost > 0.0 && core::uniform(random_) < errors_.lost) return;
    sensors.mocap_fresh = true;
    sensors.mocap_age = static_cast<double>(poses_.size() - 1) * dt;
    const Pose& then = poses_.front();
    for (std::size_t m = 0; m < places_.size(); ++m) {
      if (errors_.hidden > 0.0 && now > hidden_until_[m] &&
          core::uniform(random_) < errors_.hidden * errors_.frame_period / 0.1) {
        hidden_until_[m] = now + 0.1;
      }
      sensors.marker_seen[m] = now > hidden_until_[m] && !blind;
      const Eigen::Vector3d y = then.p + then.R * places_[m];
      for (std::size_t k = 0; k < 3; ++k) {
        sensors.marker[m][k] = y[static_cast<int>(k)] + noise(errors_.marker);
      }
    }
  }

  void sense_contacts(const hal::Sensors& exact) {
    switches_.push_back(exact.contact);
    if (switches_.size() > static_cast<std::size_t>(errors_.switch_ticks) + 1)
      switches_.pop_front();
    sensors.contact = switches_.front();
  }

 public:
  bool blind = false;  // no marker is seen

 private:
  SensorErrors errors_;
  std::mt19937_64 random_;
  core::Normal normal_;
  std::vector<Eigen::Vector3d> places_;
  std::vector<double> hidden_until_;
  std::vector<int> supports_;
  std::deque<Pose> poses_;
  std::deque<std::array<bool, core::kMaxContacts>> switches_;
  Pose last_pose_{};
  Eigen::Vector3d last_velocity_ = Eigen::Vector3d::Zero();
  double next_frame_ = 0.0;
  long tick_ = 0;
};

}  // namespace footfall::tests
