// Texts of a diagram, wrapped and joined; shared by its writers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "behaviors/explain/diagram.h"

namespace footfall::behaviors {

// `text` in lines of at most `width` bytes, broken at blanks; a longer word has a line of its own.
std::vector<std::string> wrap(std::string_view text, std::size_t width);
// Every line of `lines`, wrapped.
std::vector<std::string> wrap_all(const std::vector<std::string>& lines, std::size_t width);
// What stands below a state's name: template, what is closed, control, actions; wrapped.
std::vector<std::string> details_of(const DiagramState& state, std::size_t width);
// Whether `state` lies properly inside `ancestor`.
bool is_inside(const Diagram& diagram, int state, int ancestor);

}  // namespace footfall::behaviors
