// Cuts a log in time; see log_window.h.
#include "lab/log_window.h"

#include <algorithm>

namespace footfall::lab {

Log log_window(const Log& log, double from, double to) {
  Log out = log;
  const auto begin = std::ranges::lower_bound(log.time, from) - log.time.begin();
  const auto end = std::max(std::ranges::upper_bound(log.time, to) - log.time.begin(), begin);
  const auto cut = [&](auto& values) {
    values.erase(values.begin() + end, values.end());
    values.erase(values.begin(), values.begin() + begin);
  };
  cut(out.time);
  for (std::vector<float>& column : out.column) cut(column);
  std::erase_if(out.events, [&](const LoggedEvent& e) { return e.time < from || e.time > to; });
  return out;
}

}  // namespace footfall::lab
