// A ring of products and sums; see motion_history.h.
#include "engine/estimators/parts/motion_history.h"

#include <algorithm>
#include <cmath>

namespace footfall::engine {

void MotionHistory::add(const Vector3d& turn, const Vector3d& shift) noexcept {
  const Step last = size_ > 0 ? back(0) : Step();
  newest_ = (newest_ + 1) % kTicks;
  Step& step = steps_[static_cast<std::size_t>(newest_)];
  step.turn = turn;
  step.shift = shift;
  step.turned = (last.turned * Eigen::Quaterniond(rotation_exp(turn))).normalized();
  step.shifted = last.shifted + shift;
  size_ = std::min(size_ + 1, kTicks);
}

bool MotionHistory::since(double age, Motion& motion) const noexcept {
  motion = {};
  const double ticks = age / period_;
  if (!(ticks >= 0.0) || ticks > static_cast<double>(size_ - 1)) return false;
  if (ticks == 0.0) return true;
  const int whole = static_cast<int>(ticks);
  const double part = ticks - whole;
  const Step& end = back(whole);  // `part` of its tick belongs to the motion, too
  motion.turn = (end.turned.conjugate() * back(0).turned).toRotationMatrix();
  motion.shift = back(0).shifted - end.shifted;
  if (part > 0.0) {
    motion.turn = rotation_exp(part * end.turn) * motion.turn;
    motion.shift += part * end.shift;
  }
  return true;
}

}  // namespace footfall::engine
