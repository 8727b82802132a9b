// Names from key tables; see key_table.h.
#include "core/yaml/key_table.h"

#include <algorithm>

namespace footfall::core {
namespace {

void collect(const KeyTable* table, std::vector<const KeyTable*>& found) {
  if (table == nullptr || std::find(found.begin(), found.end(), table) != found.end()) return;
  found.push_back(table);
  for (const KeySpec& key : table->keys) {
    for (const ValueSpec& value : key.values) collect(value.map, found);
  }
  if (table->others != nullptr) collect(table->others->map, found);
  collect(table->more, found);
}

}  // namespace

bool belongs_to(const KeySpec& key, std::string_view variant) {
  if (key.variants.empty() || variant.empty()) return true;
  std::string_view rest = key.variants;
  while (!rest.empty()) {
    const std::size_t blank = rest.find(' ');
    if (rest.substr(0, blank) == variant) return true;
    rest = blank == std::string_view::npos ? std::string_view() : rest.substr(blank + 1);
  }
  return false;
}

const KeySpec* find_key(const KeyTable& table, std::string_view name) {
  for (const KeySpec& key : table.keys) {
    if (key.name == name) return &key;
  }
  return table.more == nullptr ? nullptr : find_key(*table.more, name);
}

std::vector<std::string> key_names(const KeyTable& table, std::string_view variant) {
  std::vector<std::string> names;
  for (const KeySpec& key : table.keys) {
    if (belongs_to(key, variant)) names.emplace_back(key.name);
  }
  if (table.more != nullptr) {
    for (std::string& name : key_names(*table.more, variant)) names.push_back(std::move(name));
  }
  return names;
}

std::vector<const KeyTable*> tables_of(const FileTable& file) {
  std::vector<const KeyTable*> found;
  collect(file.root, found);
  return found;
}

std::vector<std::string> word_names(std::span<const WordSpec> words) {
  std::vector<std::string> names;
  names.reserve(words.size());
  for (const WordSpec& word : words) names.emplace_back(word.word);
  return names;
}

std::string_view doc_of(std::span<const WordSpec> words, std::string_view word) {
  for (const WordSpec& candidate : words) {
    if (candidate.word == word) return candidate.doc;
  }
  return {};
}

void check_keys(const YamlNode& map, const KeyTable& table, Diagnostics& diagnostics,
                std::string_view variant) {
  check_keys(map, key_names(table, variant), diagnostics);
}

std::optional<int> read_choice(const YamlNode& node, std::span<const WordSpec> words,
                               Diagnostics& diagnostics, std::string_view what) {
  return read_choice(node, word_names(words), diagnostics, what);
}

}  // namespace footfall::core
