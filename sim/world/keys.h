// The format of a `world: 1` file as data: every map with its keys, every list of words. Used by
// the loader, the JSON Schema and docs/reference.md.
#pragma once

#include "core/yaml/key_table.h"

namespace footfall::sim {

extern const core::KeyTable kWorldKeys;  // the root of the file
extern const core::KeyTable kGroundKeys;
extern const core::KeyTable kTerrainKeys;
extern const core::KeyTable kBoxKeys;
extern const core::KeyTable kBeliefKeys;
extern const core::KeyTable kBeliefErrorKeys;
extern const core::KeyTable kSurfaceKeys;
extern const core::KeyTable kRampKeys;
extern const core::KeyTable kActuatorsKeys;
extern const core::KeyTable kWorldSensorsKeys;
extern const core::KeyTable kJointSensorKeys;
extern const core::KeyTable kGyroKeys;
extern const core::KeyTable kAccelerometerKeys;
extern const core::KeyTable kImuSensorKeys;
extern const core::KeyTable kMocapSensorKeys;
extern const core::KeyTable kSwitchKeys;
extern const core::KeyTable kControlModelKeys;
extern const core::KeyTable kPhysicsKeys;
extern const core::KeyTable kStartKeys;
extern const core::KeyTable kStandKeys;
extern const std::span<const core::WordSpec> kTerrainBeliefs;  // in the order of TerrainBelief
extern const std::span<const core::WordSpec> kActuatorModels;  // in the order of ActuatorModel
extern const std::span<const core::WordSpec> kIntegrators;     // in the order of Integrator
extern const std::span<const core::WordSpec> kSolvers;         // in the order of Solver
extern const std::span<const core::WordSpec> kCones;           // in the order of Cone

extern const core::FileTable kWorldFile;

}  // namespace footfall::sim
