// `run --reload`: watches the behavior's files and passes changed versions to the run.
#pragma once

#include <memory>

#include "apps/run/run_setup.h"
#include "engine/realtime/file_watch.h"
#include "lab/run/reload.h"

namespace footfall::apps {

// Both null without --reload. Destroy `watch` first.
struct LiveFiles {
  std::unique_ptr<lab::Reloads> reloads;
  std::unique_ptr<engine::FileWatch> watch;
};

// hardware: of the loop; world: as drawn; physics: as changed files are checked; spec: of the run.
// All must outlive the result.
LiveFiles watch_files(const RunOptions& options, engine::ControlLoop& loop, hal::Hardware& hardware,
                      const sim::WorldDescription& world, const behaviors::PhysicsWorld& physics,
                      const lab::RunSpec& spec);

}  // namespace footfall::apps
