// Where things are found that files name without a path: robots, behaviors, worlds.
#pragma once

#include <string>
#include <vector>

namespace footfall::core {

// Whether the path is a file, or a descriptor that the shell has opened (`<(COMMAND)`, /dev/stdin).
// A pipe of another name could have nobody who writes to it, and would be waited for without end.
bool is_readable_source(const std::string& path);

// The file's folder and those above it, then `search`: a project is found from wherever one works.
std::vector<std::string> search_from(const std::string& file,
                                     const std::vector<std::string>& search);

// The names of `FOLDER/PLACE/*.yaml` (or, with `inside`, of the folders that hold that file) in all
// folders, sorted, each once: candidates for a suggestion.
std::vector<std::string> names_in(const std::vector<std::string>& folders, const std::string& place,
                                  const std::string& inside = "");

}  // namespace footfall::core
