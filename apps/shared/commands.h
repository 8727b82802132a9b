// What every sub-command offers to main(), and what they share.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "core/yaml/key_table.h"

namespace CLI {
class App;
}

namespace footfall::apps {

// A mistake in the input: printed as it is, exit code 2; empty: printed already.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

inline constexpr int kGood = 0;
inline constexpr int kRobotFailed = 1;    // the robot fell, or a test failed
inline constexpr int kBadInput = 2;       // the input is wrong
inline constexpr int kMachineFailed = 3;  // the machine or the backend failed

// Each adds its sub-command with a callback that sets `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_trace_command(CLI::App& app, int& exit_code);
void add_signals_command(CLI::App& app, int& exit_code);
void add_graph_command(CLI::App& app, int& exit_code);
void add_schema_command(CLI::App& app, int& exit_code);
void add_reference_command(CLI::App& app, int& exit_code);

// The kinds of file that people write, as tables of keys.
std::vector<const core::FileTable*> file_tables();
void add_fmt_command(CLI::App& app, int& exit_code);
void add_config_command(CLI::App& app, int& exit_code);
void add_new_command(CLI::App& app, int& exit_code);
void add_events_command(CLI::App& app, int& exit_code);
void add_test_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_diff_command(CLI::App& app, int& exit_code);
void add_why_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_sweep_command(CLI::App& app, int& exit_code);
void add_set_command(CLI::App& app, int& exit_code);
void add_tune_command(CLI::App& app, int& exit_code);

// Folders that hold robots/, behaviors/library/ and sim/worlds/: the working folder, those of
// FOOTFALL_PATH (colons between), the source tree, the installed data.
std::vector<std::string> search_path();

// NAME itself if it is a file, else behaviors/library/NAME.yaml in the search path; NAME if
// nowhere.
std::string find_behavior_file(const std::string& name);

// Loads a behavior, judges what it asks of its robot's physics if told to, and prints every problem
// on stderr; nullptr if there were errors.
std::unique_ptr<behaviors::Behavior> load_or_explain(const std::string& path,
                                                     const std::string& robot,
                                                     const std::vector<std::string>& set,
                                                     bool physics = false);

// Every problem on stderr, `error` and `warning` in colour on a terminal (unless NO_COLOR is set).
void print_diagnostics(const core::Diagnostics& diagnostics);

// Splits NAME=VALUE texts; a text without `=` is reported as an error.
std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& set,
                                                                core::Diagnostics& diagnostics);

}  // namespace footfall::apps
