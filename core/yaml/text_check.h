// What a YAML text must be before it is parsed. Load time only.
#pragma once

#include <string_view>

#include "core/diagnostics/diagnostics.h"

namespace footfall::core {

// Reports what yaml-cpp would take, or take wrongly, each at its place (the first of a line, at
// most 20): bytes that are not UTF-8 (ids "bad-text"), control characters, and tabs in the
// indentation
// ("tab"). True if there is nothing of the kind.
bool check_text(std::string_view text, int file, Diagnostics& diagnostics);

}  // namespace footfall::core
