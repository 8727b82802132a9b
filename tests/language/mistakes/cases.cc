// Reads case files with the project's YAML reader; a malformed one is a mistake of the test.
#include "tests/language/mistakes/cases.h"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "core/yaml/yaml.h"

namespace footfall::tests {
namespace {

using core::YamlEntry;
using core::YamlNode;

YamlNode load(const std::string& path) {
  core::Diagnostics diagnostics;
  YamlNode root = core::load_yaml_file(path, diagnostics);
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
  return root;
}

std::vector<YamlEntry> entries(const YamlNode& map, std::string_view key) {
  const YamlNode* node = map.find(key);
  return node == nullptr ? std::vector<YamlEntry>() : node->entries;
}

// Replaces the only occurrence of `from`.
void replace_once(std::string& text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos || text.find(from, at + 1) != std::string::npos) {
    throw std::runtime_error("'" + from + "' does not occur once in\n" + text);
  }
  text.replace(at, from.size(), to);
}

// Takes the '@'s out of a text and appends their places.
void take_marks(TextFile& file, std::vector<ExpectedDiagnostic>& places) {
  std::string text;
  int line = 1, column = 1;
  for (const char c : file.text) {
    if (c == '@') {
      places.push_back({file.name, line, column, {}, {}});
      continue;
    }
    text += c;
    column = c == '\n' ? 1 : column + 1;
    if (c == '\n') ++line;
  }
  file.text = text;
}

std::string changed_text(const YamlNode& node, const YamlNode* default_base,
                         const std::vector<TextFile>& bases) {
  if (const YamlNode* text = node.find("text")) return text->scalar;
  const YamlNode* name = node.find("base") != nullptr ? node.find("base") : default_base;
  if (name == nullptr) throw std::runtime_error("neither text nor base");
  const auto base = std::find_if(bases.begin(), bases.end(),
                                 [&](const TextFile& item) { return item.name == name->scalar; });
  if (base == bases.end()) throw std::runtime_error("no base '" + name->scalar + "'");
  std::string text = base->text;
  for (const YamlEntry& change : entries(node, "change")) {
    replace_once(text, change.key, change.value.scalar);
  }
  return text;
}

void read_expected(const YamlNode& node, MistakeCase& mistake) {
  std::vector<ExpectedDiagnostic>& places = mistake.expected;
  if (const YamlNode* at = node.find("at")) {
    ExpectedDiagnostic place;
    char colon = 0;
    std::istringstream(at->scalar) >> place.line >> colon >> place.column;
    places.insert(places.begin(), place);
  }
  for (TextFile& file : mistake.files) take_marks(file, places);
  std::vector<YamlEntry> expected = entries(node, "expect");
  if (const YamlNode* list = node.find("expect")) {
    for (const YamlNode& item : list->items) {
      expected.insert(expected.end(), item.entries.begin(), item.entries.end());
    }
  }
  if (expected.size() != places.size()) throw std::runtime_error("not one place a diagnostic");
  for (std::size_t i = 0; i < places.size(); ++i) {
    places[i].id = expected[i].key;
    places[i].part = expected[i].value.scalar;
    if (places[i].part.empty()) throw std::runtime_error("no part of the message");
  }
}

MistakeCase read_case(const YamlEntry& entry, const YamlNode* default_base,
                      const std::vector<TextFile>& bases) {
  MistakeCase mistake;
  mistake.files.push_back({entry.key + ".yaml", changed_text(entry.value, default_base, bases)});
  for (const YamlEntry& file : entries(entry.value, "files")) {
    mistake.files.push_back({file.key, file.value.scalar});
  }
  for (const YamlEntry& set : entries(entry.value, "set")) {
    mistake.set.emplace_back(set.key, set.value.scalar);
  }
  read_expected(entry.value, mistake);
  return mistake;
}

}  // namespace

std::vector<TextFile> read_bases(const std::string& folder) {
  const YamlNode root = load(folder + "/bases.yaml");
  std::vector<TextFile> bases;
  for (const YamlEntry& entry : root.entries) {
    bases.push_back({entry.key, entry.value.scalar});
  }
  return bases;
}

std::vector<MistakeCase> read_cases(const std::string& path, const std::vector<TextFile>& bases) {
  const YamlNode root = load(path);
  const std::string file = std::filesystem::path(path).filename().string();
  std::vector<MistakeCase> cases;
  for (const YamlEntry& entry : entries(root, "cases")) {
    try {
      cases.push_back(read_case(entry, root.find("base"), bases));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(file + ": " + entry.key + ": " + error.what());
    }
    cases.back().name = file + ": " + entry.key;
  }
  return cases;
}

}  // namespace footfall::tests
