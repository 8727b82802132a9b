// Suggestions for a word that is not among those allowed.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

// The candidate nearest to `word` (edit distance at most max(1, length / 3)), or empty.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);
// " (did you mean 'x'?)" or "".
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);
// did_you_mean(); if no candidate is near and there are few, all of them: " (there are a, b)".
std::string did_you_mean_or_list(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace footfall::core
