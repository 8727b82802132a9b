// The file formats as data: every kind of map with its keys, every list of words. The loaders, the
// JSON Schema and the reference all use these tables, so that none of the three can know a key that
// the others do not.
//
// The tables are constants beside their loaders: behaviors/language/*.cc,
// model/robot/keys.cc, sim/world/keys.cc. The functions are for load time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/units.h"
#include "core/yaml/value_reader.h"

namespace footfall::core {

struct KeyTable;

// A keyword (a task type, a reaction, a function) and its meaning.
struct WordSpec {
  std::string_view word;
  std::string_view doc;
};

// Type of a value.
enum class ValueKind : std::uint8_t {
  none,          // unused element of KeySpec::values
  any,           // anything
  text,          // non-empty text
  name,          // name of an object, see ValueSpec::what
  boolean,       // true, false
  integer,       // an integer
  quantity,      // a number with a fixed dimension
  any_quantity,  // a number with any dimension, or one that depends on other keys
  condition,     // a boolean expression; `=` is implied
  choice,        // one of ValueSpec::words
  map,           // a map with the keys of ValueSpec::map
};

// Structure of a value.
enum class ValueForm : std::uint8_t {
  one,
  list,
  one_or_list,
  pair,     // [A, B]
  pairs,    // [[A, B], ...]
  by_axis,  // one number for all axes, a list, or a map by axis (of joints: with globs)
};

// One alternative for the value of a key.
struct ValueSpec {
  ValueKind kind = ValueKind::none;
  ValueForm form = ValueForm::one;
  bool named = false;                  // a map from user-defined names to such values
  bool expression = false;             // also `$parameter`, `= expression` or a single signal
  Dimension dimension{};               // for quantities
  std::string_view what{};             // noun for messages, e.g. "a state"; may be empty
  const KeyTable* map = nullptr;       // for maps
  std::span<const WordSpec> words{};   // for choices
  std::array<std::int64_t, 2> ends{};  // for integers: minimum, maximum
};

// One key of a map.
struct KeySpec {
  std::string_view name{};
  std::array<ValueSpec, 3> values{};  // alternatives; unused elements are `none`
  std::string_view doc{};             // one line
  bool needed = false;                // required
  std::string_view fallback{};        // default in YAML notation; may be empty
  std::string_view variants{};  // selector words that have this key, blanks between; empty: all

  constexpr KeySpec required() const {
    KeySpec out = *this;
    out.needed = true;
    return out;
  }
  constexpr KeySpec otherwise(std::string_view text) const {
    KeySpec out = *this;
    out.fallback = text;
    return out;
  }
  constexpr KeySpec only(std::string_view words) const {
    KeySpec out = *this;
    out.variants = words;
    return out;
  }
};

// One kind of map.
struct KeyTable {
  std::string_view id;                // unique in its file: "state"
  std::string_view doc;               // one line or a few
  std::span<const KeySpec> keys;      // in recommended order
  const KeyTable* more = nullptr;     // further keys, shared with other tables
  const ValueSpec* others = nullptr;  // value type under user-defined names
  std::string_view others_name{};     // kind of the user-defined names: "a task"
  // For each of these key lists (separated by blanks), at least one key must be present.
  std::array<std::string_view, 2> one_of{};
  bool part = false;                     // may be partial, to be merged over another map
  bool empty = false;                    // an empty value is allowed and means the empty map
  std::string_view selector{};           // key whose value selects the variant: "type"
  std::span<const WordSpec> variants{};  // the possible values of the selector
};

// A file format; its first key gives its kind and version: `behavior: 1`.
struct FileTable {
  std::string_view kind;  // "behavior"
  int newest = 1;         // newest supported version
  const KeyTable* root = nullptr;
};

// Constructors for values, so that the tables read like sentences.
constexpr ValueSpec anything() { return {.kind = ValueKind::any}; }
constexpr ValueSpec text_of(std::string_view what) {
  return {.kind = ValueKind::text, .what = what};
}
constexpr ValueSpec name_of(std::string_view what) {
  return {.kind = ValueKind::name, .what = what};
}
constexpr ValueSpec boolean() { return {.kind = ValueKind::boolean}; }
constexpr ValueSpec integer(std::int64_t least, std::int64_t greatest) {
  return {.kind = ValueKind::integer, .ends = {least, greatest}};
}
constexpr ValueSpec quantity(Dimension dimension, std::string_view what = {}) {
  return {.kind = ValueKind::quantity, .dimension = dimension, .what = what};
}
constexpr ValueSpec any_quantity(std::string_view what = {}) {
  return {.kind = ValueKind::any_quantity, .what = what};
}
constexpr ValueSpec condition() { return {.kind = ValueKind::condition, .expression = true}; }
constexpr ValueSpec choice(std::span<const WordSpec> words) {
  return {.kind = ValueKind::choice, .words = words};
}
constexpr ValueSpec map_of(const KeyTable& table) {
  return {.kind = ValueKind::map, .map = &table};
}
constexpr ValueSpec as(ValueForm form, ValueSpec value) {
  value.form = form;
  return value;
}
constexpr ValueSpec list(ValueSpec value) { return as(ValueForm::list, value); }
constexpr ValueSpec one_or_list(ValueSpec value) { return as(ValueForm::one_or_list, value); }
constexpr ValueSpec pair(ValueSpec value) { return as(ValueForm::pair, value); }
constexpr ValueSpec pairs(ValueSpec value) { return as(ValueForm::pairs, value); }
constexpr ValueSpec by_name(ValueSpec value) {
  value.named = true;
  return value;
}
constexpr ValueSpec by_axis(ValueSpec value) { return as(ValueForm::by_axis, value); }
constexpr ValueSpec computed(ValueSpec value) {  // allows an expression as well
  value.expression = true;
  return value;
}
constexpr KeySpec key(std::string_view name, ValueSpec value, std::string_view doc) {
  return {.name = name, .values = {value}, .doc = doc};
}
constexpr KeySpec key(std::string_view name, ValueSpec value, ValueSpec other,
                      std::string_view doc) {
  return {.name = name, .values = {value, other}, .doc = doc};
}
constexpr KeySpec key(std::string_view name, ValueSpec value, ValueSpec other, ValueSpec third,
                      std::string_view doc) {
  return {.name = name, .values = {value, other, third}, .doc = doc};
}

// Whether a key is allowed in `variant` (a word of the selector; empty if unknown).
bool belongs_to(const KeySpec& key, std::string_view variant);
// A key of a table (or of `more`) by name, nullptr if absent.
const KeySpec* find_key(const KeyTable& table, std::string_view name);
// The names of all keys of a table, restricted to one variant if given.
std::vector<std::string> key_names(const KeyTable& table, std::string_view variant = {});
// Every kind of map in a file format, each once, depth first in key order.
std::vector<const KeyTable*> tables_of(const FileTable& file);
std::vector<std::string> word_names(std::span<const WordSpec> words);
// The meaning of a word, empty if unknown.
std::string_view doc_of(std::span<const WordSpec> words, std::string_view word);

// check_keys, require_key and read_choice of value_reader with the names of a table.
void check_keys(const YamlNode& map, const KeyTable& table, Diagnostics& diagnostics,
                std::string_view variant = {});
std::optional<int> read_choice(const YamlNode& node, std::span<const WordSpec> words,
                               Diagnostics& diagnostics, std::string_view what = {});

}  // namespace footfall::core
