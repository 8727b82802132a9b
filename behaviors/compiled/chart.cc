// Queries of a chart's structure; see chart.h.
#include "behaviors/compiled/chart.h"

#include <algorithm>
#include <cmath>
#include <numeric>

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

namespace {

// Alphabetical with the dot first: an event is followed by all events below it.
bool goes_before(std::string_view a, std::string_view b) {
  const auto weight = [](char c) { return c == '.' ? 0 : 1 + static_cast<unsigned char>(c); };
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(),
                                      [&weight](char x, char y) { return weight(x) < weight(y); });
}

// The range of sorted events that match a pattern.
Range stretch_of(std::string_view pattern, const std::vector<std::string_view>& sorted) {
  if (pattern == "*") return {0, static_cast<int>(sorted.size())};
  const std::string_view stem =
      pattern.ends_with(".*") ? pattern.substr(0, pattern.size() - 2) : pattern;
  const auto first = std::lower_bound(sorted.begin(), sorted.end(), stem, goes_before);
  const auto end = std::partition_point(first, sorted.end(), [&](std::string_view event) {
    return Chart::event_matches(pattern, event);
  });
  return {static_cast<int>(first - sorted.begin()), static_cast<int>(end - first)};
}

}  // namespace

void Chart::match_events() {
  std::vector<int> order(events.size());
  std::iota(order.begin(), order.end(), 0);
  const auto name = [this](int e) -> std::string_view {
    return events[static_cast<std::size_t>(e)];
  };
  std::sort(order.begin(), order.end(),
            [&name](int a, int b) { return goes_before(name(a), name(b)); });
  std::vector<std::string_view> sorted;
  event_ranks.resize(events.size());
  for (const int e : order) {
    event_ranks[static_cast<std::size_t>(e)] = static_cast<int>(sorted.size());
    sorted.push_back(name(e));
  }
  heard_events.assign(transitions.size(), {});
  heard_ranks.clear();
  for (const EventPattern& pattern : patterns) {  // those of one transition are contiguous
    Range& own = heard_events[static_cast<std::size_t>(pattern.transition)];
    if (own.count++ == 0) own.first = static_cast<int>(heard_ranks.size());
    heard_ranks.push_back(stretch_of(pattern.text, sorted));
  }
}

bool active_together(const Chart& chart, int a, int b) {
  if (a == b || chart.is_descendant(a, b) || chart.is_descendant(b, a)) return false;
  int common = a;
  while (!chart.is_descendant(b, common))
    common = chart.states[static_cast<std::size_t>(common)].parent;
  return chart.states[static_cast<std::size_t>(common)].kind == StateKind::parallel;
}

std::int64_t periods_of(double seconds, std::int64_t rate_mhz) noexcept {
  if (!(seconds >= 0.0) || seconds > kLongestTime) return -1;
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
