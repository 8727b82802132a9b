// Guesses quantities; see quantity_hint.h.
#include "core/diagnostics/quantity_hint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>
#include <vector>

#include "core/diagnostics/did_you_mean.h"
#include "core/text/look_alike.h"
#include "core/units/unit_list.h"

namespace footfall::core {
namespace {

using Replacement = std::pair<std::string_view, std::string_view>;

// Signs that others write, as our units have them.
constexpr auto kSigns = std::to_array<Replacement>({{"\u00b0", " deg"},
                                                    {"\u00ba", " deg"},
                                                    {"\u00b7", " "},
                                                    {"\u22c5", " "},
                                                    {"\u207b\u00b9", "^-1"},
                                                    {"\u207b\u00b2", "^-2"},
                                                    {"\u00b9", "^1"},
                                                    {"\u00b2", "^2"},
                                                    {"\u00b3", "^3"},
                                                    {"**", "^"},
                                                    {"N.m", "Nm"},
                                                    {"\u2030", " mm/m"}});

// Words for units, in small letters.
constexpr auto kWords = std::to_array<Replacement>(
    {{"sec", "s"},       {"secs", "s"},       {"second", "s"},    {"seconds", "s"},
     {"msec", "ms"},     {"msecs", "ms"},     {"usec", "us"},     {"minute", "min"},
     {"minutes", "min"}, {"mins", "min"},     {"hour", "h"},      {"hours", "h"},
     {"hr", "h"},        {"meter", "m"},      {"meters", "m"},    {"metre", "m"},
     {"metres", "m"},    {"mtr", "m"},        {"newton", "N"},    {"newtons", "N"},
     {"kilogram", "kg"}, {"kilograms", "kg"}, {"kgs", "kg"},      {"gram", "g"},
     {"grams", "g"},     {"degree", "deg"},   {"degrees", "deg"}, {"degs", "deg"},
     {"grad", "deg"},    {"radian", "rad"},   {"radians", "rad"}, {"rads", "rad"},
     {"percent", "%"},   {"pct", "%"},        {"hertz", "Hz"},    {"joule", "J"},
     {"watt", "W"},      {"joules", "J"},     {"watts", "W"}});

// Words before those.
constexpr auto kPrefixes = std::to_array<Replacement>(
    {{"kilo", "k"}, {"centi", "c"}, {"milli", "m"}, {"micro", "u"}, {"mega", "M"}});

bool is_word(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '%' ||
         static_cast<unsigned char>(c) >= 0x80;
}

std::string with_our_signs(std::string text) {
  for (const auto& [theirs, ours] : kSigns) {
    for (std::size_t at = text.find(theirs); at != std::string::npos;
         at = text.find(theirs, at + ours.size())) {
      const bool doubled = ours.front() == ' ' && at > 0 && text[at - 1] == ' ';
      text.replace(at, theirs.size(), ours.substr(doubled ? 1 : 0));
    }
  }
  return text;
}

// `centimeters`: cm; empty if it is no word for a unit.
std::string unit_of_word(std::string_view word, bool prefixed = true) {
  for (const auto& [theirs, ours] : kWords) {
    if (word == theirs) return std::string(ours);
  }
  for (const auto& [theirs, ours] : kPrefixes) {
    if (!prefixed || !word.starts_with(theirs)) continue;
    const std::string unit = unit_of_word(word.substr(theirs.size()), false);
    if (!unit.empty() && parse_unit(std::string(ours) + unit)) return std::string(ours) + unit;
  }
  return {};
}

// The unit nearest to a word, the word itself if it is one, empty if none is near.
std::string near_unit(const std::string& word) {
  if (parse_unit(word)) return word;
  std::string small = word;
  std::transform(small.begin(), small.end(), small.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (const std::string unit = unit_of_word(small); !unit.empty()) return unit;
  std::vector<std::string> names;
  for (const UnitInfo& unit : all_units()) names.emplace_back(unit.name);
  // Powers of ten apart in small letters only (`Mm`): the more usual one.
  if (parse_unit(small)) return small;
  return nearest_name(word, names);
}

// Replaces every word behind the number by the nearest unit; empty if one has none.
std::string with_our_units(const std::string& text) {
  std::size_t at = text.find_first_not_of("+-.0123456789");
  // The exponent of a number: `1e3`.
  if (at != std::string::npos && (text[at] == 'e' || text[at] == 'E') && at + 1 < text.size() &&
      (is_digit(text[at + 1]) || text[at + 1] == '-')) {
    at = text.find_first_not_of("+-0123456789", at + 1);
  }
  if (at == std::string::npos || at == 0) return {};
  std::string out = text.substr(0, at);
  if (text[at] != ' ') out += ' ';
  if (text[at] == '/') out += '1';
  while (at < text.size()) {
    if (!is_word(text[at])) {
      out += text[at++];
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && is_word(text[end])) ++end;
    const std::string unit = near_unit(text.substr(at, end - at));
    if (unit.empty()) return {};
    out += unit;
    at = end;
  }
  return out;
}

}  // namespace

bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos || comma == 0 || comma + 1 >= text.size()) return false;
  const std::size_t sign = text.front() == '-' || text.front() == '+' ? 1 : 0;
  const std::string_view whole = text.substr(sign, comma - sign);
  return !whole.empty() && std::all_of(whole.begin(), whole.end(), is_digit) &&
         is_digit(text[comma + 1]) && text.find(',', comma + 1) == std::string_view::npos;
}

std::string quantity_hint(std::string_view text, std::optional<Dimension> expected) {
  constexpr std::size_t kLongest = 40;  // longer texts are no quantities
  if (text.size() > kLongest) return {};
  const auto fits = [&](const std::string& guess) {
    const auto quantity = parse_quantity(guess);
    return quantity && (!expected || quantity->bare || quantity->dimension == *expected);
  };
  std::string guess = without_look_alikes(with_our_signs(std::string(text)));
  const bool comma = has_decimal_comma(guess);
  if (comma) guess[guess.find(',')] = '.';
  if (!parse_quantity(guess)) guess = with_our_units(guess);
  if (comma) {
    return fits(guess) ? fmt::format(": a decimal point, not a comma: '{}'", guess)
                       : ": a decimal point, not a comma";
  }
  if (guess.empty() || guess == text || !fits(guess)) return {};
  return fmt::format(" (did you mean '{}'?)", guess);
}

std::string split_argument_hint(const std::vector<std::string>& arguments, std::size_t index,
                                bool& rest) {
  const auto is_setting = [&](std::size_t k) {
    const std::size_t equals = arguments[k].find('=');
    return equals != std::string::npos && equals > 0;
  };
  const auto begins = [&](std::size_t k) {  // `NAME = VALUE`
    return k + 1 < arguments.size() && arguments[k + 1].starts_with('=');
  };
  rest = false;
  std::size_t first = index;
  while (first > 0 && !is_setting(first) && !begins(first)) --first;
  if (!is_setting(first) && !begins(first)) return {};
  std::string whole = arguments[first];
  for (std::size_t k = first + 1; k < arguments.size() && !is_setting(k); ++k) {
    const bool tight = begins(first) && k <= first + 2;
    whole += (tight ? "" : " ") + arguments[k];
  }
  // Only what goes on belongs to it: a number its unit, a list its items, an expression.
  const std::string value = whole.substr(whole.find('=') + 1);
  const bool list = !value.empty() && (value.front() == '[' || value.front() == '{');
  const bool open = list && value.find_first_of("]}") + 1 == value.size();
  if (!open && !value.starts_with('=') && !parse_quantity(value) && quantity_hint(value).empty()) {
    return {};
  }
  rest = index > (begins(first) ? first : first + 1);
  return fmt::format("quote it: \"{}\"", whole);
}

}  // namespace footfall::core
