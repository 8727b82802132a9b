// A tree as YAML text; see write.h.
#include "core/yaml_text/write.h"

#include <fmt/format.h>

#include <algorithm>

namespace footfall::core {
namespace {

// Whether the text, unquoted, reads back as the same text, inside brackets too.
bool may_be_plain(const std::string& text) {
  if (text.empty() || text.front() == ' ' || text.back() == ' ' || text.back() == ':') return false;
  if (std::string_view("#&*!|>'\"%@`?,[]{}").find(text.front()) != std::string_view::npos)
    return false;
  if (text.front() == '-' && (text.size() == 1 || text[1] == ' ')) return false;
  if (text.front() == ':' || text.starts_with("---") || text.starts_with("...")) return false;
  static constexpr const char* kNull[] = {"~", "null", "Null", "NULL"};
  if (std::ranges::find(kNull, text) != std::end(kNull)) return false;
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20; };
  return text.find_first_of(",[]{}") == std::string::npos && text.find(": ") == std::string::npos &&
         text.find(" #") == std::string::npos && std::ranges::none_of(text, control);
}

std::string scalar_text(const std::string& text, bool quoted) {
  if (!quoted && may_be_plain(text)) return text;
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += fmt::format("\\{}", c);
    } else if (byte < 0x20) {
      out += fmt::format("\\x{:02x}", byte);
    } else {
      out += c;
    }
  }
  return out + '"';
}

void write_block(const YamlNode& node, std::size_t indent, std::size_t width, std::string& out);

// Writes a value behind `KEY:` or `-`; `out` holds the line so far.
void write_value(const YamlNode& node, std::size_t column, std::size_t indent, std::size_t width,
                 std::string& out) {
  if (node.is_null()) {
    out += '\n';
    return;
  }
  const std::string flow = to_flow_yaml(node);
  const bool children = !node.items.empty() || !node.entries.empty();
  if (!children || column + 1 + flow.size() <= width) {
    out += " " + flow + "\n";
    return;
  }
  out += '\n';
  write_block(node, indent, width, out);
}

void write_block(const YamlNode& node, std::size_t indent, std::size_t width, std::string& out) {
  for (const YamlNode& item : node.items) {
    out += std::string(indent, ' ') + "-";
    write_value(item, indent + 1, indent + 2, width, out);
  }
  for (const YamlEntry& entry : node.entries) {
    const std::string key = scalar_text(entry.key, entry.key_quoted) + ":";
    out += std::string(indent, ' ') + key;
    write_value(entry.value, indent + key.size(), indent + 2, width, out);
  }
}

}  // namespace

std::string to_flow_yaml(const YamlNode& node) {
  std::string out;
  switch (node.kind) {
    case YamlNode::Kind::null:
      return "~";
    case YamlNode::Kind::scalar:
      return scalar_text(node.scalar, node.quoted);
    case YamlNode::Kind::sequence:
      for (const YamlNode& item : node.items) out += (out.empty() ? "" : ", ") + to_flow_yaml(item);
      return "[" + out + "]";
    default:
      for (const YamlEntry& entry : node.entries) {
        out += (out.empty() ? "" : ", ") + scalar_text(entry.key, entry.key_quoted) + ": " +
               to_flow_yaml(entry.value);
      }
      return "{" + out + "}";
  }
}

std::string to_yaml(const YamlNode& node, std::size_t width) {
  if (node.is_scalar() || node.is_null()) return to_flow_yaml(node) + "\n";
  std::string out;
  write_block(node, 0, width, out);
  return out.empty() ? to_flow_yaml(node) + "\n" : out;
}

}  // namespace footfall::core
