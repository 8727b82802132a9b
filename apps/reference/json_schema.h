// The JSON Schema (draft-07) of a kind of file, for editors: from the same tables as the loader.
//
// It knows keys, words and the form of values with their units; not names of the author's own, nor
// what needs the robot: that is what `footfall check` is for. What it accepts may be wrong; what it
// refuses is.
#pragma once

#include <nlohmann/json.hpp>

#include "core/yaml/key_table.h"

namespace footfall::apps {

nlohmann::ordered_json json_schema(const core::FileTable& file);

}  // namespace footfall::apps
