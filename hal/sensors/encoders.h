// Joint encoders: positions in whole counts, velocities as the change of the counts over the tick.
#pragma once

#include <span>
#include <vector>

namespace footfall::hal {

class Encoders {
 public:
  // `resolution`: rad, of a count; `period`: s, of the tick.
  Encoders(double resolution, int joints, double period)
      : resolution_(resolution), period_(period), before_(static_cast<std::size_t>(joints)) {}

  void start() noexcept { started_ = false; }
  // One call a tick: what the joints have, to what is measured. With resolution 0 they are equal.
  // The velocity of the first sample is 0.
  void sample(std::span<double> q, std::span<double> qd) noexcept;

 private:
  double resolution_, period_;
  std::vector<double> before_;  // counts
  bool started_ = false;
};

}  // namespace footfall::hal
