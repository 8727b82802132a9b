// Values that a command saves: shown, asked about, written.
#pragma once

#include <string>

#include "behaviors/save/values.h"

namespace footfall::apps {

// Prints the notes (stderr) and the diff of a plan that is not refused, asks on the terminal unless
// `yes`, writes unless `dry_run`. `name`: the file, for people. The exit code; throws InputError
// where nobody can be asked.
int show_and_write(const behaviors::SavePlan& plan, const std::string& name, bool dry_run,
                   bool yes);

}  // namespace footfall::apps
