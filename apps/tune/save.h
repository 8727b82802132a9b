// Values in force back into the behavior's file, for the sub-command and the full screen.
#pragma once

#include <string>
#include <vector>

#include "apps/tune/model/model.h"
#include "behaviors/save/values.h"

namespace footfall::apps {

// What saving these parameters would write, or why it cannot.
struct TuneSave {
  behaviors::SavePlan plan;
  std::string diff;                   // as `diff -u` shows it; empty: nothing changes
  std::vector<std::string> problems;  // for people; not empty: nothing can be written
};

// `parameters`: indices into model.parameters; those that have the file's value already change
// nothing. `overlay` (not empty): into that file instead of where the values come from. Reads the
// behavior's file: it must be on this host.
TuneSave plan_tune_save(TuneModel& model, const std::vector<int>& parameters,
                        const std::string& overlay);
// Writes it and says where, one file a line; `problems` if it cannot be.
std::vector<std::string> write_tune_save(const TuneSave& save, std::vector<std::string>& problems);

}  // namespace footfall::apps
