// Questions on the terminal; shows, confirms and writes changed values.
#pragma once

#include <string>

#include "behaviors/save/values.h"

namespace footfall::apps {

// Asks on the terminal: whether the answer is yes. Throws InputError if there is none to ask on.
bool confirmed(const char* question);

// Prints the notes (stderr) and the diff of a plan that is not refused, asks on the terminal unless
// `yes`, writes unless `dry_run`. `name`: the file name for messages. Returns the exit code; throws
// InputError if confirmation is impossible.
int show_and_write(const behaviors::SavePlan& plan, const std::string& name, bool dry_run,
                   bool yes);

}  // namespace footfall::apps
