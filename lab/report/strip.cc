// Which moments a film strip shows; see strip.h.
#include "lab/report/strip.h"

#include <fmt/format.h>

#include <algorithm>

namespace footfall::lab {
namespace {

constexpr float kSteps = 4.0F;      // shown of a run in which nothing happened
constexpr double kBefore = 0.1;     // s, shown before a push
constexpr double kAfter = 1.3;      // s, and after it: three or four steps
constexpr double kBeforeEnd = 1.4;  // s, shown before a fall

struct Span {
  double begin = 0.0, end = 0.0;  // s
  std::string what;
};

// Adds `count` equal times from begin to end, both included.
void add_times(std::vector<double>& times, const Span& span, int count) {
  for (int i = 0; i < count; ++i) {
    times.push_back(span.begin + (span.end - span.begin) * i / (count - 1));
  }
}

Span last_steps(const Log& log) {
  Span span{log.time.front(), log.time.back(), "the run"};
  const auto* steps = log.values("steps");
  if (steps == nullptr || steps->back() < kSteps) return span;
  std::size_t row = log.rows() - 1;
  while (row > 0 && (*steps)[row - 1] > steps->back() - kSteps - 0.5F) --row;
  return {log.time[row], span.end, "the last steps"};
}

Span what_matters(const Log& log) {
  const double first = log.time.front(), last = log.time.back();
  const LoggedEvent* push = nullptr;
  for (const LoggedEvent& event : log.events) {
    if (event.kind == "end" && (event.name == "fall" || event.name == "fault")) {
      return {std::max(first, last - kBeforeEnd), last, "the end"};
    }
    if (event.kind == "push") push = &event;
  }
  if (push == nullptr) return last_steps(log);
  return {std::max(first, push->time - kBefore), std::min(last, push->time + kAfter),
          fmt::format("the push at {:.3f} s", push->time)};
}

}  // namespace

StripMoments strip_moments(const Log& log) {
  StripMoments strip;
  if (log.rows() == 0) return strip;
  const Span whole{log.time.front(), log.time.back(), ""};
  if (log.part) {
    add_times(strip.times, whole, 2 * kStripColumns);
    strip.caption = "This part of the run at equal times";
    return strip;
  }
  const Span detail = what_matters(log);
  if (detail.begin <= whole.begin && detail.end >= whole.end) {
    add_times(strip.times, whole, 2 * kStripColumns);
    strip.caption = "The run at equal times";
    return strip;
  }
  add_times(strip.times, whole, kStripColumns);
  add_times(strip.times, detail, kStripColumns);
  strip.caption = "Above: the run at equal times; below: " + detail.what;
  return strip;
}

std::string state_caption(const std::string& path) {
  const std::size_t first = path.find('.');
  const bool deep = first != std::string::npos && path.find('.', first + 1) != std::string::npos;
  std::string name = deep ? path.substr(first + 1) : path;
  std::ranges::replace(name, '.', ' ');
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace footfall::lab
