// Lua files of a behavior or a scenario, read and run once at load, so that errors are found before
// the robot moves.
#pragma once

#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/script/script.h"
#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"

namespace footfall::behaviors {

// Reads `FILE` or `[FILES]`, relative to the file that names them. Unreadable files are reported.
std::vector<ScriptFile> read_script_files(const core::YamlNode& node,
                                          core::Diagnostics& diagnostics);
// Runs the files, which define functions and handlers; errors are reported at their own positions.
void run_script_files(const std::vector<ScriptFile>& files, const std::shared_ptr<Script>& script,
                      core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
