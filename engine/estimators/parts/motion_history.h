// What the base did since a moment in the past, by gyroscope and estimated velocity alone:
// corrections of the estimate in between do not enter. This is the sum k-p .. k-1 of [Kim16] eq.
// (58), taken as the product of rotations (correction E17), for any age and at a fixed cost.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "engine/estimators/parts/rotation.h"

namespace footfall::engine {

// From the earlier moment to now.
struct Motion {
  Matrix3d turn = Matrix3d::Identity();  // R_WB(then)ᵀ R_WB(now)
  Vector3d shift = Vector3d::Zero();     // p_WB(now) - p_WB(then), m, world
};

class MotionHistory {
 public:
  static constexpr int kTicks = 128;  // 85 ms at 1500 Hz

  explicit MotionHistory(double period) : period_(period) {}
  void clear() noexcept { size_ = 0; }
  // A tick: its rotation vector, rad, base axes, and its displacement, m, world.
  void add(const Vector3d& turn, const Vector3d& shift) noexcept;
  // Since `age` seconds ago; between ticks by a constant velocity. False if the history is shorter.
  bool since(double age, Motion& motion) const noexcept;

 private:
  struct Step {
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  // product of all turns until now
    Vector3d shifted = Vector3d::Zero();                         // sum of all shifts until now
    Vector3d turn = Vector3d::Zero(), shift = Vector3d::Zero();  // of the tick that ends here
  };
  const Step& back(int ticks) const noexcept {
    return steps_[static_cast<std::size_t>((newest_ - ticks + kTicks) % kTicks)];
  }

  double period_;
  std::array<Step, kTicks> steps_;
  int newest_ = 0, size_ = 0;
};

}  // namespace footfall::engine
