// Counts of joint encoders; see encoders.h.
#include "hal/sensors/encoders.h"

#include <cmath>

namespace footfall::hal {

void Encoders::sample(std::span<double> q, std::span<double> qd) noexcept {
  if (!(resolution_ > 0.0)) return;
  for (std::size_t j = 0; j < before_.size(); ++j) {
    const double count = std::round(q[j] / resolution_);
    qd[j] = started_ ? (count - before_[j]) * resolution_ / period_ : 0.0;
    q[j] = count * resolution_;
    before_[j] = count;
  }
  started_ = true;
}

}  // namespace footfall::hal
