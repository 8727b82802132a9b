// Escapes text for markup languages.
#pragma once

#include <string>
#include <string_view>

namespace footfall::core {

// For HTML and XML text and double-quoted attributes: `& < > "` become entities, control characters
// become blanks.
std::string escape_html(std::string_view text);

}  // namespace footfall::core
