// Decimal commas in flow maps and lists; see flow_traps.h.
#include "core/yaml/flow_traps.h"

#include <algorithm>

#include "core/units/units.h"

namespace footfall::core {
namespace {

// `12`, `-3`: what may be in front of a decimal comma.
bool is_whole(const YamlNode& node) {
  if (!node.is_scalar() || node.quoted || node.scalar.empty()) return false;
  std::string_view text = node.scalar;
  if (text.front() == '-' || text.front() == '+') text.remove_prefix(1);
  return !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
}

// `5`, `5 cm`: what may be behind it.
bool is_fraction(const std::string& text) {
  return !text.empty() && is_digit(text.front()) && parse_quantity(text).has_value();
}

// The column behind a scalar and its comma.
int end_of(const YamlNode& node) {
  return node.mark.column + static_cast<int>(node.scalar.size()) + 1;
}

bool is_tight(const YamlNode& a, const YamlNode& b) {
  return is_whole(a) && b.is_scalar() && !b.quoted && is_fraction(b.scalar) &&
         a.mark.line == b.mark.line && b.mark.column == end_of(a);
}

}  // namespace

std::string split_quantity(const YamlEntry& before, const std::string& key) {
  if (!is_whole(before.value) || !is_fraction(key)) return {};
  return before.value.scalar + "." + key;
}

const YamlNode* split_item(const YamlNode& list) {
  const YamlNode* tight = nullptr;
  bool loose = false;
  for (std::size_t k = 0; k + 1 < list.items.size(); ++k) {
    const YamlNode& item = list.items[k];
    if (is_tight(item, list.items[k + 1])) {
      if (tight == nullptr) tight = &item;
    } else {
      loose = true;
    }
  }
  return loose ? tight : nullptr;
}

std::string comma_hint(const YamlNode& list) {
  for (std::size_t k = 0; k + 1 < list.items.size(); ++k) {
    if (is_tight(list.items[k], list.items[k + 1])) {
      return " (a decimal point, not a comma: " + list.items[k].scalar + "." +
             list.items[k + 1].scalar + "?)";
    }
  }
  return {};
}

bool is_cut(std::string_view source, std::size_t at, std::string_view value) {
  // A plain scalar of several lines has a blank where the source has a line end and indentation.
  for (const char c : value) {
    if (at >= source.size()) return false;
    if (c == ' ' || c == '\n') {
      if (source[at] != ' ' && source[at] != '\t' && source[at] != '\n' && source[at] != '\r') {
        return false;
      }
      at = std::min(source.find_first_not_of(" \t\r\n", at), source.size());
    } else if (source[at++] != c) {
      return false;
    }
  }
  const std::size_t mark = source.find_first_not_of(" \t", at);
  if (mark == std::string_view::npos || mark == at || source[mark] != '#') return false;
  const std::size_t end = std::min(source.find('\n', mark), source.size());
  const std::string_view comment = source.substr(mark + 1, end - mark - 1);
  if (comment.empty() || comment.front() == '#' || comment.front() == '\r') return false;
  return comment.front() != ' ' || comment.find('{') != std::string_view::npos;
}

std::string comment_hint(std::string_view source, int line) {
  for (int k = 1; k < line && !source.empty(); ++k) {
    source.remove_prefix(std::min(source.find('\n') + 1, source.size()));
  }
  const std::string_view text = source.substr(0, source.find('\n'));
  int open = 0;
  char quote = '\0';
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    if (quote != '\0') {
      if (c == quote) quote = '\0';
    } else if (c == '"' || c == '\'') {
      quote = c;
    } else if (c == '{' || c == '[') {
      ++open;
    } else if (c == '}' || c == ']') {
      --open;
    } else if (c == '#' && k > 0 && is_blank(text[k - 1])) {
      const bool closes = text.find_first_of("]}", k) != std::string_view::npos;
      return open > 0 && closes
                 ? "; in line " + std::to_string(line) + ", '#' begins a comment: quote the text"
                 : std::string();
    }
  }
  return {};
}

}  // namespace footfall::core
