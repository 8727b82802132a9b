// Wraps and joins the texts of a diagram; shared by its writers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "behaviors/explain/diagram.h"

namespace footfall::behaviors {

// Breaks `text` at blanks into lines of at most `width` bytes; a longer word gets its own line.
std::vector<std::string> wrap(std::string_view text, std::size_t width);
// Wraps every line of `lines`.
std::vector<std::string> wrap_all(const std::vector<std::string>& lines, std::size_t width);
// Lines below a state's name: template, number of hidden states, control, actions; wrapped.
std::vector<std::string> details_of(const DiagramState& state, std::size_t width);
// Whether `state` lies properly inside `ancestor`.
bool is_inside(const Diagram& diagram, int state, int ancestor);

}  // namespace footfall::behaviors
