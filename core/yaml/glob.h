// Name patterns: `"*knee": 22` in per-joint maps, `["right_*"]` in lists. Load time only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// True if the text contains `*` or `?`.
bool is_glob(std::string_view text);
// `*` matches any text, `?` one character, everything else itself. Linear in time per star.
bool glob_matches(std::string_view pattern, std::string_view text);

// For each of `names`, the entry of the map that applies to it, or nullptr: exact keys first, then
// patterns. Errors: an unknown name (with the nearest known one), a pattern without a match, two
// patterns that match one name, a node that is not a map. `what` is the kind of name, e.g. "joint".
std::vector<const YamlEntry*> match_names(const YamlNode& map,
                                          const std::vector<std::string>& names,
                                          std::string_view what, Diagnostics& diagnostics);

// The indices into `names` selected by a list of names and patterns, in list order, each once.
// Errors as above; repeating an exact name is an error too.
std::vector<int> expand_names(const YamlNode& list, const std::vector<std::string>& names,
                              std::string_view what, Diagnostics& diagnostics);

}  // namespace footfall::core
