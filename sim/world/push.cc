// Pushes and pairs of numbers from the command line; see push.h.
#include "sim/world/push.h"

#include <fmt/format.h>

#include <charconv>
#include <numbers>
#include <vector>

namespace footfall::sim {

namespace {

constexpr std::string_view kBlanks = " \t";

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

std::vector<std::string_view> split_at_commas(std::string_view text) {
  std::vector<std::string_view> fields;
  while (true) {
    const std::size_t comma = text.find(',');
    fields.push_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    text.remove_prefix(comma + 1);
  }
}

// Removes `word` and the blanks after it from the beginning of `text`.
bool take_word(std::string_view& text, std::string_view word) {
  if (!text.starts_with(word) || text.size() == word.size() ||
      kBlanks.find(text[word.size()]) == std::string_view::npos) {
    return false;
  }
  text = trimmed(text.substr(word.size()));
  return true;
}

std::optional<double> quantity(std::string_view text, core::Dimension dimension) {
  const std::optional<core::Quantity> parsed = core::parse_quantity(text);
  if (!parsed || (!parsed->bare && parsed->dimension != dimension)) return std::nullopt;
  return parsed->value;
}

// `step N` or `step N phase P`, without the leading word `step`.
std::optional<AtStep> parse_step(std::string_view text) {
  AtStep at;
  const char* const end = text.data() + text.size();
  const auto [stop, problem] = std::from_chars(text.data(), end, at.step);
  if (problem != std::errc() || at.step < 1) return std::nullopt;
  std::string_view rest(stop, static_cast<std::size_t>(end - stop));
  if (rest.empty()) return at;
  if (kBlanks.find(rest.front()) == std::string_view::npos) return std::nullopt;
  rest = trimmed(rest);
  if (!take_word(rest, "phase")) return std::nullopt;
  const std::optional<double> phase = quantity(rest, core::kNone);
  if (!phase || *phase < 0.0 || *phase >= 1.0) return std::nullopt;
  at.phase = *phase;
  return at;
}

std::optional<std::variant<AtTime, AtStep>> parse_at(std::string_view text) {
  if (take_word(text, "step")) {
    const std::optional<AtStep> at = parse_step(text);
    if (!at) return std::nullopt;
    return *at;
  }
  const std::optional<double> seconds = quantity(text, core::kTime);
  if (!seconds || *seconds < 0.0) return std::nullopt;
  return AtTime{*seconds};
}

}  // namespace

std::optional<PushSpec> parse_push(std::string_view text, std::string& error,
                                   std::string_view body) {
  const std::vector<std::string_view> fields = split_at_commas(text);
  const auto refuse = [&](std::string_view what, std::string_view got) {
    error = fmt::format("expected {}, got '{}' (FORCE_N,DURATION_S,DIRECTION_DEG,AT)", what, got);
    return std::nullopt;
  };
  if (fields.size() != 4) return refuse("four values with commas between", text);

  const std::optional<double> force = quantity(fields[0], core::kForce);
  if (!force || *force < 0.0) return refuse("a force in N, not below zero", fields[0]);
  const std::optional<double> duration = quantity(fields[1], core::kTime);
  if (!duration || *duration <= 0.0) return refuse("a duration in s, above zero", fields[1]);
  const std::optional<core::Quantity> direction = core::parse_quantity(fields[2]);
  if (!direction || direction->dimension != core::kNone) {
    return refuse("a direction in degrees", fields[2]);
  }
  const auto at = parse_at(fields[3]);
  if (!at) return refuse("a time in s, 'step N' or 'step N phase P' (0 <= P < 1)", fields[3]);

  constexpr double kDegree = std::numbers::pi / 180.0;
  const double radians = direction->value * (direction->bare ? kDegree : 1.0);
  return PushSpec{*force, *duration, radians, *at, std::string(body)};
}

std::optional<std::array<double, 2>> parse_vector2(std::string_view text, core::Dimension dimension,
                                                   std::string& error) {
  const std::vector<std::string_view> fields = split_at_commas(text);
  if (fields.size() == 2) {
    const std::optional<double> x = quantity(fields[0], dimension);
    const std::optional<double> y = quantity(fields[1], dimension);
    if (x && y) return std::array<double, 2>{*x, *y};
  }
  error = fmt::format("expected 'x,y', each {}, got '{}'", core::dimension_name(dimension), text);
  return std::nullopt;
}

}  // namespace footfall::sim
