// A log named on the command line.
#pragma once

#include <functional>
#include <string>

#include "lab/log/reader.h"

namespace footfall::apps {

// The folder of a log stands for the log in it.
std::string log_path(const std::string& argument);

// With all rows and inputs; a cut is told on stderr. Throws std::runtime_error.
lab::Log read_whole_log(const std::string& argument);

// What `work` returns; a std::runtime_error becomes a text on stderr and exit code 2.
int guarded(const std::function<int()>& work);

}  // namespace footfall::apps
