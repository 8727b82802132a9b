// Tables of the actuators' torque loops, `torque_loop:` of robots and of behaviors: keys, units,
// and which key belongs to which type.
#pragma once

#include <array>
#include <string_view>

#include "core/units/units.h"
#include "core/yaml/key_table.h"
#include "hal/torque_loop_gains.h"

namespace footfall::model {

extern const core::KeyTable kTorqueLoopKeys;
extern const std::span<const core::WordSpec> kTorqueLoopTypes;     // in the order of Type
extern const std::span<const core::WordSpec> kTorqueLoopDampings;  // in the order of Damping

// A key whose value is one number for all joints, or a map by joint.
struct TorqueLoopKey {
  std::string_view name;
  double hal::TorqueLoopGains::*member;
  bool of_cascade, of_direct;
  core::Dimension cascade, direct;
  std::string_view cascade_noun, direct_noun;  // for messages, with the unit

  bool belongs_to(hal::TorqueLoopGains::Type type) const {
    return type == hal::TorqueLoopGains::Type::cascade ? of_cascade : of_direct;
  }
  core::Dimension dimension(hal::TorqueLoopGains::Type type) const {
    return type == hal::TorqueLoopGains::Type::cascade ? cascade : direct;
  }
  std::string_view noun(hal::TorqueLoopGains::Type type) const {
    return type == hal::TorqueLoopGains::Type::cascade ? cascade_noun : direct_noun;
  }
};
extern const std::array<TorqueLoopKey, 7> kTorqueLoopGainKeys;

}  // namespace footfall::model
