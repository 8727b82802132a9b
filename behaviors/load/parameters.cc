// `parameters:` as slots of the flat value array.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language/language.h"
#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMaxComponents = 16;

// Reads the values of one parameter: a quantity or a list of them, all of one dimension.
bool read_values(LoadContext& context, const core::YamlNode& node, ParameterInfo& info,
                 std::vector<double>& values) {
  std::vector<const core::YamlNode*> items;
  if (node.is_sequence()) {
    for (const core::YamlNode& item : node.items) items.push_back(&item);
  } else {
    items.push_back(&node);
  }
  if (items.empty() || items.size() > kMaxComponents) {
    context.error(node.mark, "size",
                  fmt::format("expected 1 to {} values, got {}", kMaxComponents, items.size()));
    return false;
  }
  info.bare = true;
  for (const core::YamlNode* item : items) {
    const auto quantity = core::read_any_quantity(*item, context.diagnostics);
    if (!quantity) return false;
    if (!quantity->bare) {
      if (!info.bare && !(quantity->dimension == info.dimension)) {
        context.error(item->mark, "dimension",
                      fmt::format("expected {}, got '{}'", core::dimension_name(info.dimension),
                                  item->scalar));
        return false;
      }
      info.bare = false;
      info.dimension = quantity->dimension;
    }
    values.push_back(quantity->value);
  }
  info.size = static_cast<int>(values.size());
  return true;
}

void read_range(LoadContext& context, const core::YamlNode& map, ParameterInfo& info) {
  const core::YamlNode* node = map.find("range");
  if (node == nullptr) return;
  if (info.bare && node->is_sequence()) {  // only the range may have a unit
    for (const core::YamlNode& item : node->items) {
      const auto quantity = item.is_scalar() ? core::parse_quantity(item.scalar) : std::nullopt;
      if (quantity && !quantity->bare) {
        info.bare = false;
        info.dimension = quantity->dimension;
      }
    }
  }
  const auto range = core::read_range(*node, info.dimension, context.diagnostics);
  if (!range) return;
  if ((*range)[0] >= (*range)[1]) {
    context.error(node->mark, "range", "a range must not be empty");
    return;
  }
  info.min = (*range)[0];
  info.max = (*range)[1];
}

// `0.08 s to 0.4 s`.
std::string range_text(const ParameterInfo& info) {
  const std::string unit = core::unit_text(info.dimension);
  const std::string blank = unit.empty() ? "" : " ";
  return fmt::format("{:g}{}{} to {:g}{}{}", info.min, blank, unit, info.max, blank, unit);
}

void check_against_range(LoadContext& context, const core::YamlNode& value,
                         const ParameterInfo& info, const std::vector<double>& values) {
  if (!info.has_range()) return;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (values[k] >= info.min && values[k] <= info.max) continue;
    const core::YamlNode& place = value.is_sequence() ? value.items[k] : value;
    context.error(place.mark, "out-of-range",
                  fmt::format("'{}' is outside the range of '{}', {}", place.scalar, info.name,
                              range_text(info)));
  }
}

void load_parameter(LoadContext& context, const core::YamlEntry& entry) {
  if (!core::check_name(entry, context.diagnostics, "the name of a parameter")) return;
  static const core::YamlNode empty;
  const bool is_map = entry.value.is_map();
  const core::YamlNode& map = is_map ? entry.value : empty;
  if (is_map) core::check_keys(map, kParameterKeys, context.diagnostics);
  const core::YamlNode* value =
      is_map ? core::require_key(map, "value", context.diagnostics) : &entry.value;
  ParameterInfo info;
  info.name = entry.key;
  info.mark = entry.key_mark;
  info.slot = static_cast<int>(context.behavior.values.size());
  std::vector<double> values;
  const bool good = value != nullptr && read_values(context, *value, info, values);
  if (!good) values.assign(1, 0.0), info.size = 1, info.bare = true;
  read_range(context, map, info);
  if (good) check_against_range(context, *value, info, values);
  if (const auto* live = map.find("live")) {
    info.live = core::read_bool(*live, context.diagnostics).value_or(false);
    if (info.live && !info.has_range()) {
      context.error(live->mark, "live-range",
                    fmt::format("parameter '{}' is live and needs a range", info.name));
    }
  }
  if (const auto* doc = map.find("doc")) info.doc = doc->scalar;
  context.behavior.parameters.push_back(info);
  context.behavior.values.insert(context.behavior.values.end(), values.begin(), values.end());
}

}  // namespace

void load_parameters(LoadContext& context) {
  const core::YamlNode* section = context.section("parameters");
  if (section == nullptr ||
      !core::expect_map(*section, "parameters by name", context.diagnostics)) {
    return;
  }
  for (const core::YamlEntry& entry : section->entries) load_parameter(context, entry);
}

}  // namespace footfall::behaviors
