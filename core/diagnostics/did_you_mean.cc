#include "core/diagnostics/did_you_mean.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>
#include <utility>

#include "core/text/look_alike.h"

namespace footfall::core {
namespace {

// Edit distance; swapping two neighbouring letters counts as one edit (optimal string alignment).
int edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<int> before_last(columns), last(columns), row(columns);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({replace, last[j] + 1, row[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    std::swap(before_last, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

// Whether two words are equal except for upper and lower case.
bool same_letters(std::string_view a, std::string_view b) {
  const auto small = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [&](char x, char y) { return small(x) == small(y); });
}

}  // namespace

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestWord = 100;  // longer words are not typing mistakes
  if (word.size() > kLongestWord) return {};
  const std::string typed = without_look_alikes(word);
  for (const std::string& candidate : candidates) {
    if (same_letters(typed, candidate)) return candidate;
  }
  const int length = static_cast<int>(word.size());
  // Every one-letter word is within one edit of every other, so a guess would be worthless.
  int best = std::min(std::max(1, length / 3), length - 1);
  std::string nearest;
  for (const std::string& candidate : candidates) {
    if (candidate.size() > kLongestWord) continue;
    if (std::abs(static_cast<int>(candidate.size()) - length) > best) continue;
    const int distance = edit_distance(word, candidate);
    if (distance < best || (distance == best && nearest.empty())) {
      best = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(word, candidates);
  return nearest.empty() ? std::string() : fmt::format(" (did you mean '{}'?)", nearest);
}

std::string did_you_mean_or_list(std::string_view word,
                                 const std::vector<std::string>& candidates) {
  constexpr std::size_t kFew = 10;
  const std::string hint = did_you_mean(word, candidates);
  if (!hint.empty() || candidates.size() > kFew) return hint;
  if (candidates.empty()) return " (there is none)";
  return fmt::format(" (there {} {})", candidates.size() == 1 ? "is" : "are",
                     fmt::join(candidates, ", "));
}

}  // namespace footfall::core
