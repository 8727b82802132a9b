// Edits of single values in the text of a YAML file: every byte but the value's own stays.
// Load-time tools only; nothing here knows what the values mean.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/file_change.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// The bytes [begin, end) of a text, and what stands there instead.
struct TextEdit {
  std::size_t begin = 0, end = 0;
  std::string text;
};

// The scalar that begins at a mark's line and column, with its quotes; of an alias, the scalar that
// its anchor names. Nothing: there is none, or it goes over several lines.
std::optional<TextEdit> find_scalar(std::string_view text, Mark mark);

// The edit that puts `value` (flow YAML) under a path of keys that is not there yet, behind the
// last entry of the innermost map that is, in that map's layout. `root` is the text's own tree.
// Nothing where a key on the way holds something else than a map, or in a layout that this does not
// know.
std::optional<TextEdit> add_value(std::string_view text, const YamlNode& root,
                                  const std::vector<std::string>& path, const std::string& value);

// The text with all edits made; equal ones count once. Nothing if two of them meet otherwise.
std::optional<std::string> apply_edits(std::string_view text, std::vector<TextEdit> edits);

}  // namespace footfall::core
