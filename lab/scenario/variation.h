// `variation:` of a scenario, over that of its world. Load time only.
#pragma once

#include <string>
#include <vector>

#include "core/diagnostics/diagnostics.h"
#include "lab/scenario/description.h"
#include "model/variation/variation.h"

namespace footfall::lab {

// What a seed draws: the world's `variation:` with the scenario's over it.
model::Variation variation_over(const ScenarioDescription& scenario, const model::Variation& world);

// Warns of a push that the world draws and that no run of the scenario can reach. The loader has
// told it of the scenario's own.
void warn_late_push(const ScenarioDescription& scenario, const model::Variation& drawn,
                    core::Diagnostics& diagnostics);

// Whether some script uses random numbers.
bool draws_random(const std::vector<behaviors::ScriptFile>& scripts);
// Whether all seeds are the same run: neither the draws nor the scripts depend on the seed.
bool seeds_alike(const ScenarioDescription& scenario, const model::Variation& drawn);
std::string alike_seeds_text(std::size_t seeds, const std::string& world);
// Warns of several seeds that are alike.
void warn_alike_seeds(const ScenarioDescription& scenario, const model::Variation& drawn,
                      core::Diagnostics& diagnostics);

// Whether the scenario has its own draw of a quantity, so that the world's says nothing. `path`: of
// the world's value below `variation`, such as {friction, range}.
bool draws_itself(const ScenarioDescription& scenario, const std::vector<std::string>& path);

}  // namespace footfall::lab
