// Textual description of values; see value_text.h.
#include "apps/reference/value_text.h"

#include <fmt/format.h>

#include <vector>

namespace footfall::apps {
namespace {

using core::ValueForm;
using core::ValueKind;
using core::ValueSpec;

// Tables show "time" instead of "a time".
std::string without_article(std::string text) {
  for (const char* article : {"a ", "an ", "the "}) {
    if (text.starts_with(article)) return text.substr(std::string_view(article).size());
  }
  return text;
}

std::string alternatives(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t k = 0; k < words.size(); ++k) {
    if (k > 0) out += k + 1 == words.size() ? " or " : ", ";
    out += "`" + words[k] + "`";
  }
  return out;
}

std::string quantity_text(const ValueSpec& value) {
  const std::string unit = core::unit_text(value.dimension);
  std::string name =
      value.what.empty() ? core::dimension_name(value.dimension) : std::string(value.what);
  name = without_article(name);
  if (name == "plain number") return "number";
  if (name.starts_with("value in ")) return fmt::format("number ({})", unit);
  return name;
}

std::string one_text(const ValueSpec& value, bool links) {
  switch (value.kind) {
    case ValueKind::none:
      return {};
    case ValueKind::any:
      return "anything";
    case ValueKind::text:
      return without_article(std::string(value.what));
    case ValueKind::name:
      return "name of " + std::string(value.what);
    case ValueKind::boolean:
      return "`true` or `false`";
    case ValueKind::integer:
      return value.ends[0] == value.ends[1]
                 ? fmt::format("`{}`", value.ends[0])
                 : fmt::format("whole number, {} to {}", value.ends[0], value.ends[1]);
    case ValueKind::quantity:
      return quantity_text(value);
    case ValueKind::any_quantity:
      return value.what.empty() ? "number with its unit" : fmt::format("number ({})", value.what);
    case ValueKind::condition:
      return "condition";
    case ValueKind::choice:
      return alternatives(core::word_names(value.words));
    case ValueKind::map:
      return links ? fmt::format("[{0}](#{0})", value.map->id) : std::string(value.map->id);
  }
  return {};
}

}  // namespace

std::string value_text(const ValueSpec& value, bool links) {
  std::string text = one_text(value, links);
  if (value.expression && value.kind != ValueKind::condition) text += " or expression";
  switch (value.form) {
    case ValueForm::one:
      break;
    case ValueForm::list:
      text = "list: " + text;
      break;
    case ValueForm::one_or_list:
      text += ", or a list";
      break;
    case ValueForm::pair:
      text = "two: " + text;
      break;
    case ValueForm::pairs:
      text = "list of pairs: " + text;
      break;
    case ValueForm::by_axis:
      text += ", or one an axis";
      break;
  }
  return value.named ? "map by name: " + text : text;
}

std::string values_text(const core::KeySpec& key, bool links) {
  std::string text;
  for (const ValueSpec& value : key.values) {
    if (value.kind == ValueKind::none) break;
    if (!text.empty()) text += "; or ";
    text += value_text(value, links);
  }
  return text;
}

std::string hover_text(const core::KeySpec& key) {
  std::string text(key.doc);
  text += "\n\n" + values_text(key, false);
  if (key.needed) text += "; required";
  if (!key.fallback.empty()) text += fmt::format("; default {}", key.fallback);
  return text;
}

std::string alternatives_text(std::string_view words) {
  std::vector<std::string> list;
  while (!words.empty()) {
    const std::size_t blank = words.find(' ');
    list.emplace_back(words.substr(0, blank));
    words = blank == std::string_view::npos ? std::string_view() : words.substr(blank + 1);
  }
  return alternatives(list);
}

}  // namespace footfall::apps
