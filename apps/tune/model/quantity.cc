// Formats, parses and steps numbers with units; see quantity.h.
#include "apps/tune/model/quantity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/diagnostics/quantity_hint.h"
#include "core/text/look_alike.h"
#include "core/units/quantity_text.h"

namespace footfall::apps {
namespace {

DisplayUnit unit_of(const std::string& name) {
  const auto unit = core::parse_unit(name);
  return {name, unit ? unit->value : 1.0};
}

std::string with_unit(std::string number, const DisplayUnit& unit) {
  return unit.name.empty() ? number : std::move(number) + " " + unit.name;
}

// Negative zero and rounding residues are printed as 0.
std::string number_text(double number, int digits) {
  std::string text = fmt::format("{:.{}g}", number, digits);
  return text == "-0" ? "0" : text;
}

// The number in the unit that reads back to `value`; empty if no number does.
std::string exact_number(double value, const DisplayUnit& unit) {
  std::string text = core::quantity_text(value, with_unit("1", unit));
  const std::string tail = with_unit("", unit);
  if (!text.ends_with(tail)) return {};
  text.resize(text.size() - tail.size());
  return text;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && core::is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && core::is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string list_text(const std::vector<std::string>& numbers, const DisplayUnit& unit) {
  return with_unit(numbers.size() == 1 ? numbers[0] : fmt::format("[{}]", fmt::join(numbers, ", ")),
                   unit);
}

std::vector<std::string> split_at_commas(std::string_view text) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t comma = text.find(',');
    parts.emplace_back(trimmed(text.substr(0, comma)));
    if (comma == std::string_view::npos) return parts;
    text.remove_prefix(comma + 1);
  }
}

// The numbers between brackets, each followed by the common unit.
std::vector<std::string> items_of(std::string_view text, std::string& problem) {
  if (text.empty() || text.front() != '[') return split_at_commas(text);
  const std::size_t end = text.find(']');
  if (end == std::string_view::npos) {
    problem = fmt::format("expected ']' at the end of '{}'", text);
    return {};
  }
  std::vector<std::string> items = split_at_commas(text.substr(1, end - 1));
  const std::string unit(trimmed(text.substr(end + 1)));
  for (std::string& item : items) {
    if (!unit.empty()) item += " " + unit;
  }
  return items;
}

}  // namespace

DisplayUnit display_unit(core::Dimension dimension, double size) {
  size = std::abs(size);
  if (dimension == core::kTime && size < 1.0) return unit_of(size < 1e-3 && size > 0 ? "us" : "ms");
  if (dimension == core::kLength && size < 0.5) return unit_of(size < 0.01 ? "mm" : "cm");
  return {core::unit_text(dimension), 1.0};
}

std::string shown_value(double value, const DisplayUnit& unit, int digits) {
  return with_unit(number_text(value / unit.factor, digits), unit);
}

std::string shown_values(std::span<const double> values, const DisplayUnit& unit, int digits) {
  std::vector<std::string> numbers;
  for (const double value : values) numbers.push_back(number_text(value / unit.factor, digits));
  return list_text(numbers, unit);
}

std::string exact_values(std::span<const double> values, const DisplayUnit& unit) {
  std::vector<std::string> numbers;
  for (const double value : values) {
    numbers.push_back(exact_number(value, unit));
    if (!numbers.back().empty()) continue;
    numbers.clear();
    for (const double each : values) numbers.push_back(fmt::format("{}", each));
    return list_text(numbers, {});
  }
  return list_text(numbers, unit);
}

ReadValues read_values(std::string_view text, core::Dimension dimension, int count,
                       bool broadcast) {
  ReadValues read;
  text = trimmed(text);
  // For one value `0,15s` would be two.
  if (count == 1 && core::has_decimal_comma(text)) {
    read.problem = fmt::format("expected {}, got '{}'{}", core::dimension_name(dimension), text,
                               core::quantity_hint(text, dimension));
    return read;
  }
  for (const std::string& item : items_of(text, read.problem)) {
    const auto quantity = core::parse_quantity(item);
    if (!quantity || !(quantity->bare || quantity->dimension == dimension)) {
      read.problem = fmt::format("expected {}, got '{}'{}{}", core::dimension_name(dimension), item,
                                 core::quantity_hint(item, dimension), core::look_alike_hint(item));
      return read;
    }
    read.values.push_back(quantity->value);
  }
  if (!read.problem.empty()) return read;
  const auto wanted = static_cast<std::size_t>(count);
  if (read.values.size() == 1 && wanted > 1 && !broadcast) {
    read.problem = fmt::format("expected {} values, got one", count);
    return read;
  }
  if (read.values.size() == 1) read.values.resize(wanted, read.values[0]);
  if (read.values.size() != wanted) {
    read.problem = fmt::format("expected {} value{}, got {}", count, count == 1 ? "" : "s",
                               read.values.size());
  }
  return read;
}

std::optional<double> read_duration(std::string_view text) {
  const ReadValues read = read_values(text, core::kTime, 1);
  if (!read.problem.empty() || read.values[0] < 0.0) return std::nullopt;
  return read.values[0];
}

double round_step(double size) {
  // Tolerance 1e-9, because log10 of a power of ten may be slightly below the integer.
  const double power = std::floor(std::log10(size) + 1e-9);
  const double part = size / std::pow(10.0, power) * (1.0 + 1e-9);
  return (part >= 5.0 ? 5.0 : part >= 2.0 ? 2.0 : 1.0) * std::pow(10.0, power);
}

double default_step(double nominal, double min, double max, double first, const DisplayUnit& unit) {
  constexpr double kPartOfValue = 0.05, kPartOfRange = 0.05;
  double size = std::abs(nominal) * kPartOfValue;
  const double of_range = (max - min) * kPartOfRange;
  if (size == 0.0) size = first;
  if (of_range > 0.0) size = std::min(size, of_range);
  return round_step(size / unit.factor);
}

double stepped(double value, double step, double steps, const DisplayUnit& unit) {
  constexpr int kDigits = 12;  // more than users type, fewer than rounding errors
  const std::string number = fmt::format("{:.{}g}", value / unit.factor + steps * step, kDigits);
  const auto quantity = core::parse_quantity(with_unit(number, unit));
  return quantity ? quantity->value : value;
}

}  // namespace footfall::apps
