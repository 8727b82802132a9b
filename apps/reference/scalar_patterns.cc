// Regular expressions for values; see scalar_patterns.h.
#include "apps/reference/scalar_patterns.h"

#include <fmt/format.h>

#include <vector>

#include "core/units/unit_list.h"

namespace footfall::apps {
namespace {

constexpr std::string_view kNumber = R"([+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?)";
constexpr std::string_view kExpression = "=.*";
// A single signal: a dotted name, or one of those without a dot (checked by a language test).
constexpr std::string_view kSignal =
    R"([A-Za-z_]\w*(\.\w+)+|entry|t|time|state|steps|faults|true|false)";

std::string any_of(const std::vector<std::string_view>& names) {
  std::string out;
  for (const std::string_view name : names) out += (out.empty() ? "" : "|") + std::string(name);
  return "(" + out + ")";
}

std::string units(const core::Dimension* dimension) {
  std::vector<std::string_view> names;
  for (const core::UnitInfo& unit : core::all_units()) {
    if (dimension == nullptr || unit.dimension == *dimension) names.push_back(unit.name);
  }
  return names.empty() ? "" : any_of(names);
}

// `kg m^2`, `1/s^2`, `Nm/rad`: several units, or a power. A regular expression cannot check their
// dimension.
std::string compound_unit() {
  const std::string unit = units(nullptr) + R"((\^-?\d)?)";
  return fmt::format(R"((1\s*/\s*{0}|{1}\^-?\d|{0}\s*[*/ ]\s*{0})(\s*[*/ ]\s*{0})*)", unit,
                     units(nullptr));
}

// Dimensions written with a single unit.
bool is_simple(core::Dimension dimension) {
  for (const core::Dimension simple : {core::kNone, core::kTime, core::kLength, core::kMass}) {
    if (dimension == simple) return true;
  }
  return false;
}

std::string quantity_pattern(const core::ValueSpec& value) {
  const bool any = value.kind == core::ValueKind::any_quantity;
  std::string unit = units(any ? nullptr : &value.dimension);
  if (any || !is_simple(value.dimension)) {
    unit = unit.empty() ? compound_unit() : fmt::format("({}|{})", unit, compound_unit());
  }
  return fmt::format(R"(\s*{}(\s*{})?\s*)", kNumber, unit);
}

}  // namespace

std::string substituted_pattern() { return R"(off|.*\$[A-Za-z_].*)"; }

std::string text_pattern(const core::ValueSpec& value) {
  std::string pattern;
  switch (value.kind) {
    case core::ValueKind::quantity:
    case core::ValueKind::any_quantity:
      pattern = quantity_pattern(value);
      break;
    case core::ValueKind::choice:
      for (const core::WordSpec& word : value.words) {
        pattern += (pattern.empty() ? "" : "|") + std::string(word.word);
      }
      break;
    case core::ValueKind::boolean:
    case core::ValueKind::integer:
      pattern = substituted_pattern();
      break;
    default:
      return "";
  }
  if (value.expression) pattern += fmt::format("|{}|{}", kExpression, kSignal);
  return pattern;
}

}  // namespace footfall::apps
