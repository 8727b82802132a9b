// Tells the hardware, beside the torques, what the control law in force asks of it: the contacts
// that it relies on and the gains of the torque loops. Only changes are told.
#pragma once

#include <cstdint>
#include <vector>

#include "behaviors/machine/machine.h"
#include "hal/hardware.h"

namespace footfall::engine {

class HardwareLink {
 public:
  HardwareLink(const behaviors::Behavior& behavior, hal::Hardware& hardware);

  // Before the tick's write().
  void tell(const behaviors::Machine& machine) noexcept;
  // The hardware may have been told something else meanwhile, by another loop.
  void forget() noexcept;
  // Contacts told last: bit c of contact c; all of them before the first tick.
  std::uint64_t support() const noexcept { return support_; }

 private:
  void tell_support(int control) noexcept;
  void tell_gains(const behaviors::Machine& machine) noexcept;

  const behaviors::Behavior& behavior_;
  hal::Hardware& hardware_;
  bool has_loops_;  // of gains that a behavior sets
  std::uint64_t support_ = ~std::uint64_t{0};
  int control_ = -1;                        // index of the law that was told; -1: none yet
  std::vector<hal::TorqueLoopGains> told_;  // by joint
  bool told_gains_ = false;
};

}  // namespace footfall::engine
