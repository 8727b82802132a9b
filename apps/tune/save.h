// Saves current values to the behavior's file, for the sub-command and the full screen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"
#include "apps/tune/saved_values.h"
#include "behaviors/save/values.h"

namespace footfall::apps {

// The changes that saving parameters would make, or the reasons why it is impossible.
struct TuneSave {
  behaviors::SavePlan plan;
  std::string diff;                   // in the format of `diff -u`; empty if nothing changes
  std::vector<std::string> problems;  // as text; nothing is written unless empty
  // To be remembered once it is written; nullopt: it goes to another file than the one that runs.
  std::optional<KnownValues> known;
};

// `parameters`: indices into model.parameters; those with the file's value change nothing.
// `overlay` (if not empty): write to that file instead of the one that runs; if it exists, values
// are compared with what it results in. `into_base`: write each value where it is defined. Reads
// the behavior's file, which must be on this host; refuses to overwrite values that were edited
// there since the run began. Call read_file_values() before.
TuneSave plan_tune_save(TuneModel& model, const std::vector<int>& parameters,
                        const std::string& overlay, bool into_base = false);
// Writes the changes, remembers them and returns the written files, one a line; `problems` on
// failure.
std::vector<std::string> write_tune_save(const TuneModel& model, const TuneSave& save,
                                         std::vector<std::string>& problems);

}  // namespace footfall::apps
