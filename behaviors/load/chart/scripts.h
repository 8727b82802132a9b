// Files of Lua that a behavior or a scenario names: read and run once at load, so that mistakes are
// found before anything moves.
#pragma once

#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/script/script.h"
#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"

namespace footfall::behaviors {

// `FILE` or `[FILES]`, each beside the file in which it is named. What cannot be read is reported.
std::vector<ScriptFile> read_script_files(const core::YamlNode& node,
                                          core::Diagnostics& diagnostics);
// Defines what the files define; their mistakes are reported at their own places.
void run_script_files(const std::vector<ScriptFile>& files, Script& script,
                      core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
