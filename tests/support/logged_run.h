// A run with a log of every tick, read back.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "lab/log/reader.h"
#include "lab/run/run.h"
#include "lab/run/run_log.h"
#include "tests/support/rig.h"

namespace footfall::tests {

inline std::string temporary(const std::string& name) {
  return testing::TempDir() + "footfall_" + std::to_string(getpid()) + "_" + name;
}

struct Logged {
  lab::RunResult result;
  lab::Log log;
};

inline Logged run_logged(Rig& rig, lab::RunSpec& spec, int row_every = 1, bool inputs = false) {
  const std::string path = temporary("run.mcap");
  lab::LogSource source;
  source.row_every = row_every;
  engine::LogWriter writer(path, rig.behavior->signals,
                           lab::make_log_header(*rig.behavior, source));
  spec.log = &writer;
  Logged logged{lab::run(*rig.loop, spec), {}};
  writer.close();
  logged.log = lab::read_log(path, {.all_rows = true, .inputs = inputs});
  std::filesystem::remove(path);
  return logged;
}

inline std::vector<double> times_of(const lab::Log& log, const std::string& kind) {
  std::vector<double> times;
  for (const lab::LoggedEvent& event : log.events) {
    if (event.kind == kind) times.push_back(event.time);
  }
  return times;
}

inline std::size_t row_at(const lab::Log& log, double time) {
  std::size_t row = 0;
  while (row + 1 < log.rows() && log.time[row] < time - 1e-6) ++row;
  return row;
}

}  // namespace footfall::tests
