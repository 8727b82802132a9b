// Warns about seeds that change nothing: runs that are all the same run prove no more than one.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "lab/suite/suite.h"
#include "lab/sweep/plan/sweep.h"

namespace footfall::apps {

// The scenarios of `footfall test`, with the seeds that it runs.
void warn_alike_seeds(const std::vector<lab::SuiteScenario>& scenarios,
                      core::Diagnostics& diagnostics);
// A checked sweep; `worlds`: path of each of its worlds.
void warn_alike_seeds(const lab::SweepDescription& sweep, const std::vector<std::string>& worlds,
                      core::Diagnostics& diagnostics);

}  // namespace footfall::apps
