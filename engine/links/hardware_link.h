// Tells the hardware, beside the torques, what the control law in force asks of it: the contacts
// that it relies on and the gains of the torque loops. Only changes are told.
#pragma once

#include <cstdint>

#include "behaviors/machine/machine.h"
#include "hal/hardware.h"

namespace footfall::engine {

class HardwareLink {
 public:
  HardwareLink(const behaviors::Behavior& behavior, hal::Hardware& hardware)
      : behavior_(behavior), hardware_(hardware) {}

  // Before the tick's write().
  void tell(const behaviors::Machine& machine) noexcept;

 private:
  const behaviors::Behavior& behavior_;
  hal::Hardware& hardware_;
  int control_ = -1;  // index of the law that was told; -1: none yet
};

}  // namespace footfall::engine
