// What the steps of saving values share: where a value is written, how that text changes, whether
// the result is what was asked for. Load time only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/load_context.h"
#include "behaviors/save_values.h"
#include "core/yaml.h"

namespace footfall::behaviors {

using KeyPath = std::vector<std::string>;  // keys from the root of a tree inwards

// A behavior as its files have it, compiled; nodes and marks are those of `context`.
struct SaveSource {
  SaveSource(const LoadOptions& options, core::Diagnostics& diagnostics)
      : context(behavior, options, diagnostics) {}
  Behavior behavior;
  LoadContext context;
};

// Where the value of a parameter or gain is written.
struct ValueHome {
  const core::YamlNode* node = nullptr;  // a quantity, a list or a map of them
  std::vector<std::string> axes;         // names of its values, if they have some
  KeyPath path;  // to the node; empty: it is in the tree more than once, or not as it is in force
};

// A parameter that gets other values.
struct Wanted {
  int parameter = -1;
  std::vector<double> values;  // all of them, SI
  ValueHome home;
};

// One change of text: of a scalar, or a new entry of a map.
struct NodeEdit {
  const core::YamlNode* node = nullptr;  // the scalar, or the map
  std::string key;                       // of the new entry; empty: the scalar changes
  core::Mark near{};                     // a place in the file that the entry goes to
  std::string text;                      // flow YAML
};

// save_places.cc
ValueHome find_home(const SaveSource& source, const ParameterInfo& info);
// The texts that give `wanted` where it is written now; only what differs bit for bit changes.
std::vector<NodeEdit> edits_in_place(const SaveSource& source, const Wanted& wanted);
// The value as a whole: what stands under its path in a file that has none of it.
std::string whole_text(const SaveSource& source, const Wanted& wanted);
// The paths at which a tree has a node with this mark.
std::vector<KeyPath> paths_of(const core::YamlNode& root, const core::YamlNode& node);
bool begins_with(const KeyPath& path, const KeyPath& head);

// save_check.cc: loads the behavior with the changes as if they had been written. Reasons why it is
// not the old one with the wanted values and nothing else; `allowed`: what may differ in the tree.
std::vector<std::string> reasons_against_result(const SaveSource& old, const std::string& path,
                                                const std::vector<core::FileChange>& changes,
                                                const std::vector<Wanted>& wanted,
                                                const std::vector<KeyPath>& allowed);

// Whether two doubles are the same 64 bits.
bool same_bits(double a, double b);

}  // namespace footfall::behaviors
