// Registration of all sub-commands, and functions that they share.
#pragma once

#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "core/yaml/key_table.h"
#include "model/aids/springs.h"

namespace CLI {
class App;
}

namespace footfall::sim {
struct WorldDescription;
}

namespace footfall::apps {

// An input error: printed without prefix, exit code 2. Empty if already printed.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Prints what ended a command and returns its exit code: kMachineFailed for core::MachineError
// and what files and memory refuse, kBadInput for InputError and for a text with a place
// ("FILE:LINE: error: ..."), else `otherwise`.
int tell_error(const std::exception& error, int otherwise = 2);
// The exit code of `work`, or of the exception that it throws.
int guarded(const std::function<int()>& work, int otherwise = 2);

inline constexpr int kGood = 0;
inline constexpr int kRobotFailed = 1;    // the robot fell, or a test failed
inline constexpr int kBadInput = 2;       // input error
inline constexpr int kMachineFailed = 3;  // machine or backend failure

// Each function adds a sub-command whose callback sets `exit_code`.
void add_run_command(CLI::App& app, int& exit_code);
void add_check_command(CLI::App& app, int& exit_code);
void add_trace_command(CLI::App& app, int& exit_code);
void add_signals_command(CLI::App& app, int& exit_code);
void add_graph_command(CLI::App& app, int& exit_code);
void add_schema_command(CLI::App& app, int& exit_code);
void add_reference_command(CLI::App& app, int& exit_code);

// The kinds of user files, as key tables.
std::vector<const core::FileTable*> file_tables();
void add_fmt_command(CLI::App& app, int& exit_code);
void add_config_command(CLI::App& app, int& exit_code);
void add_new_command(CLI::App& app, int& exit_code);
void add_list_command(CLI::App& app, int& exit_code);
void add_events_command(CLI::App& app, int& exit_code);
void add_test_command(CLI::App& app, int& exit_code);
void add_runs_command(CLI::App& app, int& exit_code);
void add_replay_command(CLI::App& app, int& exit_code);
void add_diff_command(CLI::App& app, int& exit_code);
void add_why_command(CLI::App& app, int& exit_code);
void add_export_command(CLI::App& app, int& exit_code);
void add_identify_command(CLI::App& app, int& exit_code);
void add_sweep_command(CLI::App& app, int& exit_code);
void add_set_command(CLI::App& app, int& exit_code);
void add_tune_command(CLI::App& app, int& exit_code);

// Folders with robots/, behaviors/library/ and sim/worlds/: the working folder, those of
// FOOTFALL_PATH (separated by colons), the source tree, the installed data.
std::vector<std::string> search_path();

// Those of them that belong to an installation: no command writes there.
std::vector<std::string> installed_folders();

// NAME itself if it is a file, else behaviors/library/NAME.yaml in the search path; NAME if not
// found.
std::string find_behavior_file(const std::string& name);

// The same for a behavior, a world or a robot, in this order; empty, and an error with a
// suggestion, if there is none.
std::string require_named_file(const std::string& name, core::Diagnostics& diagnostics);
// Search folders for `base: NAME` of behaviors and worlds.
std::vector<std::string> base_folders();

// False, and an error with a suggestion, if there is no such file and none in the library.
bool behavior_is_there(const std::string& name, core::Diagnostics& diagnostics);

// Loads a behavior, checks its physics if a world is given, and prints every problem on stderr;
// nullptr if there were errors.
std::unique_ptr<behaviors::Behavior> load_or_explain(
    const std::string& path, const std::string& robot, const std::vector<std::string>& set,
    const behaviors::PhysicsWorld* world = nullptr);

// What the physics checks take from a world, before a seed is drawn: the least friction and the
// longest delay that can be drawn. More delay never makes a loop stable: its gain falls with
// frequency, so that it crosses 1 once, and delay only takes phase from it there. `held`: something
// else than the world holds the robot, a stand or a scenario.
behaviors::PhysicsWorld physics_world(const sim::WorldDescription& world, bool held);

// Reports what the world needs and the robot lacks: links that it names, actuators; and springs of
// its constraints and of a scenario's holds that physics cannot integrate.
void check_world_fits(const sim::WorldDescription& world, const model::RobotDescription& robot,
                      core::Diagnostics& diagnostics,
                      const std::vector<model::BodySprings>& holds = {});

// Prints every problem on stderr, `error` and `warning` in colour on a terminal (unless NO_COLOR is
// set).
void print_diagnostics(const core::Diagnostics& diagnostics);

// Splits NAME=VALUE texts; a text without `=` and a name given twice are reported as errors.
std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& set,
                                                                core::Diagnostics& diagnostics);

}  // namespace footfall::apps
