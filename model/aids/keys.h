// Tables of the keys of external aids' springs.
#pragma once

#include <span>

#include "core/yaml/key_table.h"

namespace footfall::model {

inline constexpr core::Dimension kLinearStiffness{0, 1, -2};  // N/m
inline constexpr core::Dimension kLinearDamping{0, 1, -1};    // N s/m

// Of constraints; of holds, where everything has a default.
extern const core::KeyTable kLineSpringKeys, kTurnSpringKeys, kRopeKeys;
extern const core::KeyTable kHeldLineSpringKeys, kHeldTurnSpringKeys;
extern const std::span<const core::WordSpec> kHoldAxes;

}  // namespace footfall::model
