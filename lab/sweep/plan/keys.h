// The format of a `sweep: 1` file as data: every map with its keys, every list of words. Used by
// the loader, the JSON Schema and docs/reference.md.
#pragma once

#include "core/yaml/key_table.h"

namespace footfall::lab {

extern const core::KeyTable kSweepKeys;  // the root of the file
extern const core::KeyTable kSweepGridKeys;
extern const core::KeyTable kSweepSampleKeys;
extern const core::KeyTable kSweepDistributionKeys;
extern const core::KeyTable kSweepFaultKeys;
extern const std::span<const core::WordSpec> kSweepFaults;   // `none` and the faults of scenarios
extern const std::span<const core::WordSpec> kSweepMethods;  // in the order of SampleMethod

extern const core::FileTable kSweepFile;

}  // namespace footfall::lab
