// Questions about a chart's structure; see chart.h.
#include "behaviors/chart.h"

#include <cmath>

namespace footfall::behaviors {

int Chart::domain_of(const TransitionInfo& transition, const int* first_target, int count) const {
  const auto all_below = [&](int ancestor) {
    for (int k = 0; k < count; ++k) {
      if (!is_descendant(first_target[k], ancestor)) return false;
    }
    return true;
  };
  const int source = transition.source;
  const StateInfo& info = states[static_cast<std::size_t>(source)];
  if (transition.internal && info.kind == StateKind::compound && all_below(source)) return source;
  for (int s = info.parent; s > 0; s = states[static_cast<std::size_t>(s)].parent) {
    if (states[static_cast<std::size_t>(s)].kind == StateKind::compound && all_below(s)) return s;
  }
  return 0;
}

bool Chart::event_matches(std::string_view pattern, std::string_view event) {
  if (pattern == "*") return true;
  if (!pattern.ends_with(".*")) return pattern == event;
  pattern.remove_suffix(2);
  return event.starts_with(pattern) &&
         (event.size() == pattern.size() || event[pattern.size()] == '.');
}

void Chart::match_events() {
  const auto words = (events.size() + 63) / 64;
  event_words = static_cast<int>(words);
  event_match.assign(transitions.size() * words, 0);
  for (const EventPattern& pattern : patterns) {
    const std::size_t row = static_cast<std::size_t>(pattern.transition) * words;
    for (std::size_t e = 0; e < events.size(); ++e) {
      if (!event_matches(pattern.text, events[e])) continue;
      event_match[row + e / 64] |= std::uint64_t{1} << (e % 64);
    }
  }
}

std::int64_t periods_of(double seconds, std::int64_t rate_mhz) noexcept {
  if (!(seconds >= 0.0) || seconds > 1e6) return -1;
  const std::int64_t ns = std::llround(seconds * 1e9);  // at most 10^15
  // ns * rate_mhz / 10^12, rounded up, split so that no product overflows 64 bits.
  constexpr std::int64_t kBillion = 1'000'000'000;
  const std::int64_t whole = ns / kBillion * rate_mhz;  // in thousandths of a period
  const std::int64_t part = ns % kBillion * rate_mhz;   // in 10^-12 periods
  const std::int64_t thousandths = whole + part / kBillion;
  const bool rest = part % kBillion != 0 || thousandths % 1000 != 0;
  return thousandths / 1000 + (rest ? 1 : 0);
}

}  // namespace footfall::behaviors
