// Log arguments on the command line.
#pragma once

#include <string>
#include <vector>

#include "apps/shared/time_option.h"
#include "lab/log/reader.h"

namespace footfall::apps {

// Path of the log; the argument may be its folder, or a folder of runs, whose newest one is meant.
std::string log_path(const std::string& argument);

// All logs of a run, in order: its reloads have one each. A log named by its file is alone.
std::vector<std::string> run_logs(const std::string& argument);

// Reads all rows and inputs; prints a note on stderr if the log is truncated. Throws
// std::runtime_error.
lab::Log read_whole_log(const std::string& argument);

// Throws std::runtime_error that names the run's times if its logs have nothing of the span.
void require_part_of(const std::vector<lab::Log>& logs, const TimeSpan& span);

}  // namespace footfall::apps
