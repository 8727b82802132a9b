// Pages of the full screen: differences from the file, changes that a save would make, help.
#pragma once

#include <string_view>
#include <vector>

#include "apps/tune/model/model.h"
#include "apps/tune/view/picture.h"

namespace footfall::apps {

// The differences from the file, as a page.
std::vector<StyledLine> comparison(const TuneModel& model);
// Keys and their functions.
std::vector<StyledLine> help_lines();
// A unified diff in colours.
std::vector<StyledLine> diff_lines(std::string_view diff);

}  // namespace footfall::apps
