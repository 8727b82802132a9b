// Validators of option values; see option_value.h.
#include "apps/shared/option_value.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "core/diagnostics/did_you_mean.h"

namespace footfall::apps {

CLI::Validator at_least(std::int64_t least, const char* what) {
  const auto check = [least, what](std::string& text) -> std::string {
    std::int64_t value = 0;
    const char* const last = text.data() + text.size();
    const auto [end, problem] = std::from_chars(text.data(), last, value);
    if (problem == std::errc::result_out_of_range && text.front() != '-') {
      return fmt::format("expected {}, at most {}, got '{}'", what,
                         std::numeric_limits<std::int64_t>::max(), text);
    }
    const bool good = problem == std::errc() && end == last && value >= least;
    return good ? "" : fmt::format("expected {}, got '{}'", what, text);
  };
  return CLI::Validator(check, "", "");
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string described = fmt::format("{{{}}}", fmt::join(words, ","));
  const auto check = [words = std::move(words)](std::string& text) -> std::string {
    if (std::ranges::find(words, text) != words.end()) return "";
    return fmt::format("expected {}, got '{}'{}", fmt::join(words, ", "), text,
                       core::did_you_mean(text, words));
  };
  return CLI::Validator(check, described, "");
}

}  // namespace footfall::apps
