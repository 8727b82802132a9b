// Frames of motion capture; see mocap.h.
#include "hal/sensors/mocap.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "hal/sensors/rotation.h"

namespace footfall::hal {
namespace {

constexpr double kRounding = 1e-9;  // ticks: times that are equal but for round-off

std::size_t line_length(double delay, double interval) {
  const double frames = std::ceil(delay / interval) + 2.0;
  if (frames > Mocap::kLongestLine) {
    throw std::runtime_error("motion capture: more frames on their way than " +
                             std::to_string(Mocap::kLongestLine));
  }
  return static_cast<std::size_t>(frames);
}

}  // namespace

// A marker is hidden and shown by a chain of two states in continuous time, with the rates 1/spell
// (to seen) and p / ((1-p) spell) (to hidden), whose stationary part hidden is p. Over an interval
// d it has forgotten its state but for exp(-d / (spell (1-p))), the sum of both rates times d.
Mocap::Mocap(const MocapErrors& errors, const SensorPlaces& places, double period,
             std::uint64_t seed)
    : errors_(errors),
      period_(period),
      interval_(errors.rate > 0.0 ? 1.0 / errors.rate : period),
      any_(errors.any()),
      markers_(static_cast<std::size_t>(places.markers)),
      p_BM_(places.p_BM),
      noise_(seed, NoiseSource::marker_noise),
      occlusion_(seed, NoiseSource::occlusion),
      lost_(seed, NoiseSource::lost_frames),
      line_(line_length(errors.delay, interval_)) {
  const double p = errors.occlusion;
  const double kept = p < 1.0 ? std::exp(-interval_ / (errors.spell * (1.0 - p))) : 0.0;
  hide_probability_ = p * (1.0 - kept);
  show_probability_ = (1.0 - p) * (1.0 - kept);
  NoiseStream shift(seed, NoiseSource::marker_places);
  for (std::size_t m = 0; m < markers_ && errors.placement > 0.0; ++m) {
    const std::array<double, 3> by = shift.normal3(errors.placement);
    for (std::size_t k = 0; k < 3; ++k) p_BM_[m][k] += by[k];
  }
}

double Mocap::exposure(std::int64_t frame) const noexcept {
  return errors_.rate > 0.0 ? static_cast<double>(frame) / errors_.rate
                            : static_cast<double>(frame) * period_;
}

Mocap::Points Mocap::places(const BaseMotion& motion) const noexcept {
  const Matrix3 r = matrix_of(motion.q_WB);
  Points points;  // those of no marker are never read
  for (std::size_t m = 0; m < markers_; ++m) {
    points[m] = turned(r, p_BM_[m]);
    for (std::size_t k = 0; k < 3; ++k) points[m][k] += motion.p_WB[k];
  }
  return points;
}

void Mocap::start(const BaseMotion& motion) noexcept {
  before_ = places(motion);
  oldest_ = waiting_ = 0;
  tick_ = 0;
  // The cameras have run before: frames of the place where the body starts are on their way, and
  // the newest of those that are due is there at once, also if a few in a row were lost.
  constexpr double kSpare = 8.0;
  exposed_ = -static_cast<std::int64_t>(std::ceil(errors_.delay / interval_) + kSpare);
  for (std::size_t m = 0; m < markers_; ++m) hidden_[m] = occlusion_.uniform() < errors_.occlusion;
}

// Every exposure takes the same numbers of every stream, so that one error does not shift
// another's.
void Mocap::hide(Frame& frame) noexcept {
  for (std::size_t m = 0; m < markers_; ++m) {
    frame.seen[m] = true;
    if (!(errors_.occlusion > 0.0)) continue;
    const double u = occlusion_.uniform();
    hidden_[m] = hidden_[m] ? u >= show_probability_ : u < hide_probability_;
    frame.seen[m] = !hidden_[m];
  }
}

// `fraction`: of the way from the last tick to this one.
void Mocap::expose(const Points& now, double fraction) noexcept {
  const bool lost = errors_.dropped > 0.0 && lost_.uniform() < errors_.dropped;
  Frame& frame = line_[(oldest_ + waiting_) % line_.size()];
  frame.number = exposed_;
  hide(frame);
  for (std::size_t m = 0; m < markers_; ++m) {
    for (std::size_t k = 0; k < 3; ++k) {
      double& x = frame.points[m][k];
      x = fraction < 1.0 ? before_[m][k] + fraction * (now[m][k] - before_[m][k]) : now[m][k];
      if (errors_.noise > 0.0) x += errors_.noise * noise_.normal();
      x = digital(x);
    }
  }
  if (!lost) ++waiting_;
}

void Mocap::arrive(const Frame& frame, double age, Sensors& sensors) const noexcept {
  sensors.mocap_fresh = true;
  sensors.mocap_age = age;
  for (std::size_t m = 0; m < markers_; ++m) {
    sensors.marker_seen[m] = frame.seen[m];
    if (frame.seen[m]) sensors.marker[m] = frame.points[m];
  }
}

// A perfect one: what the frames below would show.
void Mocap::show(const BaseMotion& motion, Sensors& sensors) const noexcept {
  const Matrix3 r = matrix_of(motion.q_WB);
  for (std::size_t m = 0; m < markers_; ++m) {
    sensors.marker[m] = turned(r, p_BM_[m]);
    for (std::size_t k = 0; k < 3; ++k) sensors.marker[m][k] += motion.p_WB[k];
    sensors.marker_seen[m] = true;
  }
  sensors.mocap_fresh = true;
  sensors.mocap_age = 0.0;
}

void Mocap::sample(const BaseMotion& motion, Sensors& sensors) noexcept {
  if (!any_) {
    show(motion, sensors);
    return;
  }
  const Points now = places(motion);
  const double time = static_cast<double>(tick_) * period_;
  const double late = kRounding * period_;
  sensors.mocap_fresh = false;
  const auto take = [&] {
    while (waiting_ > 0) {
      const Frame& frame = line_[oldest_];
      const double exposed = exposure(frame.number);
      if (exposed + errors_.delay > time + late) return;
      arrive(frame, std::max(time - exposed, 0.0), sensors);
      oldest_ = (oldest_ + 1) % line_.size();
      --waiting_;
    }
  };
  for (; exposure(exposed_) <= time + late; ++exposed_) {
    take();  // makes room: what arrives before this exposure
    expose(now, std::clamp(1.0 - (time - exposure(exposed_)) / period_, 0.0, 1.0));
  }
  take();
  std::copy_n(now.begin(), markers_, before_.begin());
  ++tick_;
}

}  // namespace footfall::hal
