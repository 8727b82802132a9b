// Regular expressions (as in JavaScript) for the texts of values: what a schema can say about them.
#pragma once

#include <string>

#include "core/yaml/key_table.h"

namespace footfall::apps {

// What every value may be: `off`, which removes, or a text with a `$name` of a parameter or
// argument.
std::string substituted_pattern();
// A value's texts, not counting numbers and lists; "" if any text will do.
std::string text_pattern(const core::ValueSpec& value);

}  // namespace footfall::apps
