// The name of a client of live tuning, for other people and for the log.
#pragma once

#include <string>

namespace footfall::engine {

// `who`; USER@HOST if it is empty. Throws std::invalid_argument for a name that the engine would
// refuse as malformed, or cut.
std::string client_name(const std::string& who);

}  // namespace footfall::engine
