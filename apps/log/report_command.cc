// `footfall report`; see report_command.h.
#include "apps/log/report_command.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/log/report_film.h"
#include "apps/shared/external_program.h"
#include "apps/shared/log_argument.h"
#include "apps/shared/output_option.h"
#include "apps/shared/time_option.h"
#include "core/text/json_text.h"
#include "core/units/units.h"
#include "lab/log/reader.h"
#include "lab/log/window.h"
#include "lab/report/report.h"
#include "lab/report/states.h"
#include "lab/report/strip.h"
#include "lab/run/reload.h"

namespace footfall::apps {
namespace {

// Content of a file beside the log; empty if absent.
std::string text_beside(const std::filesystem::path& log, const char* name) {
  std::ifstream file(log.parent_path() / name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

// The requested part of a log.
lab::Log part_of(lab::Log log, const ReportArguments& arguments) {
  const TimeSpan span = read_span(arguments.from, arguments.to);
  if (!span.is_part) return log;
  lab::Log part = lab::log_window(log, span.from, span.to);
  if (part.rows() == 0) {
    throw std::runtime_error("--from, --to: '" + log.path + "' has no rows between these times");
  }
  return part;
}

// Prints the other logs of a run with reloads, which have their own reports.
void tell_reloads(const std::filesystem::path& log, std::FILE* stream) {
  std::filesystem::path folder = log.parent_path();
  if (folder.filename().string().starts_with("reload-")) folder = folder.parent_path();
  const std::string run = folder.empty() ? "." : folder.string();
  std::vector<std::string> logs = {run + "/log.mcap"};
  for (int k = 1; std::filesystem::exists(lab::reload_log(run, k)); ++k) {
    logs.push_back(lab::reload_log(run, k));
  }
  std::error_code error;
  for (const std::string& other : logs) {
    if (logs.size() == 1 || std::filesystem::equivalent(other, log, error)) continue;
    std::fprintf(stream, "  reloads      the run is also in %s\n", other.c_str());
  }
}

// Adds the state diagram. Needs the rows around each transition, so call it before thinning.
void draw_states(const lab::Log& log, lab::ReportOptions& options) {
  try {
    options.diagram_svg = run_program("dot", "-Tsvg", lab::state_graph(log), "graphviz");
  } catch (const std::runtime_error& error) {
    options.diagram_note = error.what();
  }
}

// A log whose robot cannot be loaded any more still has a report.
lab::RunSteps steps_of(const lab::Log& log) {
  try {
    return lab::log_steps(log);
  } catch (const std::runtime_error& error) {
    std::fprintf(stderr, "warning: the report has no table of steps: %s\n", error.what());
    return {};
  }
}

// Writes the comparison of several logs on one page.
void write_comparison(const ReportArguments& arguments, std::FILE* stream) {
  std::vector<std::string> names = {arguments.log};
  names.insert(names.end(), arguments.more.begin(), arguments.more.end());
  if (names.size() > lab::kMaxCompared) {
    throw std::runtime_error("at most " + std::to_string(lab::kMaxCompared) + " logs on one page");
  }
  if (!arguments.strip.empty() || !arguments.film.empty()) {
    throw std::runtime_error("--strip, --film: of one log, not of several");
  }
  std::vector<lab::Log> logs;
  std::vector<lab::ComparedRun> runs;
  for (const std::string& name : names) {
    logs.push_back(read_whole_log(name));
    lab::ComparedRun& run = runs.emplace_back();
    if (logs.size() == 1) continue;
    run.parting = lab::compare_logs(logs.front(), logs.back());
    logs.back().inputs = {};
  }
  for (std::size_t k = 0; k < logs.size(); ++k) {
    logs[k] = part_of(std::move(logs[k]), arguments);
    runs[k].summary_json = core::json_text(
        lab::page_summary(logs[k], text_beside(log_path(names[k]), "summary.json")));
    lab::keep_even_rows(logs[k]);
    runs[k].log = &logs[k];
  }
  const std::string out =
      arguments.out.empty()
          ? (std::filesystem::path(log_path(arguments.log)).parent_path() / "compare.html").string()
          : arguments.out;
  core::write_whole_file(out, lab::compare_html(runs, arguments.static_plots));
  std::fprintf(stream, "  report       %s\n", out.c_str());
}

}  // namespace

int write_report_files(const ReportArguments& arguments, std::FILE* stream) {
  const std::filesystem::path path(log_path(arguments.log));
  int exit_code = 0;
  try {
    std::vector<std::string> logs = {path.string()};
    for (const std::string& other : arguments.more) logs.push_back(log_path(other));
    require_no_input("-o", arguments.out, logs);
    require_no_input("--strip", arguments.strip, logs);
    require_no_input("--film", arguments.film, logs);
    require_film_name(arguments.film);
    if (!arguments.more.empty()) {
      write_comparison(arguments, stream);
      return 0;
    }
    lab::ReportOptions options;
    lab::Log log = lab::read_log(path.string(), {.all_rows = true, .inputs = true});
    options.steps = steps_of(log);
    log.inputs = {};
    log = part_of(std::move(log), arguments);
    draw_states(log, options);
    options.summary_json =
        core::json_text(lab::page_summary(log, text_beside(path, "summary.json")));
    lab::keep_even_rows(log);
    options.timing_json = text_beside(path, "timing.json");
    options.static_plots = arguments.static_plots;
    if (!arguments.no_strip) {
      try {
        const lab::StripMoments moments = lab::strip_moments(log);
        const sim::Image strip = film_strip(log, moments.times);
        options.strip_caption = moments.caption;
        options.strip_png = sim::encode_png(strip);
        if (!arguments.strip.empty()) sim::write_png(strip, arguments.strip);
      } catch (const std::runtime_error& error) {
        options.strip_note = error.what();
        std::fprintf(stderr, "warning: the report has no film strip: %s\n", error.what());
        if (!arguments.strip.empty()) exit_code = 3;
      }
    }
    const std::string out =
        arguments.out.empty() ? (path.parent_path() / "report.html").string() : arguments.out;
    lab::write_report(log, out, options);
    std::fprintf(stream, "  report       %s\n", out.c_str());
    tell_reloads(path, stream);
    if (!log.complete)
      std::fprintf(stderr, "warning: the log was cut off; the report ends there\n");
    if (!arguments.film.empty()) {
      try {
        write_film(log, arguments.film);
        std::fprintf(stream, "  film         %s\n", arguments.film.c_str());
      } catch (const std::runtime_error& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        exit_code = 3;
      }
    }
  } catch (const std::runtime_error& error) {
    return tell_error(error);
  }
  return exit_code;
}

void add_report_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReportArguments>();
  CLI::App* command = app.add_subcommand(
      "report",
      "Writes one self-contained HTML page from the log of a run, or of several side by side");
  command->add_option("LOG", arguments->log, "log.mcap, or the folder it is in")->required();
  command->add_option("OTHER", arguments->more, "further logs, compared with the first");
  command->add_option("-o,--output", arguments->out,
                      "the page (default: report.html beside the log, compare.html for several)");
  command->add_option("--from", arguments->from, "only from this time in the run, e.g. 12.3s");
  command->add_option("--to", arguments->to, "only up to this time");
  command->add_option("--strip", arguments->strip, "write the film strip as PNG, too");
  command->add_option("--film", arguments->film, "write the run as MP4 (needs ffmpeg)");
  command->add_flag("--no-strip", arguments->no_strip, "a page without pictures of the robot");
  command->add_flag("--static", arguments->static_plots, "plots as SVG, without script");
  command->footer(
      "Example: footfall report out/demo -o report.html --strip strip.png\n"
      "         footfall report out/before out/after");
  command->callback(
      [arguments, &exit_code] { exit_code = write_report_files(*arguments, stdout); });
}

}  // namespace footfall::apps
