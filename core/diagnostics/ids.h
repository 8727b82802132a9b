// Every id that a diagnostic may carry; used by editors, tests and the reference.
#pragma once

#include <span>
#include <string_view>

#include "core/diagnostics/diagnostics.h"

namespace footfall::core {

struct DiagnosticInfo {
  std::string_view id;  // lower case and '-'; never renamed, because users filter by it
  Severity severity = Severity::error;
  std::string_view meaning;  // one line
};

// All ids in alphabetical order. Each has a case in tests/language/mistakes.
std::span<const DiagnosticInfo> diagnostic_ids();
// nullptr if unknown.
const DiagnosticInfo* find_diagnostic_id(std::string_view id);

}  // namespace footfall::core
