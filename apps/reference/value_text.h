// Textual description of the values of a key, for the reference and for editors.
#pragma once

#include <string>

#include "core/yaml/key_table.h"

namespace footfall::apps {

// "time", "list of transitions", "`mean` or `sum`"; with `links`, maps are links to their headings
// in Markdown.
std::string value_text(const core::ValueSpec& value, bool links);
// All alternatives: "number, or list of numbers".
std::string values_text(const core::KeySpec& key, bool links);
// Hover text of an editor: doc, value, default.
std::string hover_text(const core::KeySpec& key);
// Formats words separated by blanks as `a`, `b` or `c`.
std::string alternatives_text(std::string_view words);

}  // namespace footfall::apps
