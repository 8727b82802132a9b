// `footfall report`: an HTML page, a film strip and a film from the log of a run.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

namespace footfall::apps {

struct ReportArguments {
  std::string log;                // log.mcap, or its folder
  std::vector<std::string> more;  // further logs: compared on one page
  std::string out;                // default: report.html beside the log, or compare.html
  std::string strip;              // path of a PNG film strip; empty: none
  std::string film;               // path of an MP4; empty: none
  std::string from, to;           // times in the run, e.g. `12.3s`; empty: beginning, end
  bool no_strip = false;
  bool static_plots = false;
};

// Writes the requested files and prints their paths on `out`; returns the exit code, see below.
int write_report_files(const ReportArguments& arguments, std::FILE* out);

// Registers the command; its callback sets exit_code: 0 success, 2 input error (log missing or
// malformed, output not writable), 3 if a requested film cannot be made (ffmpeg or EGL is missing).
// Errors are one line each on stderr.
void add_report_command(CLI::App& app, int& exit_code);

}  // namespace footfall::apps
