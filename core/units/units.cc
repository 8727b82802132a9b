// Physical dimensions and quantities with units; see units.h.
#include "core/units/units.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "core/units/unit_list.h"

namespace footfall::core {

namespace {

// A unit is numerator/denominator in SI: dividing keeps `16 ms` the same double as 0.016.
struct UnitDefinition {
  std::string_view name;
  double numerator;
  double denominator;
  Dimension dimension;
};

constexpr Dimension kPower{2, 1, -3};
constexpr std::array kUnits = {
    UnitDefinition{"s", 1, 1, kTime},
    UnitDefinition{"ms", 1, 1e3, kTime},
    UnitDefinition{"us", 1, 1e6, kTime},
    UnitDefinition{"\u00b5s", 1, 1e6, kTime},  // micro sign
    UnitDefinition{"\u03bcs", 1, 1e6, kTime},  // Greek mu
    UnitDefinition{"ns", 1, 1e9, kTime},
    UnitDefinition{"min", 60, 1, kTime},
    UnitDefinition{"h", 3600, 1, kTime},
    UnitDefinition{"m", 1, 1, kLength},
    UnitDefinition{"cm", 1, 1e2, kLength},
    UnitDefinition{"mm", 1, 1e3, kLength},
    UnitDefinition{"um", 1, 1e6, kLength},
    UnitDefinition{"\u00b5m", 1, 1e6, kLength},
    UnitDefinition{"\u03bcm", 1, 1e6, kLength},
    UnitDefinition{"km", 1e3, 1, kLength},
    UnitDefinition{"N", 1, 1, kForce},
    UnitDefinition{"mN", 1, 1e3, kForce},
    UnitDefinition{"kN", 1e3, 1, kForce},
    UnitDefinition{"Nm", 1, 1, kTorque},
    UnitDefinition{"mNm", 1, 1e3, kTorque},
    UnitDefinition{"kNm", 1e3, 1, kTorque},
    UnitDefinition{"Ns", 1, 1, kImpulse},
    UnitDefinition{"Nms", 1, 1, kAngularMomentum},
    UnitDefinition{"kg", 1, 1, kMass},
    UnitDefinition{"g", 1, 1e3, kMass},
    UnitDefinition{"rad", 1, 1, kNone},
    UnitDefinition{"mrad", 1, 1e3, kNone},
    UnitDefinition{"deg", std::numbers::pi, 180, kNone},
    UnitDefinition{"%", 1, 1e2, kNone},
    UnitDefinition{"Hz", 1, 1, kRate},
    UnitDefinition{"mHz", 1, 1e3, kRate},
    UnitDefinition{"kHz", 1e3, 1, kRate},
    UnitDefinition{"J", 1, 1, kTorque},
    UnitDefinition{"mJ", 1, 1e3, kTorque},
    UnitDefinition{"kJ", 1e3, 1, kTorque},
    UnitDefinition{"W", 1, 1, kPower},
    UnitDefinition{"kW", 1e3, 1, kPower},
};

const UnitDefinition* find_unit(std::string_view name) {
  for (const UnitDefinition& unit : kUnits) {
    if (unit.name == name) return &unit;
  }
  return nullptr;
}

// Letters, the bytes of the micro sign, and %.
bool is_unit_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '%' ||
         static_cast<unsigned char>(c) >= 0x80;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

struct Scale {
  double numerator = 1.0;
  double denominator = 1.0;
  Dimension dimension;
};

// Reads unit expressions: FACTOR {[" " | "*" | "/"] FACTOR}, FACTOR = NAME["^"["-"]DIGIT]; the
// first factor may be 1 when "/" follows. "/" divides by the next factor only.
class UnitParser {
 public:
  explicit UnitParser(std::string_view text) : text_(trimmed(text)) {}

  std::optional<Scale> parse() {
    if (text_.empty()) return std::nullopt;
    if (text_.front() == '1') {
      ++at_;
      skip_blanks();
      if (!at('/')) return std::nullopt;
    } else if (!factor(false)) {
      return std::nullopt;
    }
    while (at_ < text_.size()) {
      skip_blanks();
      const bool divide = at('/');
      if (divide || at('*')) {
        ++at_;
        skip_blanks();
      }
      if (!factor(divide)) return std::nullopt;
    }
    return scale_;
  }

 private:
  bool at(char c) const { return at_ < text_.size() && text_[at_] == c; }
  void skip_blanks() {
    while (at_ < text_.size() && is_blank(text_[at_])) ++at_;
  }

  bool factor(bool divide) {
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_unit_character(text_[at_])) ++at_;
    const UnitDefinition* unit = find_unit(text_.substr(begin, at_ - begin));
    if (unit == nullptr) return false;
    int exponent = 1;
    if (at('^') && !read_exponent(exponent)) return false;
    return apply(*unit, divide ? -exponent : exponent);
  }

  bool read_exponent(int& exponent) {
    ++at_;
    const bool negative = at('-');
    if (negative) ++at_;
    if (at_ >= text_.size() || !is_digit(text_[at_])) return false;
    exponent = text_[at_++] - '0';
    if (at_ < text_.size() && is_digit(text_[at_])) return false;  // no two-digit powers
    if (negative) exponent = -exponent;
    return true;
  }

  bool apply(const UnitDefinition& unit, int exponent) {
    constexpr int kLargestExponent = 12;
    const auto raised = [&](std::int8_t old, std::int8_t own) { return old + exponent * own; };
    const int m = raised(scale_.dimension.m, unit.dimension.m);
    const int kg = raised(scale_.dimension.kg, unit.dimension.kg);
    const int s = raised(scale_.dimension.s, unit.dimension.s);
    if (std::abs(m) > kLargestExponent || std::abs(kg) > kLargestExponent ||
        std::abs(s) > kLargestExponent) {
      return false;
    }
    scale_.dimension = {static_cast<std::int8_t>(m), static_cast<std::int8_t>(kg),
                        static_cast<std::int8_t>(s)};
    for (int i = 0; i < std::abs(exponent); ++i) {
      scale_.numerator *= exponent > 0 ? unit.numerator : unit.denominator;
      scale_.denominator *= exponent > 0 ? unit.denominator : unit.numerator;
    }
    return true;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  Scale scale_;
};

// Length of the decimal number at the beginning of `text`, 0 if there is none.
std::size_t number_length(std::string_view text) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < text.size() && is_digit(text[at])) ++at;
    return at - begin;
  };
  if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
  std::size_t count = digits();
  if (at < text.size() && text[at] == '.') {
    ++at;
    count += digits();
  }
  if (count == 0) return 0;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    const std::size_t mantissa_end = at;
    ++at;
    if (at < text.size() && (text[at] == '+' || text[at] == '-')) ++at;
    if (digits() == 0) at = mantissa_end;
  }
  return at;
}

std::string power(std::string_view unit, int exponent) {
  return exponent == 1 ? std::string(unit) : fmt::format("{}^{}", unit, exponent);
}

}  // namespace

std::optional<Quantity> parse_unit(std::string_view text) {
  const std::optional<Scale> scale = UnitParser(text).parse();
  if (!scale) return std::nullopt;
  const double factor = scale->numerator / scale->denominator;
  if (!std::isfinite(factor) || factor == 0.0) return std::nullopt;
  return Quantity{factor, scale->dimension, false};
}

std::optional<Quantity> parse_quantity(std::string_view text) {
  text = trimmed(text);
  const std::size_t length = number_length(text);
  if (length == 0) return std::nullopt;
  const std::size_t sign = text.front() == '+' ? 1 : 0;  // from_chars takes no plus sign
  Quantity quantity;
  const char* const end = text.data() + length;
  const auto [stop, error] = std::from_chars(text.data() + sign, end, quantity.value);
  if (error != std::errc() || stop != end) return std::nullopt;

  const std::string_view unit_text = text.substr(length);
  if (!trimmed(unit_text).empty()) {
    // "21/s" would read as a quotient of numbers; "2 1/s" is unambiguous.
    const bool separated = is_blank(unit_text.front());
    if (!separated && !is_unit_character(unit_text.front())) return std::nullopt;
    const std::optional<Scale> scale = UnitParser(unit_text).parse();
    if (!scale) return std::nullopt;
    quantity.value = quantity.value * scale->numerator / scale->denominator;
    quantity.dimension = scale->dimension;
    quantity.bare = false;
  }
  if (!std::isfinite(quantity.value)) return std::nullopt;
  return quantity;
}

std::vector<UnitInfo> all_units() {
  std::vector<UnitInfo> units;
  for (const UnitDefinition& unit : kUnits) {
    units.push_back({unit.name, unit.numerator / unit.denominator, unit.dimension});
  }
  return units;
}

std::string dimension_name(Dimension dimension) {
  if (dimension == kNone) return "a plain number";
  if (dimension == kTime) return "a time";
  if (dimension == kLength) return "a length";
  if (dimension == kMass) return "a mass";
  if (dimension == kForce) return "a force";
  if (dimension == kTorque) return "a torque";
  if (dimension == kVelocity) return "a velocity";
  if (dimension == kAcceleration) return "an acceleration";
  if (dimension == kRate) return "a rate (1/s)";
  if (dimension == kInertia) return "an inertia";
  if (dimension == kImpulse) return "an impulse";
  return "a value in " + unit_text(dimension);
}

std::string unit_text(Dimension dimension) {
  if (dimension == kNone) return "";
  if (dimension == kForce) return "N";
  if (dimension == kTorque) return "Nm";
  if (dimension == kImpulse) return "N s";
  if (dimension == kAngularMomentum) return "Nm s";
  if (dimension == kPower) return "W";
  if (dimension == Dimension{0, 1, -2}) return "N/m";
  if (dimension == Dimension{0, 1, -1}) return "N s/m";
  // Gains of cascaded torque loops: without the angle their numbers would not be recognized.
  if (dimension == Dimension{-2, -1, 1}) return "rad/s/Nm";
  if (dimension == Dimension{-2, -1, 0}) return "rad/s^2/Nm";

  std::string above;
  std::string below;
  const auto add = [&](std::string_view unit, int exponent) {
    if (exponent > 0) above += (above.empty() ? "" : " ") + power(unit, exponent);
    if (exponent < 0) below += "/" + power(unit, -exponent);
  };
  add("kg", dimension.kg);
  add("m", dimension.m);
  add("s", dimension.s);
  return (above.empty() ? "1" : above) + below;
}

}  // namespace footfall::core
