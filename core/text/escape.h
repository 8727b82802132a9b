// Text of people in languages with signs of their own.
#pragma once

#include <string>
#include <string_view>

namespace footfall::core {

// For HTML and XML, between tags and in attributes in double quotes: `& < > "` as entities, control
// characters as blanks.
std::string escape_html(std::string_view text);

}  // namespace footfall::core
