// The behavior language as data: every map of a `behavior: 1` file with its keys, every list of
// words. Used by the loader, the JSON Schema and docs/reference.md. A new key is one line in a
// table and the code that reads it.
#pragma once

#include "core/yaml/key_table.h"

namespace footfall::behaviors {

// file.cc
extern const core::KeyTable kBehaviorKeys;  // the root of the file
extern const core::KeyTable kParameterKeys;
extern const core::KeyTable kGainTablesKeys;  // `gains`: ranges, and tables by name
extern const core::KeyTable kGainRangesKeys;
extern const core::KeyTable kTorqueLoopTablesKeys;  // `torque_loop`: ranges, and tables by name
extern const core::KeyTable kTorqueLoopRangesKeys;
extern const core::KeyTable kScriptsKeys;
extern const core::KeyTable kGainTableKeys;  // one table: gains by task
extern const core::KeyTable kGainsKeys;      // kp, ki, kd
extern const core::KeyTable kPlannerKeys;
extern const core::KeyTable kKappaKeys;
extern const core::KeyTable kReachKeys;
extern const core::KeyTable kExtensionKeys;
extern const core::KeyTable kStackKeys;
extern const std::span<const core::WordSpec> kPlannerTypes;

// states.cc
extern const core::KeyTable kStateKeys;
extern const core::KeyTable kTemplateKeys;  // a state with `args`
extern const core::KeyTable kMachineKeys;   // the root state
extern const core::KeyTable kTransitionKeys;
extern const core::KeyTable kActionKeys;
extern const core::KeyTable kInvokeKeys;
extern const core::KeyTable kInvokeWithKeys;
extern const core::KeyTable kContactTransitionKeys;
extern const std::span<const core::WordSpec> kStateTypes;
extern const std::span<const core::WordSpec> kHistoryDepths;
extern const std::span<const core::WordSpec> kReloadWords;
extern const std::span<const core::WordSpec> kOnLate;
extern const std::span<const core::WordSpec> kTransitionForms;

// tasks.cc
extern const core::KeyTable kTaskKeys;  // selector: type
extern const core::KeyTable kInternalKeys, kForceReferenceKeys;
extern const std::span<const core::WordSpec> kForceReferences, kForceTrajectories;
extern const core::KeyTable kTrajectoryKeys;  // selector: trajectory
extern const core::KeyTable kWaypointKeys;
extern const std::span<const core::WordSpec> kDirections;
extern const std::span<const core::WordSpec> kFrames;  // by tasks::Frame, from `world` on
extern const std::span<const core::WordSpec> kConventions;
extern const std::span<const core::WordSpec> kTrajectories;

// words.cc: built-in names of expressions and of `on:`.
extern const std::span<const core::WordSpec> kExpressionFunctions;  // with their arguments
extern const std::span<const core::WordSpec> kExpressionOperators;  // by precedence, weakest first
extern const std::span<const core::WordSpec> kExpressionNames;      // t, time, entry, ...
extern const std::span<const core::WordSpec> kEventFamilies;  // raised by the engine, as patterns

// estimators.cc, made from its table
extern const core::KeyTable kEstimatorKeys;                    // selector: type
extern const std::span<const core::WordSpec> kEstimatorTypes;  // by EstimatorType
extern const std::span<const core::WordSpec> kContactSources;  // by ContactSource

extern const core::FileTable kBehaviorFile;

}  // namespace footfall::behaviors
