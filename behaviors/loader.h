// From a behavior file to a compiled Behavior: the one entry point of the language.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/load/options.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// Loads, checks and compiles; nullptr if there were errors. Warnings do not prevent it, nor does
// what options.check finds.
std::unique_ptr<Behavior> load_behavior(const std::string& path, const LoadOptions& options,
                                        core::Diagnostics& diagnostics);
// The same from text (tests); `name` stands for the file.
std::unique_ptr<Behavior> load_behavior_text(std::string_view text, const std::string& name,
                                             const LoadOptions& options,
                                             core::Diagnostics& diagnostics);

}  // namespace footfall::behaviors
