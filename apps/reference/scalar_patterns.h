// Regular expressions (JavaScript syntax) for values written as text, for the schema.
#pragma once

#include <string>

#include "core/yaml/key_table.h"

namespace footfall::apps {

// Allowed for every value: `off`, which removes, or a text with a `$name` of a parameter or
// argument.
std::string substituted_pattern();
// Allowed texts of a value, other than numbers and lists; "" if any text is allowed.
std::string text_pattern(const core::ValueSpec& value);

}  // namespace footfall::apps
