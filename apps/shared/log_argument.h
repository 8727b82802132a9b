// Log arguments on the command line.
#pragma once

#include <functional>
#include <string>

#include "lab/log/reader.h"

namespace footfall::apps {

// Path of the log; the argument may be its folder.
std::string log_path(const std::string& argument);

// Reads all rows and inputs; prints a note on stderr if the log is truncated. Throws
// std::runtime_error.
lab::Log read_whole_log(const std::string& argument);

// Returns the result of `work`; a std::runtime_error is printed on stderr and gives exit code 2.
int guarded(const std::function<int()>& work);

}  // namespace footfall::apps
