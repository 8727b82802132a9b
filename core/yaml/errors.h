// What the YAML parser complains about, in words that say what to do.
#pragma once

#include <string>

namespace footfall::core {

// The parser's message in plain words; unknown ones stay as they are.
std::string yaml_error_text(const std::string& message);

}  // namespace footfall::core
