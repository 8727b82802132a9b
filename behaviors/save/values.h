// Saves values of a running behavior to its YAML: plans and verifies the changes in memory, shows
// them, then writes. Load-time tools only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "core/text/file_change.h"

namespace footfall::behaviors {

// One changed place, for display.
struct SavedPlace {
  std::string name;                // parameter or gain
  std::string file;                // file that contains its value
  int line = 0, column = 0;        // position of the old text; 0 if the value is new there
  std::string old_text, new_text;  // as written: `145 ms`
};

// Planned changes. Nothing is written unless `refusals` is empty.
struct SavePlan {
  std::vector<core::FileChange> files;  // changed files; empty if all files already have the values
  std::vector<SavedPlace> places;
  std::vector<std::string> refusals;  // `file:line:column: NAME: reason`, one for each value
  std::vector<std::string> notes;     // to be shown before confirmation

  bool unwritable = false;  // one of them: a file or folder may not be written
  bool refused() const { return !refusals.empty(); }
};

// The files that may get values.
struct SaveTarget {
  // Gets all values; empty: the behavior's own file. A new one gets `base: PATH` and only the
  // differences; an existing one must be the behavior or have it among its bases.
  std::string file;
  // Each value goes where it is defined, possibly a base, unless that is a file of a library.
  bool into_bases = false;
  std::vector<std::string> installed;  // folders whose files are never written
};

// Plans to write `values` to the behavior file at `path`, or to target.file: edited in place if it
// has the value, else as an override of its base's. Values equal to those that this file results in
// change nothing.
//
// options.set is not applied: values of `--set` are not defined in a file and are written only if
// they are among `values`. Of a variable this is its first value. Refused, with the reason: unknown
// names, values that are out of range or given by an expression, texts shared by several values
// that would have to differ.
// Every plan has been verified by loading it from memory: exactly these values bit for bit, every
// other value of the file (or overlay) unchanged. Problems of the files are added to `diagnostics`;
// the plan is then refused, too.
SavePlan plan_save(const std::string& path, const LoadOptions& options,
                   const std::vector<NamedValue>& values, const SaveTarget& target,
                   core::Diagnostics& diagnostics);

// The plan in the format of `diff -u`, file by file.
std::string unified_diff(const SavePlan& plan);

// Writes the plan's files atomically, all or none; refused if one has changed since planning.
// Returns the reasons for refusal; empty if everything was written.
std::vector<std::string> write_saved(const SavePlan& plan);

}  // namespace footfall::behaviors
