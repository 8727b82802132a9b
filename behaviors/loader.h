// From a behavior file to a compiled Behavior: the one entry point of the language.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "core/diagnostics/diagnostics.h"

namespace footfall::behaviors {

// A C++ function that behaviors may `call:`.
struct NativeFunctionInfo {
  std::string name;
  NativeFunction function = nullptr;
};

struct LoadOptions {
  std::vector<std::string> search;  // folders of robots/NAME/robot.yaml, behaviors/library
  std::string robot;                // overrides the file's `robot:` if not empty
  std::vector<NativeFunctionInfo> functions;             // registered by the program
  std::vector<std::pair<std::string, std::string>> set;  // --set NAME=VALUE, texts as in YAML
};

// Loads, checks and compiles; nullptr if there were errors. Warnings do not prevent it.
std::unique_ptr<Behavior> load_behavior(const std::string& path, const LoadOptions& options,
                                        core::Diagnostics& diagnostics);
// The same from text (tests); `name` stands for the file.
std::unique_ptr<Behavior> load_behavior_text(std::string_view text, const std::string& name,
                                             const LoadOptions& options,
                                             core::Diagnostics& diagnostics);

// Where `base: NAME` finds behaviors by name: behaviors/library in each folder of `search`.
std::vector<std::string> library_folders(const std::vector<std::string>& search);

}  // namespace footfall::behaviors
