// Checks a YAML text before it is parsed. Load time only.
#pragma once

#include <string>
#include <string_view>

#include "core/diagnostics/diagnostics.h"

namespace footfall::core {

// Turns every lone CR, a line end of YAML that yaml-cpp does not count as one, into LF. No place
// moves by it.
void make_line_ends_plain(std::string& text);

// Reports text that yaml-cpp would accept or misread: another encoding than UTF-8, invalid bytes,
// control characters and characters that only look like blanks where YAML needs one (id
// "bad-text", each character once, with the number of lines), tabs in the indentation (id "tab",
// one a line, at most 20). True if there is none.
bool check_text(std::string_view text, int file, Diagnostics& diagnostics);

// Reports a key whose ':' only looks like one (id "bad-text"), in the line where YAML failed or in
// the text that leads to it; false if there is none. Elsewhere such a text may be meant.
bool report_false_colon(std::string_view text, int failed_line, int file, Diagnostics& diagnostics);

}  // namespace footfall::core
