// Random numbers of one cause of error: a stream of its own, so that to switch one error off leaves
// the numbers of all others as they are. The same with every standard library. No allocation after
// construction.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/random.h"

namespace footfall::hal {

// What a stream is of. The order is part of what a seed means: new ones go to the end.
enum class NoiseSource : std::uint32_t {
  gyro_noise,
  gyro_bias,
  gyro_walk,
  accelerometer_noise,
  accelerometer_bias,
  accelerometer_walk,
  imu_mount,
  marker_noise,
  marker_places,
  occlusion,
  lost_frames,
  switch_jitter,
  switch_bounce,
  footholds,
};

// xoshiro256++ (Blackman and Vigna 2019) and the normal numbers of core/random.h.
class NoiseStream {
 public:
  // `index`: tells streams of one source apart, such as those of contacts.
  explicit NoiseStream(std::uint64_t seed = 0, NoiseSource source = {}, std::uint32_t index = 0);

  double uniform() noexcept { return static_cast<double>(next() >> 11U) * 0x1p-53; }  // 0 <= u < 1
  double normal() noexcept { return normal_(*this); }  // mean 0, deviation 1
  // Normal numbers of a deviation, in the order x y z.
  std::array<double, 3> normal3(double deviation) noexcept {
    std::array<double, 3> out{};
    for (double& x : out) x = deviation * normal();
    return out;
  }
  double sign() noexcept { return (next() >> 63U) == 0 ? 1.0 : -1.0; }

 private:
  std::uint64_t next() noexcept;

  std::array<std::uint64_t, 4> state_{};
  core::Normal normal_;
};

// For core::Normal.
inline double uniform(NoiseStream& stream) noexcept { return stream.uniform(); }

// A value that moves by independent steps: its deviation grows with the root of time.
struct RandomWalk {
  std::array<double, 3> value{};
  // `deviation`: of the change in 1 s, SI.
  void advance(double deviation, double time, NoiseStream& stream) noexcept {
    const double step = deviation * std::sqrt(time);
    for (double& x : value) x += step * stream.normal();
  }
};

// The nearest multiple of 2^-20 (9.5e-7): what a digital sensor gives. Far below the noise of real
// ones; a log of such numbers is half as large as one of full doubles.
inline double digital(double x) noexcept { return std::nearbyint(x * 0x1p20) * 0x1p-20; }

}  // namespace footfall::hal
