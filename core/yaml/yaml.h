// YAML as an immutable tree with exact positions; the only use of yaml-cpp.
//
// Scalars stay text (readers apply YAML 1.2: only `true`/`false` are booleans). Refused here, with
// a position: duplicate keys, tabs as indentation, `<<`, several documents, invalid UTF-8, nesting
// deeper than 100, more than 200000 nodes after alias expansion, self-references, files over 4 MB.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "core/text/file_change.h"

namespace footfall::core {

struct YamlEntry;

// One node; a map keeps the order of its keys.
struct YamlNode {
  enum class Kind { null, scalar, sequence, map };
  Kind kind = Kind::null;
  std::string scalar;              // text of a scalar
  bool quoted = false;             // written with quotes (or as a block scalar)
  bool cut = false;                // a comment behind it looks like more of its text: `step #{n}`
  Mark mark;                       // start of the node
  std::vector<YamlNode> items;     // of a sequence
  std::vector<YamlEntry> entries;  // of a map, in file order

  bool is_null() const { return kind == Kind::null; }
  bool is_scalar() const { return kind == Kind::scalar; }
  bool is_sequence() const { return kind == Kind::sequence; }
  bool is_map() const { return kind == Kind::map; }
  // The value under a key, nullptr if absent or if this is not a map.
  const YamlNode* find(std::string_view key) const;
};

struct YamlEntry {
  std::string key;
  Mark key_mark;
  bool key_quoted = false;
  YamlNode value;
};

// Reads a file. Problems (also "cannot read") are added to diagnostics; the result is then null.
YamlNode load_yaml_file(const std::string& path, Diagnostics& diagnostics);
// Reads text; `name` is the file name in messages.
YamlNode load_yaml_text(std::string_view text, const std::string& name, Diagnostics& diagnostics);

// A change that a file makes to a value of its base.
struct YamlChange {
  enum class Kind { replaced, removed, appended };
  Kind kind = Kind::replaced;
  std::string path;  // dotted path of the value
  YamlNode old;      // value in the base, with its position
  Mark mark;         // position of the change
  YamlNode now{};    // the new value, of a change that replaces
};
using YamlHistory = std::vector<YamlChange>;  // the innermost base's changes first

struct YamlLayers;

// `base: OTHER.yaml` inheritance (relative to the file): maps merge by key in the base's order, new
// keys last; everything else is replaced as a whole; `NAME: off` removes; `KEY+:` appends to a
// list (with `KEY: off` beside it, it begins a new one). Cycles and missing bases are errors.
// Equals load_yaml_file + resolve. Replaced values are added to `history` if it is given, the files
// as written to `layers` (layers.h). A base is searched beside the file that names it, then as NAME
// or NAME.yaml in the folders `library`.
YamlNode load_yaml_with_base(const std::string& path, Diagnostics& diagnostics,
                             YamlHistory* history = nullptr,
                             const std::vector<std::string>& library = {},
                             YamlLayers* layers = nullptr);
// load_yaml_with_base() as if the changes were already written.
YamlNode load_changed_yaml_with_base(const std::string& path,
                                     const std::vector<FileChange>& changes,
                                     Diagnostics& diagnostics,
                                     const std::vector<std::string>& library);
// load_yaml_with_base() for text; `base:` is relative to the folder of `name`.
YamlNode load_yaml_text_with_base(std::string_view text, const std::string& name,
                                  Diagnostics& diagnostics, YamlHistory* history = nullptr,
                                  const std::vector<std::string>& library = {},
                                  YamlLayers* layers = nullptr);

}  // namespace footfall::core
