// Samples of the IMU; see imu.h.
#include "hal/sensors/imu.h"

#include "hal/sensors/rotation.h"

namespace footfall::hal {
namespace {

// R_BI turned by a random rotation vector in the IMU's axes.
Matrix3 mounted(const SensorPlaces& places, double deviation, std::uint64_t seed) {
  if (!(deviation > 0.0)) return places.R_BI;
  NoiseStream stream(seed, NoiseSource::imu_mount);
  const Vector3 v = stream.normal3(deviation);
  const double angle = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const double scale = angle > 0.0 ? std::sin(0.5 * angle) / angle : 0.5;
  const Matrix3 turn = matrix_of({std::cos(0.5 * angle), scale * v[0], scale * v[1], scale * v[2]});
  Matrix3 out{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      for (std::size_t k = 0; k < 3; ++k)
        out[3 * i + j] += places.R_BI[3 * i + k] * turn[3 * k + j];
    }
  }
  return out;
}

}  // namespace

Imu::Axes::Axes(const InertialErrors& of, std::uint64_t seed, NoiseSource noise_source,
                NoiseSource bias_source, NoiseSource walk_source)
    : errors(of), noise(seed, noise_source), walk(seed, walk_source) {
  NoiseStream signs(seed, bias_source);
  for (double& x : bias.value) x = signs.sign() * errors.bias;
}

void Imu::Axes::add_to(std::array<double, 3>& value, double period) noexcept {
  if (errors.walk > 0.0) bias.advance(errors.walk, period, walk);
  for (std::size_t k = 0; k < 3; ++k) value[k] += bias.value[k];
  if (!(errors.noise > 0.0)) return;
  const std::array<double, 3> white = noise.normal3(errors.noise);
  for (std::size_t k = 0; k < 3; ++k) value[k] += white[k];
}

Imu::Imu(const ImuErrors& errors, const SensorPlaces& places, double period, std::uint64_t seed)
    : places_(places),
      period_(period),
      errors_(errors.any()),
      gyro_(errors.gyro, seed, NoiseSource::gyro_noise, NoiseSource::gyro_bias,
            NoiseSource::gyro_walk),
      accelerometer_(errors.accelerometer, seed, NoiseSource::accelerometer_noise,
                     NoiseSource::accelerometer_bias, NoiseSource::accelerometer_walk),
      R_BI_(mounted(places, errors.mount, seed)) {}

std::array<double, 3> Imu::velocity(const BaseMotion& motion) const noexcept {
  const Vector3 arm = turned(matrix_of(motion.q_WB), cross(motion.w_WB_B, places_.p_BI));
  return {motion.v_WB[0] + arm[0], motion.v_WB[1] + arm[1], motion.v_WB[2] + arm[2]};
}

void Imu::start(const BaseMotion& motion) noexcept {
  before_ = motion;
  velocity_before_ = velocity(motion);
  started_ = false;
}

void Imu::sample(const BaseMotion& motion, std::array<double, 3>& gyro,
                 std::array<double, 3>& accelerometer) noexcept {
  Vector3 rate = motion.w_WB_B;
  if (started_) {
    rate = rotation_between(before_.q_WB, motion.q_WB);
    for (double& x : rate) x /= period_;
  }
  const Vector3 now = velocity(motion);
  Vector3 force{};  // per mass, world axes
  for (std::size_t k = 0; k < 3; ++k) {
    force[k] = (now[k] - velocity_before_[k]) / period_ - places_.gravity[k];
  }
  gyro = turned_back(R_BI_, rate);
  accelerometer =
      turned_back(R_BI_, turned_back(matrix_of(between(before_.q_WB, motion.q_WB)), force));
  before_ = motion;
  velocity_before_ = now;
  started_ = true;
  if (!errors_) return;
  gyro_.add_to(gyro, period_);
  accelerometer_.add_to(accelerometer, period_);
  for (double& x : gyro) x = digital(x);
  for (double& x : accelerometer) x = digital(x);
}

}  // namespace footfall::hal
