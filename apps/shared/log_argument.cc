// Log arguments on the command line; see log_argument.h.
#include "apps/shared/log_argument.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "apps/shared/commands.h"

namespace footfall::apps {

std::string log_path(const std::string& argument) {
  const std::filesystem::path path(argument);
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored) ? (path / "log.mcap").string() : argument;
}

lab::Log read_whole_log(const std::string& argument) {
  lab::Log log = lab::read_log(log_path(argument), {.all_rows = true, .inputs = true});
  if (!log.complete) {
    const std::int64_t ticks = log.inputs.first_tick + log.inputs.ticks();
    std::fprintf(stderr, "warning: the log '%s' was cut off; it has %lld ticks\n", log.path.c_str(),
                 static_cast<long long>(ticks));
  }
  return log;
}

int guarded(const std::function<int()>& work) {
  try {
    return work();
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    const bool placed = text.find("error: ") != std::string::npos;  // names a file and a position
    std::fprintf(stderr, "%s%s%s", placed ? "" : "error: ", text.c_str(),
                 text.ends_with('\n') ? "" : "\n");
    return kBadInput;
  }
}

}  // namespace footfall::apps
