// From a file's tree to a compiled behavior, for those who need what the loader's steps leave
// beside it. Load time only.
#pragma once

#include <string>

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// All steps from a file's tree to `context.behavior`; false after errors.
bool compile_behavior(LoadContext& context, core::YamlNode root, const std::string& path);

}  // namespace footfall::behaviors
