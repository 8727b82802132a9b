// Which value given on top of a base, in an overlay or by --set, a finding in the base follows
// from. Load time only.
#pragma once

#include <functional>

#include "behaviors/load/options.h"
#include "core/diagnostics/diagnostics.h"
#include "core/yaml/layers.h"

namespace footfall::behaviors {

// Loads a tree with these options; false after an error.
using TreeWithOptions =
    std::function<bool(const core::YamlNode& tree, const LoadOptions& options, core::Diagnostics&)>;

// A file that is good without --set: reports each override that spoils it, as one error at that
// override, not where the file meets its value; false if there is none.
bool blame_overrides(const core::YamlNode& root, const LoadOptions& options,
                     const TreeWithOptions& load, core::Diagnostics& diagnostics);

// `found`: what LoadOptions::check found after `before` in a file that loads. Moves each finding to
// the override or the edit of an overlay without which it is gone, and says there where it acts.
// `load` appends what check finds in another tree, or the errors of a load.
core::Diagnostics blame_findings(const core::YamlNode& root, const core::YamlLayers& layers,
                                 const LoadOptions& options, const core::Diagnostics& before,
                                 core::Diagnostics found, const TreeWithOptions& load);

}  // namespace footfall::behaviors
