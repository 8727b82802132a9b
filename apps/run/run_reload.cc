// Files, messages and logs of reloads; see run_reload.h.
#include "apps/run/run_reload.h"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <set>
#include <utility>

#include "lab/run/log_setup.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

constexpr double kLookEvery = 0.25;  // s, period of looking for changed files

// Clears the status line before a message.
void clear_line() {
  if (isatty(STDERR_FILENO) != 0) std::fputs("\r\033[K", stderr);
}

lab::ReloadSetup reload_setup(const RunOptions& options, hal::Hardware& hardware,
                              const sim::WorldDescription& world,
                              const behaviors::PhysicsWorld& physics) {
  lab::ReloadSetup setup;
  setup.hardware = &hardware;
  setup.load.search = search_path();
  setup.load.robot = options.robot;
  setup.load.world = physics.actuators;
  core::Diagnostics ignored;  // reported when they were split before
  setup.load.set = split_settings(options.set, ignored);
  setup.source = log_source(options, world);
  setup.world = physics;
  if (!options.no_log) setup.folder = options.log;
  setup.print = [](const core::Diagnostics& diagnostics) {
    clear_line();
    print_diagnostics(diagnostics);
  };
  setup.tell = [](const std::string& line) {
    clear_line();
    std::fprintf(stderr, "%s\n", line.c_str());
  };
  return setup;
}

}  // namespace

LiveFiles watch_files(const RunOptions& options, engine::ControlLoop& loop, hal::Hardware& hardware,
                      const sim::WorldDescription& world, const behaviors::PhysicsWorld& physics,
                      const lab::RunSpec& spec) {
  LiveFiles live;
  if (!options.reload) return live;
  lab::ReloadSetup setup = reload_setup(options, hardware, world, physics);
  setup.live = spec.live;
  setup.said = spec.said;
  live.reloads = std::make_unique<lab::Reloads>(loop, std::move(setup));
  std::set<std::string> files;
  for (const engine::LogFile& file : lab::source_files(loop.behavior(), ""))
    files.insert(file.path);
  const std::string path = find_behavior_file(options.behavior);
  live.watch = std::make_unique<engine::FileWatch>(
      std::vector<std::string>(files.begin(), files.end()), kLookEvery,
      [reloads = live.reloads.get(), path, files]() mutable {
        for (const std::string& file : reloads->request(path)) {
          std::error_code error;
          if (fs::exists(file, error)) files.insert(fs::absolute(file).lexically_normal().string());
        }
        return std::vector<std::string>(files.begin(), files.end());
      },
      [reloads = live.reloads.get()] { reloads->tend(); });
  return live;
}

}  // namespace footfall::apps
