// `footfall report`: an HTML page, a film strip and a film from the log of a run.
#pragma once

#include <CLI/CLI.hpp>

namespace footfall::apps {

// Registers the command. When it is called, it runs and puts the process's exit code into
// exit_code: 0 good, 2 the input is wrong (no such log, not a log, nowhere to write), 3 no film
// although one was asked for (ffmpeg or EGL is missing). Errors are one line each on stderr.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace footfall::apps
