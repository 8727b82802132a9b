// Every id that a diagnostic may carry: what editors, tests and the reference go by.
#pragma once

#include <span>
#include <string_view>

#include "core/diagnostics/diagnostics.h"

namespace footfall::core {

struct DiagnosticInfo {
  std::string_view id;  // small letters and '-'; never renamed, people filter by it
  Severity severity = Severity::error;
  std::string_view meaning;  // one line
};

// All of them, in alphabetical order. Each has a case in tests/language/mistakes.
std::span<const DiagnosticInfo> diagnostic_ids();
// nullptr if there is no such id.
const DiagnosticInfo* find_diagnostic_id(std::string_view id);

}  // namespace footfall::core
