// A `robot: 1` file as data: every map with its keys, every list of words. The loader reads its
// names from here, the JSON Schema and docs/reference.md are printed from here.
#pragma once

#include "core/yaml/key_table.h"

namespace footfall::model {

extern const core::KeyTable kRobotKeys;  // the root of the file
extern const core::KeyTable kJointKeys;
extern const core::KeyTable kSeaKeys;
extern const core::KeyTable kDrivesKeys;
extern const core::KeyTable kContactKeys;
extern const core::KeyTable kPointKeys;
extern const core::KeyTable kSensorsKeys;
extern const core::KeyTable kImuKeys;
extern const core::KeyTable kMocapKeys;
extern const core::KeyTable kSymmetryKeys;
extern const core::KeyTable kLimitsKeys;
extern const std::span<const core::WordSpec> kContactTypes;  // in the order of ContactType
extern const std::span<const core::WordSpec> kReactions;     // in the order of core::Reaction

extern const core::FileTable kRobotFile;

}  // namespace footfall::model
