// Canonical spelling of scalars; see tokens.h.
#include <algorithm>
#include <array>
#include <cctype>

#include "core/units/units.h"
#include "core/yaml_text/tokens.h"

namespace footfall::core {
bool is_plain_word(std::string_view text) {
  static constexpr std::array kReserved = {"true", "false", "on", "off", "yes",
                                           "no",   "null",  "y",  "n"};
  const auto is_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
  };
  if (text.empty() || !std::ranges::all_of(text, is_word)) return false;
  if (std::isdigit(static_cast<unsigned char>(text.front())) != 0 || text.front() == '.')
    return false;
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return std::ranges::find(kReserved, lower) == kReserved.end();
}

std::string spaced_quantity(const std::string& text) {
  std::size_t end = 0;
  if (end < text.size() && (text[end] == '-' || text[end] == '+')) ++end;
  const std::size_t digits = end;
  const auto skip_digits = [&] {
    while (end < text.size() &&
           (std::isdigit(static_cast<unsigned char>(text[end])) != 0 || text[end] == '.')) {
      ++end;
    }
  };
  skip_digits();
  if (end == digits) return text;
  // An exponent needs digits: the `e` of `2eV` is not one.
  std::size_t exponent = end;
  if (exponent < text.size() && (text[exponent] == 'e' || text[exponent] == 'E')) {
    ++exponent;
    if (exponent < text.size() && (text[exponent] == '-' || text[exponent] == '+')) ++exponent;
    if (exponent < text.size() && std::isdigit(static_cast<unsigned char>(text[exponent])) != 0) {
      end = exponent;
      skip_digits();
    }
  }
  std::string unit;
  for (std::size_t i = end; i < text.size(); ++i) {
    if (!is_blank(text[i])) {
      if (!unit.empty() && is_blank(text[i - 1])) unit += ' ';
      unit += text[i];
    }
  }
  if (unit.empty()) return text;
  std::string spaced = text.substr(0, end) + " " + unit;
  const auto before = parse_quantity(text), after = parse_quantity(spaced);
  const bool same = before && after && before->value == after->value &&
                    before->dimension == after->dimension && before->bare == after->bare;
  return same ? spaced : text;
}

std::string canonical_quoted(std::string_view quoted) {
  const std::string_view inside = quoted.substr(1, quoted.size() - 2);
  if (is_plain_word(inside)) return std::string(inside);
  if (quoted.front() == '\'' && inside.find_first_of("'\"\\\n") == std::string_view::npos) {
    return '"' + std::string(inside) + '"';
  }
  return std::string(quoted);
}

}  // namespace footfall::core
