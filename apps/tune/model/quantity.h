// Formats, parses and steps numbers with units: `150 ms`, `[220, 237, 400] 1/s^2`.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/units/units.h"

namespace footfall::apps {

// Display unit of one parameter.
struct DisplayUnit {
  std::string name;     // `ms`; empty: none
  double factor = 1.0;  // SI value of one unit
};

// A suitable unit for a number of this size (SI): `ms` for 0.15 s, `cm` for 0.3 m.
DisplayUnit display_unit(core::Dimension dimension, double size);
// `150 ms`, with at most this many significant digits.
std::string shown_value(double value, const DisplayUnit& unit, int digits = 6);
// `150 ms`, `[220, 237, 400] 1/s^2`.
std::string shown_values(std::span<const double> values, const DisplayUnit& unit, int digits = 6);
// The shortest such text that reads back to the same bits; in SI if the display unit cannot do
// that.
std::string exact_values(std::span<const double> values, const DisplayUnit& unit);

// Parsed numbers, or the problem of the text.
struct ReadValues {
  std::vector<double> values;  // SI
  std::string problem;         // empty if valid
};
// `150 ms`, `0.15`, `[1 m, 0.5 m]`, `220, 237, 400`, `[1, 2] cm`: bare numbers are SI; a single
// number is used for all of `count` only with `broadcast`.
ReadValues read_values(std::string_view text, core::Dimension dimension, int count,
                       bool broadcast = true);
// A duration such as `500ms`, 0 or more; nullopt if malformed.
std::optional<double> read_duration(std::string_view text);

// The largest of 1, 2, 5 times a power of ten that is at most `size` (> 0).
double round_step(double size);
// The step, in the display unit, for a value that is `nominal` in its file with limits min to max
// (SI; equal: unlimited): about a twentieth of the value, or of the range if that is less. For zero
// values at most `first` (SI).
double default_step(double nominal, double min, double max, double first, const DisplayUnit& unit);
// The value (SI) after `steps` steps, rounded to a decimal number in the display unit.
double stepped(double value, double step, double steps, const DisplayUnit& unit);

}  // namespace footfall::apps
