// Saves current values to the behavior's file, for the sub-command and the full screen.
#pragma once

#include <string>
#include <vector>

#include "apps/tune/model/model.h"
#include "behaviors/save/values.h"

namespace footfall::apps {

// The changes that saving parameters would make, or the reasons why it is impossible.
struct TuneSave {
  behaviors::SavePlan plan;
  std::string diff;                   // in the format of `diff -u`; empty if nothing changes
  std::vector<std::string> problems;  // as text; nothing is written unless empty
};

// `parameters`: indices into model.parameters; those with the file's value change nothing.
// `overlay` (if not empty): write to that file instead of the one that runs; if it exists, values
// are compared with what it results in. `into_base`: write each value where it is defined. Reads
// the behavior's file, which must be on this host.
TuneSave plan_tune_save(TuneModel& model, const std::vector<int>& parameters,
                        const std::string& overlay, bool into_base = false);
// Writes the changes and returns the written files, one a line; `problems` on failure.
std::vector<std::string> write_tune_save(const TuneSave& save, std::vector<std::string>& problems);

}  // namespace footfall::apps
