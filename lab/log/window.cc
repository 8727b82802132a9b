// Time window of a log; see window.h.
#include "lab/log/window.h"

#include <algorithm>

namespace footfall::lab {

Log log_window(const Log& log, double from, double to) {
  Log out = log;
  out.part = true;
  const auto begin = std::ranges::lower_bound(log.time, from) - log.time.begin();
  const auto end = std::max(std::ranges::upper_bound(log.time, to) - log.time.begin(), begin);
  const auto cut = [&](auto& values) {
    values.erase(values.begin() + end, values.end());
    values.erase(values.begin(), values.begin() + begin);
  };
  cut(out.time);
  if (out.tick.size() == log.time.size()) cut(out.tick);
  for (std::vector<float>& column : out.column) cut(column);
  std::erase_if(out.events, [&](const LoggedEvent& e) { return e.time < from || e.time > to; });
  return out;
}

void keep_even_rows(Log& log) {
  std::size_t kept = 0;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (log.tick[row] % log.row_every != 0) continue;
    for (std::vector<float>& column : log.column) column[kept] = column[row];
    log.time[kept] = log.time[row];
    log.tick[kept++] = log.tick[row];
  }
  for (std::vector<float>& column : log.column) column.resize(kept);
  log.time.resize(kept);
  log.tick.resize(kept);
}

}  // namespace footfall::lab
