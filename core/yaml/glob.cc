// Name patterns; see glob.h.
#include "core/yaml/glob.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/value_reader.h"

namespace footfall::core {

namespace {

int index_of(std::string_view name, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

void report_no_match(Mark mark, std::string_view pattern, const std::vector<std::string>& names,
                     std::string_view what, Diagnostics& diagnostics) {
  if (is_glob(pattern)) {
    diagnostics.error(
        mark, "glob-unmatched",
        fmt::format("'{}' matches no {}: there are {}", pattern, what, fmt::join(names, ", ")));
    return;
  }
  std::string hint = did_you_mean(pattern, names);
  if (hint.empty()) hint = fmt::format(": there are {}", fmt::join(names, ", "));
  const bool is_axis = what == "axis";
  diagnostics.error(mark, is_axis ? "unknown-axis" : "unknown-name",
                    fmt::format("no {} '{}'{}", what, pattern, hint));
}

}  // namespace

bool is_glob(std::string_view text) { return text.find_first_of("*?") != std::string_view::npos; }

bool glob_matches(std::string_view pattern, std::string_view text) {
  std::size_t p = 0;
  std::size_t t = 0;
  std::size_t star = std::string_view::npos;  // the last star; the text matched by it ends at `end`
  std::size_t end = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      end = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != std::string_view::npos) {
      p = star + 1;
      t = ++end;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

std::vector<const YamlEntry*> match_names(const YamlNode& map,
                                          const std::vector<std::string>& names,
                                          std::string_view what, Diagnostics& diagnostics) {
  std::vector<const YamlEntry*> matched(names.size(), nullptr);
  if (!expect_map(map, fmt::format("a map by {}", what), diagnostics)) return matched;
  if (map.entries.empty()) {
    diagnostics.error(map.mark, "empty-value",
                      fmt::format("an empty map says nothing about any {}: leave it out", what));
  }
  for (const YamlEntry& entry : map.entries) {
    if (is_glob(entry.key)) continue;
    const int index = index_of(entry.key, names);
    if (index < 0) {
      report_no_match(entry.key_mark, entry.key, names, what, diagnostics);
    } else {
      matched[static_cast<std::size_t>(index)] = &entry;
    }
  }
  for (const YamlEntry& entry : map.entries) {
    if (!is_glob(entry.key)) continue;
    bool any = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!glob_matches(entry.key, names[i])) continue;
      any = true;
      if (matched[i] == nullptr) {
        matched[i] = &entry;
      } else if (is_glob(matched[i]->key)) {
        diagnostics.error(entry.key_mark, "glob-clash",
                          fmt::format("'{}' and '{}' (line {}) both match {} '{}'", entry.key,
                                      matched[i]->key, matched[i]->key_mark.line, what, names[i]));
      }
    }
    if (!any) report_no_match(entry.key_mark, entry.key, names, what, diagnostics);
  }
  return matched;
}

std::vector<int> expand_names(const YamlNode& list, const std::vector<std::string>& names,
                              std::string_view what, Diagnostics& diagnostics) {
  std::vector<int> indices;
  if (!expect_sequence(list, fmt::format("a list of {} names", what), diagnostics)) return indices;
  for (const YamlNode& item : list.items) {
    const auto pattern = read_text(item, diagnostics, fmt::format("a {} name", what));
    if (!pattern) continue;
    bool any = false;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!glob_matches(*pattern, names[i])) continue;
      any = true;
      const int index = static_cast<int>(i);
      if (std::find(indices.begin(), indices.end(), index) == indices.end()) {
        indices.push_back(index);
      } else if (!is_glob(*pattern)) {
        diagnostics.error(item.mark, "duplicate", fmt::format("{} '{}' twice", what, *pattern));
      }
    }
    if (!any) report_no_match(item.mark, *pattern, names, what, diagnostics);
  }
  return indices;
}

}  // namespace footfall::core
