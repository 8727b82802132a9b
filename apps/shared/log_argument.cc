// Log arguments on the command line; see log_argument.h.
#include "apps/shared/log_argument.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "lab/run/reload_candidate.h"
#include "lab/run/run_folder.h"

namespace footfall::apps {

std::string log_path(const std::string& argument) {
  std::error_code ignored;
  return std::filesystem::is_directory(argument, ignored) ? lab::newest_run(argument) + "/log.mcap"
                                                          : argument;
}

std::vector<std::string> run_logs(const std::string& argument) {
  std::vector<std::string> logs = {log_path(argument)};
  if (logs.front() == argument) return logs;
  const std::string folder = std::filesystem::path(logs.front()).parent_path().string();
  for (int k = 1; std::filesystem::exists(lab::reload_log(folder, k)); ++k) {
    logs.push_back(lab::reload_log(folder, k));
  }
  return logs;
}

lab::Log read_whole_log(const std::string& argument) {
  lab::Log log = lab::read_log(log_path(argument), {.all_rows = true, .inputs = true});
  if (!log.complete) {
    const std::int64_t ticks = log.inputs.first_tick + log.inputs.ticks();
    std::fprintf(stderr, "warning: the log '%s' was cut off; it has %lld ticks\n", log.path.c_str(),
                 static_cast<long long>(ticks));
  }
  if (log.inputs.after_gap > 0) {
    std::fprintf(stderr,
                 "warning: the log '%s' has a gap at tick %lld: the machine was too slow to write "
                 "it; the %lld ticks after it cannot be repeated\n",
                 log.path.c_str(),
                 static_cast<long long>(log.inputs.first_tick + log.inputs.ticks()),
                 static_cast<long long>(log.inputs.after_gap));
  }
  return log;
}

void require_part_of(const std::vector<lab::Log>& logs, const TimeSpan& span) {
  double first = 0.0, last = 0.0;
  for (const lab::Log& log : logs) {
    if (log.rows() > 0) last = std::max(last, log.time.back());
    if (!log.events.empty()) last = std::max(last, log.events.back().time);
  }
  if (!logs.empty() && logs.front().rows() > 0) first = logs.front().time.front();
  if (span.from <= last && span.to >= first) return;
  throw std::runtime_error(
      fmt::format("--from, --to: error: the run is from {:.3f} s to {:.3f} s", first, last));
}

}  // namespace footfall::apps
