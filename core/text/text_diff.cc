// Line differences of texts; see file_change.h. Edit graph and shortest path after Myers, "An O(ND)
// difference algorithm and its variations", Algorithmica 1 (1986).
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "core/text/file_change.h"

namespace footfall::core {
namespace {

using Lines = std::vector<std::string_view>;  // each includes its line end, if any

struct Step {
  char kind = ' ';  // ' ' in both, '-' only before, '+' only after
  std::string_view line;
};

Lines lines_of(std::string_view text) {
  Lines lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size() - 1) + 1;
    lines.push_back(text.substr(0, end));
    text.remove_prefix(end);
  }
  return lines;
}

// With more differing lines than this, everything between the first and the last difference is one
// replacement: memory grows with the square of this number.
constexpr int kMostSteps = 2000;

// The furthest x on each diagonal after d steps, for d = 0, 1, ... until the end is reached; empty
// if kMostSteps is exceeded.
std::vector<std::vector<int>> search(const Lines& a, const Lines& b) {
  const int n = static_cast<int>(a.size()), m = static_cast<int>(b.size());
  std::vector<std::vector<int>> rounds;
  for (int d = 0; d <= std::min(n + m, kMostSteps); ++d) {
    std::vector<int> reach(static_cast<std::size_t>(2 * d + 1), 0);
    const auto before = [&](int k) {
      const int index = k + d - 1;
      return rounds.back()[static_cast<std::size_t>(index)];
    };
    for (int k = -d; k <= d; k += 2) {
      int x = 0;
      if (d > 0) {
        const bool down = k == -d || (k != d && before(k - 1) < before(k + 1));
        x = down ? before(k + 1) : before(k - 1) + 1;
      }
      while (x < n && x - k < m && x - k >= 0 &&
             a[static_cast<std::size_t>(x)] == b[static_cast<std::size_t>(x - k)]) {
        ++x;
      }
      reach[static_cast<std::size_t>(k + d)] = x;
      if (x >= n && x - k >= m) {
        rounds.push_back(std::move(reach));
        return rounds;
      }
    }
    rounds.push_back(std::move(reach));
  }
  return {};
}

void back_track(const Lines& a, const Lines& b, const std::vector<std::vector<int>>& rounds,
                std::vector<Step>& steps) {
  int x = static_cast<int>(a.size()), y = static_cast<int>(b.size());
  for (int d = static_cast<int>(rounds.size()) - 1; d >= 0; --d) {
    const int k = x - y;
    int from_x = 0, from_y = 0;
    bool down = false;
    if (d > 0) {
      const auto before = [&](int diagonal) {
        return rounds[static_cast<std::size_t>(d - 1)][static_cast<std::size_t>(diagonal + d - 1)];
      };
      down = k == -d || (k != d && before(k - 1) < before(k + 1));
      from_x = before(down ? k + 1 : k - 1);
      from_y = from_x - (down ? k + 1 : k - 1);
    }
    const int meet_x = d == 0 ? 0 : from_x + (down ? 0 : 1);
    for (; x > meet_x; --x, --y) steps.push_back({' ', a[static_cast<std::size_t>(x - 1)]});
    if (d == 0) break;
    if (down) {
      steps.push_back({'+', b[static_cast<std::size_t>(y - 1)]});
    } else {
      steps.push_back({'-', a[static_cast<std::size_t>(x - 1)]});
    }
    x = from_x;
    y = from_y;
  }
  std::reverse(steps.begin(), steps.end());
}

// In a group of changes, removed lines precede added ones.
void group_changes(std::vector<Step>& steps) {
  for (auto begin = steps.begin(); begin != steps.end();) {
    const auto changed = [](const Step& step) { return step.kind != ' '; };
    begin = std::find_if(begin, steps.end(), changed);
    const auto end = std::find_if_not(begin, steps.end(), changed);
    std::stable_partition(begin, end, [](const Step& step) { return step.kind == '-'; });
    begin = end;
  }
}

std::vector<Step> steps_between(const Lines& a, const Lines& b) {
  std::vector<Step> steps;
  const auto rounds = search(a, b);
  if (rounds.empty() && !(a.empty() && b.empty())) {
    for (const std::string_view line : a) steps.push_back({'-', line});
    for (const std::string_view line : b) steps.push_back({'+', line});
    return steps;
  }
  back_track(a, b, rounds, steps);
  group_changes(steps);
  return steps;
}

// `3,7`; a range of one line is only its number, an empty range refers to the line before it.
std::string range_text(std::size_t first, std::size_t count) {
  if (count == 1) return std::to_string(first + 1);
  return fmt::format("{},{}", count == 0 ? first : first + 1, count);
}

}  // namespace

std::string unified_diff(const std::string& path, std::string_view before, std::string_view after,
                         bool is_new) {
  if (before == after && !is_new) return {};
  constexpr std::size_t kContext = 3;
  const std::vector<Step> steps = steps_between(lines_of(before), lines_of(after));
  std::string out = fmt::format("--- {}\n+++ {}\n", is_new ? "/dev/null" : path, path);
  std::size_t old_line = 0, new_line = 0, at = 0;
  while (at < steps.size()) {
    if (steps[at].kind == ' ') {
      ++old_line, ++new_line, ++at;
      continue;
    }
    // Up to the first change followed by more than twice the context without a change.
    const std::size_t lead = std::min({kContext, at, old_line});
    std::size_t last = at;
    for (std::size_t k = at; k < steps.size() && k <= last + 2 * kContext + 1; ++k) {
      if (steps[k].kind != ' ') last = k;
    }
    const std::size_t begin = at - lead, end = std::min(last + kContext + 1, steps.size());
    std::string body;
    std::size_t old_count = 0, new_count = 0;
    for (std::size_t k = begin; k < end; ++k) {
      body += steps[k].kind;
      body += steps[k].line;
      if (!steps[k].line.ends_with('\n')) body += "\n\\ No newline at end of file\n";
      if (steps[k].kind != '+') ++old_count;
      if (steps[k].kind != '-') ++new_count;
    }
    out += fmt::format("@@ -{} +{} @@\n", range_text(old_line - lead, old_count),
                       range_text(new_line - lead, new_count));
    out += body;
    old_line += old_count - lead;
    new_line += new_count - lead;
    at = end;
  }
  return out;
}

}  // namespace footfall::core
