// The time of day, for people who look up when something was done.
#pragma once

#include <chrono>
#include <ctime>
#include <string>

namespace footfall::lab {

// UTC, `2026-01-31T12:34:56`, as JUnit files have it.
inline std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%S", &parts);
  return text;
}

}  // namespace footfall::lab
