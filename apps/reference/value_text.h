// What may stand under a key, in words: for the reference, and for what an editor shows.
#pragma once

#include <string>

#include "core/yaml/key_table.h"

namespace footfall::apps {

// "time", "list of transitions", "`mean` or `sum`"; with `links`, maps are links to their headings
// in Markdown.
std::string value_text(const core::ValueSpec& value, bool links);
// All that may stand there: "number, or list of numbers".
std::string values_text(const core::KeySpec& key, bool links);
// The line of an editor: doc, value, what holds without it.
std::string hover_text(const core::KeySpec& key);
// The words of a list with blanks between, as `a`, `b` or `c`.
std::string alternatives_text(std::string_view words);

}  // namespace footfall::apps
