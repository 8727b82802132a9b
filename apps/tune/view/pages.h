// Pages of the full screen: what is different from the file, what a save would change, help.
#pragma once

#include <string_view>
#include <vector>

#include "apps/tune/model/model.h"
#include "apps/tune/view/picture.h"

namespace footfall::apps {

// The differences to the file, as a page.
std::vector<StyledLine> comparison(const TuneModel& model);
// Keys and what they do.
std::vector<StyledLine> help_lines();
// A unified diff in colours.
std::vector<StyledLine> diff_lines(std::string_view diff);

}  // namespace footfall::apps
