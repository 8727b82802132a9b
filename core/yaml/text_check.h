// Checks a YAML text before it is parsed. Load time only.
#pragma once

#include <string_view>

#include "core/diagnostics/diagnostics.h"

namespace footfall::core {

// Reports text that yaml-cpp would accept or misread (one problem a line, at most 20): invalid
// UTF-8 and control characters (id "bad-text"), tabs in the indentation (id "tab"). True if there
// is none.
bool check_text(std::string_view text, int file, Diagnostics& diagnostics);

}  // namespace footfall::core
