// Reads numbers with units and lists of them; see value_reader.h.
#include <fmt/format.h>

#include <cmath>

#include "core/diagnostics/quantity_hint.h"
#include "core/yaml/flow_traps.h"
#include "core/yaml/value_reader.h"

namespace footfall::core {

namespace {

std::string name_of(Dimension dimension, std::string_view what) {
  return what.empty() ? dimension_name(dimension) : std::string(what);
}

// The quantity in a scalar. Quotes are ignored, because numbers with a leading `*`, `%` or `+` must
// be quoted in YAML.
std::optional<Quantity> quantity_of(const YamlNode& node) {
  return node.is_scalar() ? parse_quantity(node.scalar) : std::nullopt;
}

// "expected WHAT, got ..." with the quantity that was meant.
void report_quantity(const YamlNode& node, std::string_view what, std::optional<Dimension> expected,
                     Diagnostics& diagnostics) {
  const std::string hint = node.is_scalar() ? quantity_hint(node.scalar, expected) : std::string();
  diagnostics.error(node.mark, "expected",
                    fmt::format("expected {}, got {}{}", what, describe(node), hint));
}

}  // namespace

std::optional<double> read_quantity(const YamlNode& node, Dimension expected,
                                    Diagnostics& diagnostics, std::string_view what) {
  const std::optional<Quantity> quantity = quantity_of(node);
  if (quantity && (quantity->bare || quantity->dimension == expected)) return quantity->value;
  report_quantity(node, name_of(expected, what), expected, diagnostics);
  return std::nullopt;
}

bool read_quantity(const YamlNode& map, std::string_view key, Dimension expected, double& out,
                   Diagnostics& diagnostics, std::string_view what) {
  const YamlNode* const node = map.find(key);
  if (node == nullptr) return false;
  const std::optional<double> value = read_quantity(*node, expected, diagnostics, what);
  if (value) out = *value;
  return value.has_value();
}

std::optional<Quantity> read_any_quantity(const YamlNode& node, Diagnostics& diagnostics) {
  const std::optional<Quantity> quantity = quantity_of(node);
  if (!quantity) {
    report_quantity(node, "a number with or without a unit", std::nullopt, diagnostics);
  }
  return quantity;
}

std::optional<double> read_bounded(const YamlNode& node, Dimension expected, double minimum,
                                   double maximum, Diagnostics& diagnostics,
                                   std::string_view what) {
  const std::optional<double> value = read_quantity(node, expected, diagnostics, what);
  if (!value) return std::nullopt;
  if (*value >= minimum && *value <= maximum) return value;
  const std::string unit = expected == kNone ? "" : " " + unit_text(expected);
  const std::string bounds = std::isinf(maximum)
                                 ? fmt::format("at least {:.6g}{}", minimum, unit)
                                 : fmt::format("{:.6g} to {:.6g}{}", minimum, maximum, unit);
  diagnostics.error(
      node.mark, "out-of-range",
      fmt::format("expected {}, {}, got {}", name_of(expected, what), bounds, describe(node)));
  return std::nullopt;
}

std::optional<std::int64_t> read_millihertz(const YamlNode& node, Diagnostics& diagnostics) {
  constexpr double kFastest = 1e6;  // Hz, far above any servo rate
  const std::optional<double> hertz =
      read_bounded(node, kRate, 1e-3, kFastest, diagnostics, "a rate in Hz");
  if (!hertz) return std::nullopt;
  const double exact = *hertz * 1e3;
  const double rounded = std::round(exact);
  // An exact number of millihertz differs by rounding only, which is far below 1e-9.
  if (std::abs(exact - rounded) > 1e-9 * rounded) {
    diagnostics.error(node.mark, "rate",
                      fmt::format("expected a rate in whole millihertz, got {}", describe(node)));
    return std::nullopt;
  }
  return static_cast<std::int64_t>(rounded);
}

std::optional<std::array<double, 2>> read_pair(const YamlNode& node, Dimension expected,
                                               Diagnostics& diagnostics, std::string_view what) {
  if (!node.is_sequence() || node.items.size() != 2) {
    const std::string got =
        node.is_sequence() ? fmt::format("{} values", node.items.size()) : describe(node);
    diagnostics.error(node.mark, "expected",
                      fmt::format("expected a pair [{0}, {0}], got {1}{2}", name_of(expected, what),
                                  got, comma_hint(node)));
    return std::nullopt;
  }
  const std::optional<double> first = read_quantity(node.items[0], expected, diagnostics, what);
  const std::optional<double> second = read_quantity(node.items[1], expected, diagnostics, what);
  if (!first || !second) return std::nullopt;
  return std::array<double, 2>{*first, *second};
}

std::optional<std::array<double, 2>> read_range(const YamlNode& node, Dimension expected,
                                                Diagnostics& diagnostics, std::string_view what) {
  const auto pair = read_pair(node, expected, diagnostics, what);
  if (pair && (*pair)[0] > (*pair)[1]) {
    diagnostics.error(node.mark, "range",
                      fmt::format("expected [minimum, maximum], got {} before {}",
                                  describe(node.items[0]), describe(node.items[1])));
    return std::nullopt;
  }
  return pair;
}

std::optional<std::vector<double>> read_vector(const YamlNode& node, Dimension expected,
                                               const std::vector<std::string>& axes,
                                               Diagnostics& diagnostics, double fallback,
                                               std::string_view what) {
  std::vector<double> values(axes.size(), fallback);
  bool good = true;
  const auto take = [&](std::size_t axis, const YamlNode& value) {
    const std::optional<double> number = read_quantity(value, expected, diagnostics, what);
    good = good && number;
    if (number) values[axis] = *number;
  };
  if (node.is_sequence() && node.items.size() == axes.size()) {
    for (std::size_t i = 0; i < axes.size(); ++i) take(i, node.items[i]);
  } else if (node.is_sequence()) {
    diagnostics.error(
        node.mark, "size",
        fmt::format("expected {} values ({}), got {}{}", axes.size(), fmt::join(axes, ", "),
                    node.items.size(), node.items.size() > axes.size() ? comma_hint(node) : ""));
    return std::nullopt;
  } else if (node.is_map()) {
    const int errors_before = diagnostics.error_count();
    if (node.entries.empty()) {
      diagnostics.error(
          node.mark, "empty-value",
          fmt::format("expected a value for at least one of {}", fmt::join(axes, ", ")));
    }
    check_keys(node, axes, diagnostics);
    good = diagnostics.error_count() == errors_before;
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (const YamlNode* const value = node.find(axes[i])) take(i, *value);
    }
  } else {
    const std::optional<double> number = read_quantity(node, expected, diagnostics, what);
    if (!number) return std::nullopt;
    values.assign(axes.size(), *number);
  }
  return good ? std::optional(values) : std::nullopt;
}

std::optional<std::array<double, 3>> read_vector3(const YamlNode& node, Dimension expected,
                                                  Diagnostics& diagnostics, std::string_view what) {
  const auto values = read_vector(node, expected, {"x", "y", "z"}, diagnostics, 0.0, what);
  if (!values) return std::nullopt;
  return std::array<double, 3>{(*values)[0], (*values)[1], (*values)[2]};
}

}  // namespace footfall::core
