// What a text that is no quantity was meant to be.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/units.h"

namespace footfall::core {

// The quantity near a text that is none: ": a decimal point, not a comma: '3.5 cm'", " (did you
// mean '3 cm'?)" for units in other case (`CM`), other signs (`°`, `m/s²`), words (`sec`) and near
// names; "" if nothing is near. With `expected` only what has this dimension is suggested.
std::string quantity_hint(std::string_view text, std::optional<Dimension> expected = std::nullopt);

// Whether the text is a number with a decimal comma, perhaps with a unit: `3,5 cm`.
bool has_decimal_comma(std::string_view text);

// NAME=VALUE arguments that a shell has split at blanks (`lift_time=150 ms` is two): what to type
// for the one at `index`, which has no '=', and those around it. Empty if it belongs to none before
// it; `rest` is set if an argument before it has been told so already.
std::string split_argument_hint(const std::vector<std::string>& arguments, std::size_t index,
                                bool& rest);

}  // namespace footfall::core
