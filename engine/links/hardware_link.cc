// What the hardware is told of the law; see hardware_link.h.
#include "engine/links/hardware_link.h"

#include "behaviors/compiled/control_set.h"
#include "behaviors/compiled/torque_loops.h"
#include "core/index.h"

namespace footfall::engine {

HardwareLink::HardwareLink(const behaviors::Behavior& behavior, hal::Hardware& hardware)
    : behavior_(behavior),
      hardware_(hardware),
      has_loops_(hardware.uses_torque_loop() && !behavior.torque_loops.empty()),
      told_(behavior.robot.joints.size()) {}

void HardwareLink::forget() noexcept {
  control_ = -1;
  told_gains_ = false;
}

void HardwareLink::tell(const behaviors::Machine& machine) noexcept {
  if (machine.control_spec() != control_) tell_support(machine.control_spec());
  control_ = machine.control_spec();
  // Without tables the drives keep their own gains, unless a reload took the tables away.
  if (has_loops_ || (!told_gains_ && hardware_.uses_torque_loop())) tell_gains(machine);
}

void HardwareLink::tell_support(int control) noexcept {
  std::uint64_t support = 0;
  for (int c = 0; c < static_cast<int>(behavior_.robot.contacts.size()); ++c) {
    if (!behaviors::law_holds(behavior_, control, c)) continue;
    support |= std::uint64_t{1} << static_cast<unsigned>(c);
  }
  support_ = support;
  hardware_.set_support(support);
}

void HardwareLink::tell_gains(const behaviors::Machine& machine) noexcept {
  const behaviors::ControlSpec& control = behavior_.controls[at(control_)];
  for (int j = 0; j < static_cast<int>(told_.size()); ++j) {
    const auto gains = behaviors::torque_loop_gains(behavior_, control, j, machine.parameters());
    if (told_gains_ && gains == told_[at(j)]) continue;
    hardware_.set_torque_loop(j, gains);
    told_[at(j)] = gains;
  }
  told_gains_ = true;
}

}  // namespace footfall::engine
