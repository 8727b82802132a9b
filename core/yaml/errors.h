// Replaces messages of the YAML parser by messages that name the remedy.
#pragma once

#include <string>

namespace footfall::core {

// The rewritten message; unknown messages are returned unchanged.
std::string yaml_error_text(const std::string& message);

}  // namespace footfall::core
