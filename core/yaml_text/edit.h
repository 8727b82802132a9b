// Edits single values in the text of a YAML file; all other bytes stay unchanged. Load-time tools
// only; independent of the meaning of the values.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/text/file_change.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// Replacement of the bytes [begin, end) of a text.
struct TextEdit {
  std::size_t begin = 0, end = 0;
  std::string text;
};

// The scalar that begins at a mark's line and column, including quotes; for an alias, the scalar at
// its anchor. nullopt if absent or if it spans several lines.
std::optional<TextEdit> find_scalar(std::string_view text, Mark mark);

// The edit that inserts `value` (flow YAML) under a path of missing keys, behind the last entry of
// the innermost existing map and in that map's layout. `root` is the tree of the text. nullopt if a
// key on the path holds something other than a map, or if the layout is unsupported.
std::optional<TextEdit> add_value(std::string_view text, const YamlNode& root,
                                  const std::vector<std::string>& path, const std::string& value);

// Applies all edits; equal edits count once. nullopt if two different edits overlap.
std::optional<std::string> apply_edits(std::string_view text, std::vector<TextEdit> edits);

}  // namespace footfall::core
