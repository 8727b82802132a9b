// What a file may say, as data: every kind of map with its keys, every list of words. The loaders
// take the names of keys and words from these tables, the JSON Schema and the reference are printed
// from them; so none of the three can know a key that the others do not.
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

// A word with a fixed meaning (a type of task, a reaction, a function) and what it means.
struct WordSpec {
  std::string_view word;
  std::string_view doc;
};

// What one value is.
enum class ValueKind : std::uint8_t {
  none,          // unused place of KeySpec::values
  any,           // anything
  text,          // any text that is not empty
  name,          // of something, see ValueSpec::what
  boolean,       // true, false
  integer,       // a whole number
  quantity,      // a number of one dimension
  any_quantity,  // a number of any dimension, or of one that other keys decide
  condition,     // an expression that is true or false; `=` is implied
  choice,        // one of ValueSpec::words
  map,           // with the keys of ValueSpec::map
};

// How many of them.
enum class ValueForm : std::uint8_t {
  one,
  list,
  one_or_list,
  pair,     // [A, B]
  pairs,    // [[A, B], ...]
  by_axis,  // one number for all axes, a list, or a map by axis (of joints: with globs)
};

// One thing that may stand under a key.
struct ValueSpec {
  ValueKind kind = ValueKind::none;
  ValueForm form = ValueForm::one;
  bool named = false;                  // a map of them by names of the author's own
  bool expression = false;             // also `$parameter`, `= expression`, or a lone signal
  Dimension dimension{};               // of a quantity
  std::string_view what{};             // of a name or text: "a state"; else a closer word, or empty
  const KeyTable* map = nullptr;       // of a map
  std::span<const WordSpec> words{};   // of a choice
  std::array<std::int64_t, 2> ends{};  // of an integer: least, greatest
};

// One key of a map.
struct KeySpec {
  std::string_view name{};
  std::array<ValueSpec, 3> values{};  // any of these; the first ones, the rest are `none`
  std::string_view doc{};             // one line
  bool needed = false;                // an error without it
  std::string_view fallback{};        // what holds without it, as one would write it; may be empty
  std::string_view variants{};  // words of the table's selector that have this key, with blanks
                                // between; empty: all

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
  std::string_view id;                // short and unique in its file: "state"
  std::string_view doc;               // one line or a few
  std::span<const KeySpec> keys;      // in the order in which one would write them
  const KeyTable* more = nullptr;     // whose keys it has too
  const ValueSpec* others = nullptr;  // what stands under names of the author's own
  std::string_view others_name{};     // what those names are: "a task"
  // Of each of these lists of keys (blanks between) at least one must be there.
  std::array<std::string_view, 2> one_of{};
  bool part = false;                     // may be given in part, to be laid over another
  bool empty = false;                    // nothing at all stands for the empty map
  std::string_view selector{};           // key whose word decides which keys there are: "type"
  std::span<const WordSpec> variants{};  // the words of the selector
};

// A kind of file; its first key is its name and version: `behavior: 1`.
struct FileTable {
  std::string_view kind;  // "behavior"
  int newest = 1;         // version
  const KeyTable* root = nullptr;
};

// Values, in a form that reads like a sentence in a table.
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
constexpr ValueSpec computed(ValueSpec value) {  // an expression may stand there
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

// Whether a key may stand beside `variant` (a word of the selector; empty: not known).
bool belongs_to(const KeySpec& key, std::string_view variant);
// A key of a table (or of `more`) by name, nullptr if it has none.
const KeySpec* find_key(const KeyTable& table, std::string_view name);
// The names of all keys of a table, of one variant where it is known.
std::vector<std::string> key_names(const KeyTable& table, std::string_view variant = {});
// Every kind of map that a file may hold, each once, from the root in the order of the keys.
std::vector<const KeyTable*> tables_of(const FileTable& file);
std::vector<std::string> word_names(std::span<const WordSpec> words);
// The meaning of a word, empty if it is none of these.
std::string_view doc_of(std::span<const WordSpec> words, std::string_view word);

// value_reader's check_keys, require_key and read_choice with the names of a table.
void check_keys(const YamlNode& map, const KeyTable& table, Diagnostics& diagnostics,
                std::string_view variant = {});
std::optional<int> read_choice(const YamlNode& node, std::span<const WordSpec> words,
                               Diagnostics& diagnostics, std::string_view what = {});

}  // namespace footfall::core
