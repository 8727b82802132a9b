// The values that a run's files are known to have: those at its start, then those of the user's
// saves. Any other value in them is somebody's edit, which a save must not overwrite. The saves of
// this user are remembered in a file beside the default key, because each command is a process.
#pragma once

#include <vector>

#include "apps/tune/model/model.h"

namespace footfall::apps {

struct KnownValues {
  std::vector<double> values;  // SI, by slot, as TuneModel::file_values
  // They are of the files alone. Otherwise they are the run's first values, which are those of
  // --set where that was given.
  bool of_files = false;
};

KnownValues known_values(const TuneModel& model);
// Whether the files' value of a parameter, as last read, is neither the run's nor a save's.
bool was_edited(const TuneModel& model, const KnownValues& known, const TuneParameter& parameter);
// `known` after a save of `saved` (indices into model.parameters): their targets, and what the
// files have where nobody edited them.
KnownValues after_save(const TuneModel& model, const KnownValues& known,
                       const std::vector<int>& saved);
// Remembers them for this run. Without a place for them nothing is remembered: the next save is
// then refused rather than wrong.
void remember(const TuneModel& model, const KnownValues& known);

}  // namespace footfall::apps
