// `footfall check`: everything that can be known before a motor moves.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "apps/commands.h"
#include "behaviors/physics_check.h"

namespace footfall::apps {
namespace {

// Loads a behavior and, with a robot, judges what it asks of its physics.
void check_file(const std::string& file, core::Diagnostics& diagnostics) {
  behaviors::LoadOptions options;
  options.search = search_path();
  const auto behavior = behaviors::load_behavior(find_behavior_file(file), options, diagnostics);
  if (!behavior || !behavior->has_robot) return;
  try {
    behaviors::check_physics(*behavior, diagnostics);
  } catch (const std::exception& error) {
    diagnostics.error({diagnostics.add_file(behavior->robot.path), 0, 0}, "model", error.what());
  }
}

}  // namespace

void add_check_command(CLI::App& app, int& exit_code) {
  struct Options {
    std::vector<std::string> files;
    bool strict = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand("check", "Checks behavior files without running them");
  command->add_option("FILE", options->files, "Behavior files")->required();
  command->add_flag("--strict", options->strict, "Exit 1 if there are warnings");
  command->footer("Example: footfall check behaviors/library/balance.yaml");
  command->callback([options, &exit_code] {
    exit_code = kGood;
    for (const std::string& file : options->files) {
      core::Diagnostics diagnostics;
      check_file(file, diagnostics);
      std::fputs(diagnostics.to_string().c_str(), stderr);
      if (diagnostics.has_errors()) {
        exit_code = kBadInput;
      } else if (!diagnostics.all().empty() && options->strict) {
        exit_code = std::max(exit_code, kRobotFailed);
      } else {
        fmt::print("{}: ok\n", file);
      }
    }
  });
}

}  // namespace footfall::apps
