// Formats a number as a quantity that reads back to the same bits.
#pragma once

#include <string>
#include <string_view>

namespace footfall::core {

// Formats `value` (SI, finite) in the style of the quantity `like`: the shortest number in the same
// unit and with the same blanks that parse_quantity() reads as the same double. If no number in
// that unit does (some doubles are not reached by a product with the unit's factor), SI units are
// used, or a bare number if `like` is bare. A `like` that is not a quantity counts as bare.
std::string quantity_text(double value, std::string_view like);

}  // namespace footfall::core
