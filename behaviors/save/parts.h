// What the steps of saving values share: where a value is written, how that text changes, whether
// the result is what was asked for. Load time only.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "behaviors/load/context.h"
#include "behaviors/save/values.h"
#include "core/yaml/yaml.h"
#include "core/yaml_text/edit.h"

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

// A plan while it is being made.
struct SavePlanner {
  const SaveSource& source;
  const core::Diagnostics& files;  // names of the source's files
  SavePlan& plan;
  std::string overlay{};  // identity of the only file that may change, if there is one
  std::vector<Wanted> wanted{};
  std::vector<KeyPath> allowed{};  // what may differ in the tree
  // A file that changes.
  struct File {
    core::FileChange change;
    std::vector<core::TextEdit> edits;  // of scalars
    std::vector<std::string> owners;    // of the edits: parameters
    struct Addition {
      KeyPath path;
      std::string text, name;
    };
    std::vector<Addition> additions;
  };
  std::map<std::string, File> changes{};  // by identity

  const std::string& path_of(core::Mark mark) const { return files.file(mark.file); }
  const ParameterInfo& info(const Wanted& value) const {
    return source.behavior.parameters[static_cast<std::size_t>(value.parameter)];
  }
  void refuse(core::Mark mark, const std::string& name, const std::string& reason);
};

// text_edits.cc: the texts that change for one parameter, each in the file that it belongs to.
void place_edits(SavePlanner& planner, const Wanted& wanted);
// A file that is to change, read at its first use; nullptr and a refusal if it cannot be changed.
SavePlanner::File* open_file(SavePlanner& planner, const std::string& path, core::Mark mark,
                             const std::string& name);
// Makes a file's changed text; false and a refusal if it cannot be made.
bool finish_file(SavePlanner& planner, SavePlanner::File& file);
// A path that two names of one file have in common.
std::string identity(const std::string& path);

// places.cc
ValueHome find_home(const SaveSource& source, const ParameterInfo& info);
// The texts that give `wanted` where it is written now; only what differs bit for bit changes.
std::vector<NodeEdit> edits_in_place(const SaveSource& source, const Wanted& wanted);
// The value as a whole: what stands under its path in a file that has none of it.
std::string whole_text(const SaveSource& source, const Wanted& wanted);
// The paths at which a tree has a node with this mark.
std::vector<KeyPath> paths_of(const core::YamlNode& root, const core::YamlNode& node);
bool begins_with(const KeyPath& path, const KeyPath& head);

// verify.cc: loads the behavior with the changes as if they had been written. Reasons why it is
// not the old one with the wanted values and nothing else; `allowed`: what may differ in the tree.
// Without one, `notes` gets what check_physics() newly finds wrong with it: `run` would refuse it.
std::vector<std::string> reasons_against_result(const SaveSource& old, const std::string& path,
                                                const std::vector<core::FileChange>& changes,
                                                const std::vector<Wanted>& wanted,
                                                const std::vector<KeyPath>& allowed,
                                                std::vector<std::string>& notes);

// Whether two doubles are the same 64 bits.
bool same_bits(double a, double b);

}  // namespace footfall::behaviors
