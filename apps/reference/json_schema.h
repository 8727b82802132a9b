// The JSON Schema (draft-07) of a file kind for editors, from the same tables as the loader.
//
// It checks keys, words and the form of values with their units; not user-defined names, nor
// anything that depends on the robot: `footfall check` does. A file that violates the schema is
// invalid; a file that satisfies it may still be.
#pragma once

#include <nlohmann/json.hpp>

#include "core/yaml/key_table.h"

namespace footfall::apps {

nlohmann::ordered_json json_schema(const core::FileTable& file);

}  // namespace footfall::apps
