// Gains of torque loops from slots; see torque_loops.h.
#include "behaviors/compiled/torque_loops.h"

#include "core/index.h"
#include "model/robot/torque_loop.h"

namespace footfall::behaviors {

hal::TorqueLoopGains torque_loop_gains(const Behavior& behavior, int table, int joint,
                                       std::span<const double> values) noexcept {
  if (table < 0) {
    const auto& own = behavior.robot.drives.torque_loop;
    return own.empty() ? hal::TorqueLoopGains{} : own[at(joint)];
  }
  const TorqueLoopTable& loop = behavior.torque_loops[at(table)];
  hal::TorqueLoopGains gains = loop.unnamed[at(joint)];
  for (std::size_t k = 0; k < loop.slots.size(); ++k) {
    if (loop.slots[k] < 0) continue;
    gains.*model::kTorqueLoopGainKeys[k].member = values[at(loop.slots[k] + joint)];
  }
  return gains;
}

hal::TorqueLoopGains torque_loop_gains(const Behavior& behavior, const ControlSpec& control,
                                       int joint, std::span<const double> values) noexcept {
  const int table = control.torque_loops.empty() ? -1 : control.torque_loops[at(joint)];
  return torque_loop_gains(behavior, table, joint, values);
}

}  // namespace footfall::behaviors
