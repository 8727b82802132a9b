// Steps of saving values: find where a value is written, edit that text, verify the result. Load
// time only.
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

// A behavior compiled from its files; nodes and marks refer to `context`.
struct SaveSource {
  SaveSource(const LoadOptions& options, core::Diagnostics& diagnostics)
      : context(behavior, options, diagnostics) {}
  Behavior behavior;
  LoadContext context;
};

// Location of a parameter's or gain's value.
struct ValueHome {
  const core::YamlNode* node = nullptr;  // a quantity, or a list or map of quantities
  std::vector<std::string> axes;         // names of its values, if any
  KeyPath path;  // of the node; empty: several times in the tree, or not in its effective form
};

// A parameter with new values.
struct Wanted {
  int parameter = -1;
  std::vector<double> values;  // all its values, SI
  ValueHome home;
};

// One text edit: of a scalar, or a new entry of a map.
struct NodeEdit {
  const core::YamlNode* node = nullptr;  // the scalar, or the map
  std::string key;                       // key of the new entry; empty: edit of the scalar
  core::Mark near{};                     // a position in the file that gets the new entry
  std::string text;                      // flow YAML
};

// A save plan under construction.
struct SavePlanner {
  const SaveSource& source;
  const core::Diagnostics& files;  // names of the source's files
  SavePlan& plan;
  std::string only{};  // identity of the only file that may change; empty: any
  // Identities: a library's file may change only if it is `named`, one in `installed` never.
  std::string named{};
  std::vector<std::string> libraries{}, installed{};
  std::vector<Wanted> wanted{};
  std::vector<KeyPath> allowed{};  // paths that may differ in the tree
  // A changed file.
  struct File {
    core::FileChange change;
    std::vector<core::TextEdit> edits;  // of scalars
    std::vector<std::string> owners;    // parameters of the edits
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

// text_edits.cc: the edits for one parameter, each in the file that defines it.
void place_edits(SavePlanner& planner, const Wanted& wanted);
// The file to be changed, read on first use; nullptr and a refusal if it cannot be changed.
SavePlanner::File* open_file(SavePlanner& planner, const std::string& path, core::Mark mark,
                             const std::string& name);
// Reason why a file must not be written; empty if it may.
std::string reason_against_file(const SavePlanner& planner, const std::string& path);
// Creates a file's changed text; false and a refusal if impossible.
bool finish_file(SavePlanner& planner, SavePlanner::File& file);
// Canonical path: equal for two names of the same file.
std::string identity(const std::string& path);

// places.cc
ValueHome find_home(const SaveSource& source, const ParameterInfo& info);
// The edits that write `wanted` in place; only values that differ bit for bit change.
std::vector<NodeEdit> edits_in_place(const SaveSource& source, const Wanted& wanted);
// The complete value as text, for a file that does not contain it yet.
std::string whole_text(const SaveSource& source, const Wanted& wanted);
// All paths of nodes with this mark in a tree.
std::vector<KeyPath> paths_of(const core::YamlNode& root, const core::YamlNode& node);
bool begins_with(const KeyPath& path, const KeyPath& head);

// verify.cc: loads the behavior as if the changes were written. Returns the reasons why it differs
// from the old one other than by the wanted values; `allowed`: paths that may differ in the tree.
// If there are none, `notes` gets new problems found by check_physics(), with which `run` would
// refuse to start.
std::vector<std::string> reasons_against_result(const SaveSource& old, const std::string& path,
                                                const std::vector<core::FileChange>& changes,
                                                const std::vector<Wanted>& wanted,
                                                const std::vector<KeyPath>& allowed,
                                                std::vector<std::string>& notes);

}  // namespace footfall::behaviors
