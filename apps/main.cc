// The `footfall` command; each sub-command has its own file.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <sstream>
#include <string>

#include "apps/log/report_command.h"
#include "apps/shared/commands.h"
#include "apps/shared/live_options.h"
#include "apps/shared/usage.h"
#include "core/process/standard_streams.h"
#include "core/realtime/watched_thread.h"
#include "lab/process/pool.h"
#include "lab/run/version.h"

namespace {

int run_command(int argc, char** argv) {
  CLI::App app{
      "Footfall executes behaviors for legged robots.\n"
      "Exit codes: 0 good, 1 the robot fell or a test failed, 2 the input is wrong, "
      "3 the machine or the backend failed."};
  app.name("footfall");
  app.set_version_flag("--version", footfall::lab::kVersion);
  app.require_subcommand(1);
  int exit_code = 0;
  footfall::apps::add_run_command(app, exit_code);
  footfall::apps::add_test_command(app, exit_code);
  footfall::apps::add_sweep_command(app, exit_code);
  footfall::apps::add_check_command(app, exit_code);
  footfall::apps::add_trace_command(app, exit_code);
  footfall::apps::add_signals_command(app, exit_code);
  footfall::apps::add_graph_command(app, exit_code);
  footfall::apps::add_schema_command(app, exit_code);
  footfall::apps::add_reference_command(app, exit_code);
  footfall::apps::add_fmt_command(app, exit_code);
  footfall::apps::add_config_command(app, exit_code);
  footfall::apps::add_set_command(app, exit_code);
  footfall::apps::add_new_command(app, exit_code);
  footfall::apps::add_list_command(app, exit_code);
  footfall::apps::add_report_command(app, exit_code);
  footfall::apps::add_runs_command(app, exit_code);
  footfall::apps::add_events_command(app, exit_code);
  footfall::apps::add_replay_command(app, exit_code);
  footfall::apps::add_diff_command(app, exit_code);
  footfall::apps::add_why_command(app, exit_code);
  footfall::apps::add_export_command(app, exit_code);
  footfall::apps::add_identify_command(app, exit_code);
  footfall::apps::add_tune_command(app, exit_code);
  try {
    footfall::apps::join_live_url(argc, argv);
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      std::ostringstream text;
      app.exit(error, text, text);
      std::fputs(text.str().c_str(), stdout);
      return footfall::apps::kGood;
    }
    std::fputs(footfall::apps::usage_error(app, error, argc, argv).c_str(), stderr);
    return footfall::apps::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "footfall: error: %s\n", error.what());
    return footfall::apps::kMachineFailed;
  }
  return exit_code;
}

// `exit_code`, or kMachineFailed if not all of the output was written.
int written_or(int exit_code) {
  const std::string lost = footfall::core::finish_standard_output();
  if (lost.empty()) return exit_code;
  std::fprintf(stderr, "footfall: error: cannot write to the standard output: %s\n", lost.c_str());
  return footfall::apps::kMachineFailed;
}

}  // namespace

int main(int argc, char** argv) {
  footfall::core::open_standard_streams();
  footfall::lab::die_with_parent();
  const int exit_code = run_command(argc, argv);
  const int last = written_or(exit_code);
  // What such a thread uses must not be destroyed below it.
  if (footfall::core::threads_were_let_go()) ::_exit(last);
  return last;
}
