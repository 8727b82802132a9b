// Times on the command line.
#pragma once

#include <string>

namespace footfall::apps {

// Seconds of a text such as `2.5s`; a bare number is seconds. Throws std::runtime_error
// (`--from: error: expected a time such as 2.5s, got '2,5s' ...`) that says what is near.
double read_time(const std::string& text, const char* option);
// The same; `otherwise` for an empty text, an option that was not given.
double read_time(const std::string& text, const char* option, double otherwise);

}  // namespace footfall::apps
