// Motion capture of markers on the base: frames that are exposed at a rate of their own, arrive
// late, and lack what was hidden. Frame k is exposed k / rate after the start; between two ticks a
// marker moves on the straight line between its places at both, which is wrong by at most a T²/8
// for an acceleration a: 6 um at 100 m/s^2 and 1500 Hz.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/sensor_fields.h"
#include "hal/sensors/errors.h"
#include "hal/sensors/noise.h"

namespace footfall::hal {

class Mocap {
 public:
  // `period`: s, of the tick. Throws std::runtime_error for more frames on their way than the line
  // holds.
  Mocap(const MocapErrors& errors, const SensorPlaces& places, double period, std::uint64_t seed);

  void start(const BaseMotion& motion) noexcept;
  // One call a tick; the first one after start() is at the time 0. Sets mocap_fresh, and if it is
  // true mocap_age, marker_seen, and the places of the markers seen: of several frames that arrive
  // in one tick the newest.
  void sample(const BaseMotion& motion, Sensors& sensors) noexcept;

  // Frames on their way at a time, at most.
  static constexpr int kLongestLine = 4096;

 private:
  using Points = std::array<std::array<double, 3>, core::kMaxMarkers>;
  struct Frame {
    std::int64_t number = 0;  // of its exposure
    Points points{};          // m, world
    std::array<bool, core::kMaxMarkers> seen{};
  };
  void show(const BaseMotion& motion, Sensors& sensors) const noexcept;
  double exposure(std::int64_t frame) const noexcept;
  Points places(const BaseMotion& motion) const noexcept;
  void expose(const Points& now, double fraction) noexcept;
  void hide(Frame& frame) noexcept;
  void arrive(const Frame& frame, double age, Sensors& sensors) const noexcept;

  MocapErrors errors_;
  double period_;
  double interval_;  // s, between two exposures
  bool any_;         // any error
  std::size_t markers_;
  Points p_BM_;                                             // m, base frame: where they really are
  double hide_probability_ = 0.0, show_probability_ = 0.0;  // from one exposure to the next
  NoiseStream noise_, occlusion_, lost_;
  std::array<bool, core::kMaxMarkers> hidden_{};
  std::vector<Frame> line_;  // a ring
  std::size_t oldest_ = 0, waiting_ = 0;
  std::int64_t tick_ = 0, exposed_ = 0;
  Points before_{};
};

}  // namespace footfall::hal
