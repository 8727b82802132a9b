// Values of a running behavior back into its YAML: planned and checked in memory first, then shown,
// then written. Load-time tools only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/loader.h"
#include "core/diagnostics/diagnostics.h"
#include "core/text/file_change.h"

namespace footfall::behaviors {

// One place that changes, for people.
struct SavedPlace {
  std::string name;                // parameter or gain
  std::string file;                // where its value is written
  int line = 0, column = 0;        // of the old text; 0: there was none, the value is new there
  std::string old_text, new_text;  // as written: `145 ms`
};

// What would be written. `refusals` not empty: nothing will be.
struct SavePlan {
  std::vector<core::FileChange> files;  // that change; none: every value is the file's own already
  std::vector<SavedPlace> places;
  std::vector<std::string> refusals;  // `file:line:column: NAME: reason`, one for each value
  std::vector<std::string> notes;     // what the person should know before saying yes

  bool refused() const { return !refusals.empty(); }
};

// Plans to write `values` into the file at `path`, each where it came from: in that file or in one
// of its bases. With `overlay` (not empty) into that file instead: a new one gets `base: PATH` and
// only what differs; one that is there must have the behavior among its bases, or be it, and is
// edited in place. Values that the file has already change nothing.
//
// options.set is not applied: what `--set` gave comes from no file and is written only if it is
// among `values`. Refused, with the reason: unknown names, variables, values out of range or given
// by an expression, texts that several values share and that would not all agree. Nothing is
// planned that has not been loaded, from memory, to exactly these values bit for bit, with every
// other value of the file (or overlay) as before. Problems of the files go to `diagnostics`; the
// plan then is refused too.
SavePlan plan_save(const std::string& path, const LoadOptions& options,
                   const std::vector<NamedValue>& values, const std::string& overlay,
                   core::Diagnostics& diagnostics);

// The plan as `diff -u` shows it, file by file.
std::string unified_diff(const SavePlan& plan);

// Writes the plan's files, all or none, atomically; refused if one has changed since it was
// planned. Returns the reasons against it; none: it is done.
std::vector<std::string> write_saved(const SavePlan& plan);

}  // namespace footfall::behaviors
