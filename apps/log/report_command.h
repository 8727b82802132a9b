// `footfall report`: an HTML page, a film strip and a film from the log of a run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace footfall::apps {

struct ReportArguments {
  std::string log;                // log.mcap, or the folder it is in
  std::vector<std::string> more;  // other logs: all on one page
  std::string out;                // default: report.html beside the log; with others compare.html
  std::string strip;              // a PNG besides the page
  std::string film;               // an MP4
  std::string from, to;           // times in the run, e.g. `12.3s`; empty: its beginning, its end
  bool no_strip = false;
  bool static_plots = false;
};

// Writes what is asked for and prints the paths on `out`; returns the exit code, see below.
int write_report_files(const ReportArguments& arguments, std::FILE* out);

// Registers the command. When it is called, it runs and puts the process's exit code into
// exit_code: 0 good, 2 the input is wrong (no such log, not a log, nowhere to write), 3 no film
// although one was asked for (ffmpeg or EGL is missing). Errors are one line each on stderr.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace footfall::apps
