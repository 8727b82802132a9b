// Collects load-time problems and prints them like a compiler; see diagnostics.h.
#include "core/diagnostics/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>
#include <tuple>
#include <utility>

#include "core/text/printable.h"

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

int Diagnostics::add_file(const std::string& path) {
  const auto found = std::find(files_.begin(), files_.end(), path);
  if (found != files_.end()) return static_cast<int>(found - files_.begin());
  files_.push_back(path);
  return static_cast<int>(files_.size()) - 1;
}

bool Diagnostics::is_new(Mark mark, std::string_view id, const std::string& text) {
  if (silent_.contains({mark.file, mark.line, mark.column})) return false;
  return said_.insert(fmt::format("{} {} {} {} {}", mark.file, mark.line, mark.column, id, text))
      .second;
}

void Diagnostics::error(Mark mark, std::string_view id, std::string text) {
  if (!is_new(mark, id, text)) return;
  items_.push_back({Severity::error, mark, std::string(id), std::move(text)});
  ++error_count_;
}

void Diagnostics::warning(Mark mark, std::string_view id, std::string text) {
  if (!is_new(mark, id, text)) return;
  items_.push_back({Severity::warning, mark, std::string(id), std::move(text)});
}

std::vector<Diagnostic> Diagnostics::sorted() const {
  const auto key = [](const Diagnostic& item) {
    return std::tie(item.mark.file, item.mark.line, item.mark.column);
  };
  std::vector<Diagnostic> out = items_;
  std::stable_sort(out.begin(), out.end(),
                   [&](const auto& a, const auto& b) { return key(a) < key(b); });
  // The same problem is reported several times if several aliases refer to its anchor.
  const auto again = std::unique(out.begin(), out.end(), [&](const auto& a, const auto& b) {
    return key(a) == key(b) && a.severity == b.severity && a.text == b.text;
  });
  out.erase(again, out.end());
  return out;
}

std::string Diagnostics::to_string() const {
  std::string out;
  for (const Diagnostic& item : sorted()) {
    if (item.mark.file >= 0 && item.mark.file < static_cast<int>(files_.size())) {
      out += on_one_line(file(item.mark.file)) + ":";
      if (item.mark.line > 0) out += fmt::format("{}:{}:", item.mark.line, item.mark.column);
      out += " ";
    }
    out += item.severity == Severity::error ? "error: " : "warning: ";
    out += on_one_line(item.text) + "\n";
  }
  return out;
}

std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates) {
  constexpr std::size_t kLongestWord = 100;  // longer words are not typing mistakes
  if (word.size() > kLongestWord) return {};
  for (const std::string& candidate : candidates) {
    if (same_letters(word, candidate)) return candidate;
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
