// A number as the quantity in a file that reads back to it, bit for bit.
#pragma once

#include <string>
#include <string_view>

namespace footfall::core {

// `value` (SI, finite) in the way of `like`, a quantity as somebody wrote it: the shortest number
// in its unit, with its blanks, that parse_quantity() reads as the same double. Where no number in
// that unit does (a double times its factor misses some values): in SI units, and bare if `like`
// is. A `like` that is no quantity counts as bare.
std::string quantity_text(double value, std::string_view like);

}  // namespace footfall::core
