// The options of `footfall run`.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "apps/shared/live_options.h"

namespace CLI {
class App;
}

namespace footfall::apps {

struct RunOptions {
  std::string behavior;
  std::string robot;
  std::string backend = "mujoco";
  std::string world = "flat";
  std::string duration_text;  // as written, e.g. `20s`
  double duration = 20.0;     // s; 0: unlimited
  std::int64_t steps = 0;     // 0: unlimited
  std::uint64_t seed = 1;
  std::vector<std::string> set;
  std::vector<std::string> pushes;
  std::string variation;  // `off`: the seed draws nothing of the world; empty: as the world says
  std::string goal, goal_velocity;
  std::string log;  // output folder; empty: a new one in out/run
  bool no_log = false;
  bool no_report = false;
  std::string film;  // path of an MP4; empty: none
  bool log_all = false;
  int log_every = 6;  // ticks per row: 250 Hz at 1500 Hz
  bool json = false;
  bool quiet = false;
  bool realtime = false;
  LiveOptions live;
  bool reload = false;  // reload a changed behavior file
  // Of --set: those of the world, without `world.`.
  std::vector<std::pair<std::string, std::string>> world_set;
  std::vector<std::string> given;  // options given, e.g. `--seed`
  std::vector<std::string> allow;  // capabilities of scripts: files, processes
};

void add_run_options(CLI::App& command, RunOptions& options);
// Sets options that depend on others. Throws std::runtime_error with "--for: error: ...".
void finish_options(RunOptions& options);

}  // namespace footfall::apps
