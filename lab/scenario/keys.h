// The format of a `scenario: 1` file as data: every map with its keys, every list of words. Used by
// the loader, the JSON Schema and docs/reference.md.
#pragma once

#include "core/yaml/key_table.h"

namespace footfall::lab {

extern const core::KeyTable kScenarioKeys;  // the root of the file
extern const core::KeyTable kScriptKeys;
extern const core::KeyTable kMomentKeys;
extern const core::KeyTable kPushKeys;
extern const core::KeyTable kExpectationKeys;
extern const core::KeyTable kGoldenKeys;
extern const std::span<const core::WordSpec> kInjectedFaults;  // in the order of InjectedFault

extern const std::span<const core::WordSpec> kScenarioEnds;  // values of an `end:` expectation

extern const core::FileTable kScenarioFile;

}  // namespace footfall::lab
