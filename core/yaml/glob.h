// Names by pattern: `"*knee": 22` in per-joint maps, `["right_*"]` in lists. Load time only.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/yaml/yaml.h"

namespace footfall::core {

// True if the text holds a `*` or `?`.
bool is_glob(std::string_view text);
// `*` stands for any text, `?` for one character, all else for itself. Linear in time per star.
bool glob_matches(std::string_view pattern, std::string_view text);

// For every one of `names`, the entry of the map that speaks of it, or nullptr: exact keys first,
// then globs. Errors: a key that is no name (with the nearest), a glob that matches nothing, two
// globs on one name. `what` is the kind of name, e.g. "joint". A node that is no map: an error.
std::vector<const YamlEntry*> match_names(const YamlNode& map,
                                          const std::vector<std::string>& names,
                                          std::string_view what, Diagnostics& diagnostics);

// The indices into `names` that a list of names and globs stands for, in the order of the list,
// each once. Errors as above; a name given twice by exact text is an error too.
std::vector<int> expand_names(const YamlNode& list, const std::vector<std::string>& names,
                              std::string_view what, Diagnostics& diagnostics);

}  // namespace footfall::core
