// Typed access to YAML nodes; see value_reader.h.
#include "core/yaml/value_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/diagnostics/did_you_mean.h"

namespace footfall::core {

namespace {

constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_";
constexpr std::string_view kDigits = "0123456789";

// "a, b or c"
std::string alternatives(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) out += i + 1 == words.size() ? " or " : ", ";
    out += words[i];
  }
  return out;
}

bool is_reserved(std::string_view text) {
  constexpr std::array<std::string_view, 6> kReserved = {"on", "off", "yes", "no", "true", "false"};
  return std::find(kReserved.begin(), kReserved.end(), text) != kReserved.end();
}

// The rule that a name violates, or empty.
std::string name_problem(std::string_view text) {
  if (is_reserved(text)) return fmt::format("'{}' cannot be a name", text);
  if (!is_name(text)) return "letters, digits and '_', no digit first";
  return {};
}

}  // namespace

std::string describe(const YamlNode& node) {
  constexpr std::size_t kShown = 40;
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "nothing";
    case YamlNode::Kind::sequence:
      return "a list";
    case YamlNode::Kind::map:
      return "a map";
    case YamlNode::Kind::scalar:
      break;
  }
  if (node.scalar.size() <= kShown) return "'" + node.scalar + "'";
  std::size_t end = kShown;  // do not cut inside a UTF-8 sequence
  while (end > 0 && (static_cast<unsigned char>(node.scalar[end]) & 0xc0u) == 0x80u) --end;
  return "'" + node.scalar.substr(0, end) + "...'";
}

void report_expected(const YamlNode& node, std::string_view what, Diagnostics& diagnostics) {
  diagnostics.error(node.mark, "expected",
                    fmt::format("expected {}, got {}", what, describe(node)));
}

bool is_reference(const YamlNode& node) {
  return node.is_scalar() && node.scalar.size() > 1 && node.scalar.front() == '$' &&
         node.scalar.find_first_not_of(std::string(kLetters) + std::string(kDigits) + ".", 1) ==
             std::string::npos;
}

bool is_expression(const YamlNode& node) {
  return node.is_scalar() && !node.scalar.empty() && node.scalar.front() == '=';
}

bool is_off(const YamlNode& node) {
  return node.is_scalar() && !node.quoted && node.scalar == "off";
}

bool check_kind(const YamlNode& root, std::string_view kind, int newest, Diagnostics& diagnostics) {
  if (root.is_null()) return false;
  if (!root.is_map() || root.entries.empty() || root.entries.front().key != kind) {
    const bool key = root.is_map() && !root.entries.empty();
    const std::string got =
        key ? fmt::format("'{}'{}", root.entries.front().key,
                          did_you_mean(root.entries.front().key, {std::string(kind)}))
            : describe(root);
    diagnostics.error(root.mark, "kind",
                      fmt::format("not a {} file: expected '{}: {}' as the first key, got {}", kind,
                                  kind, newest, got));
    return false;
  }
  const YamlNode& version = root.entries.front().value;
  int number = 0;
  const char* const end = version.scalar.data() + version.scalar.size();
  const auto [stop, error] = std::from_chars(version.scalar.data(), end, number);
  if (version.is_scalar() && error == std::errc() && stop == end && number >= 1 &&
      number <= newest) {
    return true;
  }
  diagnostics.error(
      version.mark, "version",
      fmt::format("this program reads '{}: 1'{}, not version {}", kind,
                  newest > 1 ? fmt::format(" to '{}: {}'", kind, newest) : "", describe(version)));
  return false;
}

bool expect_map(const YamlNode& node, std::string_view what, Diagnostics& diagnostics) {
  if (node.is_map()) return true;
  report_expected(node, what, diagnostics);
  return false;
}

bool expect_sequence(const YamlNode& node, std::string_view what, Diagnostics& diagnostics) {
  if (node.is_sequence()) return true;
  report_expected(node, what, diagnostics);
  return false;
}

bool expect_scalar(const YamlNode& node, std::string_view what, Diagnostics& diagnostics) {
  if (node.is_scalar() && !node.scalar.empty()) return true;
  report_expected(node, what, diagnostics);
  return false;
}

void warn_cut(const YamlNode& text, Diagnostics& diagnostics) {
  if (!text.cut) return;
  diagnostics.warning(
      text.mark, "cut-text",
      fmt::format("'#' begins a comment: the text is only {}; quote it", describe(text)));
}

bool check_doc(const YamlNode& node, Diagnostics& diagnostics) {
  warn_cut(node, diagnostics);
  const bool plain = !node.quoted && (node.scalar == "true" || node.scalar == "false" ||
                                      parse_quantity(node.scalar).has_value());
  if (node.is_scalar() && !plain) return true;
  report_expected(node, plain ? "a text (in quotes if it is a number)" : "a text", diagnostics);
  return false;
}

void check_keys(const YamlNode& map, const std::vector<std::string>& known,
                Diagnostics& diagnostics) {
  for (const YamlEntry& entry : map.entries) {
    if (std::find(known.begin(), known.end(), entry.key) != known.end()) {
      if (entry.key == "doc") check_doc(entry.value, diagnostics);
      continue;
    }
    std::string hint = did_you_mean(entry.key, known);
    if (hint.empty()) hint = fmt::format(", expected {}", alternatives(known));
    diagnostics.error(entry.key_mark, "unknown-key",
                      fmt::format("unknown key '{}'{}", entry.key, hint));
  }
}

bool has_nearly(const YamlNode& map, std::string_view key) {
  return std::any_of(map.entries.begin(), map.entries.end(), [key](const YamlEntry& entry) {
    return entry.key != key && !nearest_name(entry.key, {std::string(key)}).empty();
  });
}

const YamlNode* require_key(const YamlNode& map, std::string_view key, Diagnostics& diagnostics) {
  const YamlNode* const node = map.find(key);
  if (node == nullptr && !(diagnostics.has_errors() && has_nearly(map, key))) {
    diagnostics.error(map.mark, "missing-key", fmt::format("the key '{}' is missing", key));
  }
  return node;
}

std::optional<std::int64_t> read_integer(const YamlNode& node, std::int64_t minimum,
                                         std::int64_t maximum, Diagnostics& diagnostics) {
  std::int64_t value = 0;
  const char* const begin = node.scalar.data();
  const char* const end = begin + node.scalar.size();
  const auto [stop, error] = std::from_chars(begin, end, value);
  if (node.is_scalar() && error == std::errc() && stop == end && value >= minimum &&
      value <= maximum) {
    return value;
  }
  report_expected(node, fmt::format("a whole number from {} to {}", minimum, maximum), diagnostics);
  return std::nullopt;
}

std::optional<bool> read_bool(const YamlNode& node, Diagnostics& diagnostics) {
  if (node.is_scalar() && !node.quoted) {
    if (node.scalar == "true") return true;
    if (node.scalar == "false") return false;
  }
  report_expected(node, "true or false", diagnostics);
  return std::nullopt;
}

std::optional<std::string> read_text(const YamlNode& node, Diagnostics& diagnostics,
                                     std::string_view what) {
  if (node.is_scalar() && !node.scalar.empty()) return node.scalar;
  report_expected(node, what, diagnostics);
  return std::nullopt;
}

bool is_name(std::string_view text) {
  return !text.empty() && kLetters.find(text.front()) != std::string_view::npos &&
         text.find_first_not_of(std::string(kLetters) + std::string(kDigits)) ==
             std::string_view::npos &&
         !is_reserved(text);
}

bool is_dotted_name(std::string_view text) {
  const std::string parts = std::string(kLetters) + std::string(kDigits) + "-";
  bool begins = true;  // at the beginning of a part
  for (const char c : text) {
    if (c == '.' ? begins : parts.find(c) == std::string::npos) return false;
    begins = c == '.';
  }
  return !begins;
}

std::optional<std::string> read_name(const YamlNode& node, Diagnostics& diagnostics,
                                     std::string_view what) {
  if (node.is_scalar() && is_name(node.scalar)) return node.scalar;
  if (node.is_scalar() && !node.scalar.empty()) {
    diagnostics.error(
        node.mark, "name",
        fmt::format("expected {} ({}), got {}", what, name_problem(node.scalar), describe(node)));
  } else {
    report_expected(node, what, diagnostics);
  }
  return std::nullopt;
}

bool check_name(const YamlEntry& entry, Diagnostics& diagnostics, std::string_view what) {
  if (is_name(entry.key)) return true;
  diagnostics.error(
      entry.key_mark, "name",
      fmt::format("expected {} ({}), got '{}'", what, name_problem(entry.key), entry.key));
  return false;
}

std::optional<int> read_choice(const YamlNode& node, const std::vector<std::string>& choices,
                               Diagnostics& diagnostics, std::string_view what) {
  if (node.is_scalar()) {
    const auto found = std::find(choices.begin(), choices.end(), node.scalar);
    if (found != choices.end()) return static_cast<int>(found - choices.begin());
  }
  const std::string words = alternatives(choices);
  const std::string hint = node.is_scalar() ? did_you_mean(node.scalar, choices) : std::string();
  diagnostics.error(
      node.mark, "expected",
      fmt::format("expected {}, got {}{}",
                  what.empty() ? words : fmt::format("{}: {}", what, words), describe(node), hint));
  return std::nullopt;
}

std::optional<std::vector<std::string>> read_texts(const YamlNode& node, Diagnostics& diagnostics,
                                                   std::string_view what) {
  std::vector<std::string> texts;
  if (!node.is_sequence()) {
    const std::optional<std::string> text =
        read_text(node, diagnostics, fmt::format("{} or a list", what));
    if (!text) return std::nullopt;
    texts.push_back(*text);
    return texts;
  }
  bool good = true;
  for (const YamlNode& item : node.items) {
    const std::optional<std::string> text = read_text(item, diagnostics, what);
    good = good && text;
    if (text) texts.push_back(*text);
  }
  return good ? std::optional(texts) : std::nullopt;
}

}  // namespace footfall::core
