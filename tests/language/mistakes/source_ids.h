// The ids of diagnostics as the loaders' sources write them.
#pragma once

#include <map>
#include <string>

namespace footfall::tests {

// id: the file that uses it. Ids are the words in the second argument of calls of error(),
// warning() and fail(), and behind the first comma of `error = {offset, id, text}`.
std::map<std::string, std::string> ids_in_sources(const std::string& root);

}  // namespace footfall::tests
