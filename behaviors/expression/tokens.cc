// Tokenizer. Numbers take the longest unit that follows them: `6 cm`, `0.25 m/s`, `220 1/s^2`.
#include "behaviors/expression/tokens.h"

#include <fmt/format.h>

#include <cctype>
#include <charconv>
#include <cmath>

#include "core/text/look_alike.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMaxTokens = 4 * kMaxSteps;

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n'; }
bool is_unit_byte(char c) {
  return is_letter(c) || is_digit(c) || c == ' ' || c == '*' || c == '/' || c == '^' || c == '%' ||
         c == '-' || static_cast<unsigned char>(c) >= 0x80;
}

// Length in bytes of the longest unit at the start of `rest`, 0 if none; never splits a word.
std::size_t unit_length(std::string_view rest) {
  if (rest.empty()) return 0;
  const char first = rest.front();
  if (!is_letter(first) && first != '%' && first != '1' &&
      static_cast<unsigned char>(first) < 0x80) {
    return 0;
  }
  std::size_t run = 0;
  while (run < rest.size() && run < 40 && is_unit_byte(rest[run])) ++run;
  for (std::size_t n = run; n > 0; --n) {
    const char last = rest[n - 1];
    if (last == ' ' || last == '*' || last == '/' || last == '^' || last == '-') continue;
    if (n < rest.size() && (is_letter(rest[n]) || is_digit(rest[n]) || rest[n] == '.')) continue;
    if (n < rest.size() && rest[n] == '(' && is_letter(last)) continue;  // name of a function
    if (n == 1 && first == '1') continue;
    if (core::parse_unit(rest.substr(0, n))) return n;
  }
  return 0;
}

// Reads a number with its unit at `at`; moves `at` past it.
bool read_number(std::string_view text, std::size_t& at, Token& token, ExpressionError& error) {
  const char* begin = text.data() + at;
  double value = 0.0;
  const auto result = std::from_chars(begin, text.data() + text.size(), value);
  token.kind = Token::Kind::number;
  if (result.ec != std::errc() || !std::isfinite(value)) {
    error = {static_cast<int>(at), "bad-number", "number out of range"};
    return false;
  }
  const auto digits = static_cast<std::size_t>(result.ptr - begin);
  const std::string_view number = text.substr(at, digits);
  at += digits;
  std::size_t after = at;
  while (after < text.size() && is_space(text[after])) ++after;
  const std::size_t length = unit_length(text.substr(after));
  token.quantity = {value, core::kNone, true};
  if (length > 0) {
    // Parsed like a value outside expressions, so that both are bit-identical.
    const auto quantity =
        core::parse_quantity(fmt::format("{} {}", number, text.substr(after, length)));
    if (!quantity) {
      error = {static_cast<int>(at - digits), "bad-number", "number out of range"};
      return false;
    }
    token.quantity = *quantity;
    at = after + length;
  }
  return true;
}

void read_name(std::string_view text, std::size_t& at, std::string& name) {
  while (at < text.size()) {
    if (is_letter(text[at]) || is_digit(text[at])) {
      name += text[at++];
    } else if (text[at] == '.' && at + 1 < text.size() &&
               (is_letter(text[at + 1]) || is_digit(text[at + 1]))) {
      name += text[at++];
    } else {
      break;
    }
  }
}

bool read_symbol(std::string_view text, std::size_t& at, Token& token) {
  const std::string_view two = text.substr(at, 2);
  const bool pair = two == "<=" || two == ">=" || two == "==" || two == "!=";
  if (!pair && std::string_view("+-*/^<>()?:,").find(text[at]) == std::string_view::npos) {
    return false;
  }
  token.kind = Token::Kind::symbol;
  token.text = std::string(text.substr(at, pair ? 2 : 1));
  at += token.text.size();
  return true;
}

// The equivalent here of another language's sign.
std::string_view instead_of(char sign) {
  switch (sign) {
    case '=':
      return ": equal is '=='";
    case '&':
      return ": write 'and'";
    case '|':
      return ": write 'or'";
    case '!':
      return ": write 'not'";
    default:
      return "";
  }
}

}  // namespace

std::optional<std::vector<Token>> tokenize(std::string_view text, ExpressionError& error) {
  std::vector<Token> tokens;
  std::size_t at = 0;
  while (true) {
    while (at < text.size() && is_space(text[at])) ++at;
    Token token;
    token.offset = static_cast<int>(at);
    if (at >= text.size()) {
      tokens.push_back(token);
      return tokens;
    }
    const char c = text[at];
    if (is_digit(c) || (c == '.' && at + 1 < text.size() && is_digit(text[at + 1]))) {
      if (!read_number(text, at, token, error)) return std::nullopt;
    } else if (is_letter(c)) {
      token.kind = Token::Kind::name;
      read_name(text, at, token.text);
    } else if (c == '$' && at + 1 < text.size() && is_letter(text[at + 1])) {
      token.kind = Token::Kind::parameter;
      ++at;
      read_name(text, at, token.text);
    } else if (!read_symbol(text, at, token)) {
      error = {token.offset, "bad-character",
               fmt::format("unexpected '{}' in an expression{}", core::character_at(text, at),
                           instead_of(c))};
      return std::nullopt;
    }
    if (tokens.size() >= kMaxTokens) {
      error = {token.offset, "too-large",
               fmt::format("an expression of more than {} words and signs", kMaxTokens)};
      return std::nullopt;
    }
    tokens.push_back(std::move(token));
  }
}

}  // namespace footfall::behaviors
