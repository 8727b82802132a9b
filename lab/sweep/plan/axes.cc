// Lists, grids and random samples as axis values; see axes.h.
#include "lab/sweep/plan/axes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/yaml/value_reader.h"
#include "core/yaml_text/write.h"
#include "lab/sweep/plan/keys.h"
#include "lab/sweep/plan/sample.h"

namespace footfall::lab {
namespace {

using core::Diagnostics;
using core::YamlNode;

// A number and its unit as written: {150, "ms"}.
struct Written {
  double number = 0.0;
  std::string unit;
};

std::optional<Written> written(const std::string& text) {
  const auto quantity = core::parse_quantity(text);
  if (!quantity) return std::nullopt;
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  std::string unit = end;
  unit.erase(0, unit.find_first_not_of(" \t"));
  return Written{number, std::move(unit)};
}

// The two ends of a range, of one dimension, in the unit that both are written with, else SI.
struct Ends {
  double a = 0.0, b = 0.0;
  std::string unit;
};

std::optional<Ends> read_ends(const YamlNode& a, const YamlNode& b, Diagnostics& diagnostics) {
  const auto first = core::read_any_quantity(a, diagnostics);
  const auto second = core::read_any_quantity(b, diagnostics);
  if (!first || !second) return std::nullopt;
  if (!first->bare && !second->bare && !(first->dimension == second->dimension)) {
    diagnostics.error(b.mark, "dimension",
                      fmt::format("expected {}, got {}", core::dimension_name(first->dimension),
                                  core::describe(b)));
    return std::nullopt;
  }
  const auto wa = written(a.scalar), wb = written(b.scalar);
  if (wa && wb && wa->unit == wb->unit) return Ends{wa->number, wb->number, wa->unit};
  if (first->bare != second->bare) {
    diagnostics.error(b.mark, "dimension",
                      fmt::format("one of {} and {} has a unit, the other has none",
                                  core::describe(a), core::describe(b)));
    return std::nullopt;
  }
  return Ends{first->value, second->value, core::unit_text(first->dimension)};
}

std::optional<Ends> read_pair_of(const YamlNode& node, Diagnostics& diagnostics) {
  if (!node.is_sequence() || node.items.size() != 2) {
    core::report_expected(node, "a list of two values", diagnostics);
    return std::nullopt;
  }
  return read_ends(node.items[0], node.items[1], diagnostics);
}

// A computed value, rounded to nine digits: far finer than any robot, and hides rounding errors.
SweepValue computed_value(double number, const std::string& unit, core::Mark mark) {
  const std::string digits = fmt::format("{:.9g}", number);
  return {unit.empty() ? digits : digits + " " + unit, std::stod(digits), mark};
}

// Sets the unit shared by all values, so that their numbers are comparable.
void settle_units(SweepAxis& axis) {
  bool first = true;
  for (const SweepValue& value : axis.values) {
    const auto w = written(value.text);
    if (!w) continue;
    if (first) axis.unit = w->unit;
    first = false;
    if (w->unit == axis.unit) continue;
    axis.unit.clear();  // different units, such as 150 ms and 0.2 s: SI
    for (SweepValue& other : axis.values) {
      if (const auto q = core::parse_quantity(other.text)) {
        other.number = q->value;
        axis.unit = core::unit_text(q->dimension);
      }
    }
    return;
  }
}

bool is_value(const YamlNode& node) {
  if (node.is_scalar()) return true;
  return node.is_sequence() && !node.items.empty() &&
         std::ranges::all_of(node.items, &YamlNode::is_scalar);
}

std::optional<SweepAxis> read_list(const core::YamlEntry& entry, Diagnostics& diagnostics) {
  SweepAxis axis{entry.key, entry.key_mark, {}, "", true};
  if (!core::expect_sequence(entry.value, "a list of values", diagnostics)) return std::nullopt;
  if (entry.value.items.empty()) {
    diagnostics.error(entry.value.mark, "empty-value", "no values: nothing would be run");
    return std::nullopt;
  }
  for (const YamlNode& item : entry.value.items) {
    if (!is_value(item)) {
      core::report_expected(item, "a value, or a list of numbers for a vector", diagnostics);
      return std::nullopt;
    }
    SweepValue value{core::to_flow_yaml(item), std::nullopt, item.mark};
    if (item.is_scalar()) {
      if (const auto w = written(item.scalar)) value.number = w->number;
    }
    axis.values.push_back(std::move(value));
  }
  settle_units(axis);
  return axis;
}

// Each value of a list makes runs of its own.
void refuse_equal_values(const SweepAxis& axis, Diagnostics& diagnostics) {
  for (std::size_t k = 0; k < axis.values.size(); ++k) {
    const SweepValue& value = axis.values[k];
    const auto before = axis.values.begin() + static_cast<std::ptrdiff_t>(k);
    if (std::ranges::find(axis.values.begin(), before, value.text, &SweepValue::text) == before) {
      continue;
    }
    diagnostics.error(value.mark, "duplicate", fmt::format("the value {} twice", value.text));
  }
}

// Of zipped lists the values that stand side by side make runs.
void refuse_equal_rows(const SweepDescription& sweep, const SweepGroup& group,
                       Diagnostics& diagnostics) {
  std::map<std::vector<std::string>, std::size_t> rows;
  for (std::size_t k = 0; k < group.size; ++k) {
    std::vector<std::string> row;
    for (const std::size_t axis : group.axes) row.push_back(sweep.axes[axis].values[k].text);
    const auto [before, is_new] = rows.emplace(std::move(row), k);
    if (is_new) continue;
    diagnostics.error(
        sweep.axes[group.axes.front()].values[k].mark, "duplicate",
        fmt::format("row {} of the zipped lists is row {} once more", k + 1, before->second + 1));
  }
}

std::optional<SweepAxis> read_grid(const core::YamlEntry& entry, Diagnostics& diagnostics) {
  const YamlNode& map = entry.value;
  core::check_keys(map, kSweepGridKeys, diagnostics);
  const YamlNode* from = core::require_key(map, "from", diagnostics);
  const YamlNode* to = core::require_key(map, "to", diagnostics);
  const YamlNode* count_node = core::require_key(map, "count", diagnostics);
  if (from == nullptr || to == nullptr || count_node == nullptr) return std::nullopt;
  const auto count = core::read_integer(*count_node, 2, 100'000, diagnostics);
  const auto ends = read_ends(*from, *to, diagnostics);
  bool log = false;
  if (const YamlNode* node = map.find("log")) {
    log = core::read_bool(*node, diagnostics).value_or(false);
  }
  if (!count || !ends) return std::nullopt;
  if (log && !(ends->a > 0.0 && ends->b > 0.0)) {
    diagnostics.error(map.mark, "range", "equal factors need ends above 0");
    return std::nullopt;
  }
  if (ends->a == ends->b) {
    diagnostics.error(to->mark, "range", "`from` and `to` are the same");
    return std::nullopt;
  }
  SweepAxis axis{entry.key, entry.key_mark, {}, ends->unit, false};
  for (std::int64_t k = 0; k < *count; ++k) {
    const double part = static_cast<double>(k) / static_cast<double>(*count - 1);
    const double number =
        log ? ends->a * std::pow(ends->b / ends->a, part) : ends->a + part * (ends->b - ends->a);
    axis.values.push_back(computed_value(number, ends->unit, map.mark));
  }
  return axis;
}

std::optional<DistributionSpec> read_distribution(const YamlNode& map, std::string& unit,
                                                  Diagnostics& diagnostics) {
  if (!core::expect_map(map, "a distribution such as {uniform: [1, 2]}", diagnostics)) {
    return std::nullopt;
  }
  core::check_keys(map, kSweepDistributionKeys, diagnostics);
  constexpr std::array<const char*, 3> kKinds = {"uniform", "log_uniform", "normal"};
  const YamlNode* node = nullptr;
  DistributionSpec d;
  for (std::size_t k = 0; k < kKinds.size(); ++k) {
    const YamlNode* found = map.find(kKinds[k]);
    if (found == nullptr) continue;
    if (node != nullptr) {
      diagnostics.error(found->mark, "misplaced-key",
                        fmt::format("'{}' beside another distribution", kKinds[k]));
      return std::nullopt;
    }
    node = found;
    d.kind = static_cast<Distribution>(k);
  }
  if (node == nullptr) {
    diagnostics.error(map.mark, "missing-key",
                      "one of the keys 'uniform', 'log_uniform', 'normal' is missing");
    return std::nullopt;
  }
  const auto ends = read_pair_of(*node, diagnostics);
  if (!ends) return std::nullopt;
  d.a = ends->a, d.b = ends->b, unit = ends->unit;
  const bool normal = d.kind == Distribution::normal;
  const bool good =
      normal ? d.b > 0.0 : d.a < d.b && (d.kind == Distribution::uniform || d.a > 0.0);
  if (!good) {
    diagnostics.error(node->mark, "range",
                      normal ? "the standard deviation must be above 0"
                             : "expected the smaller value first, above 0 for log_uniform");
    return std::nullopt;
  }
  const YamlNode* within = map.find("within");
  if (within == nullptr) return d;
  if (!normal) {
    diagnostics.error(within->mark, "misplaced-key", "'within' belongs to 'normal'");
    return std::nullopt;
  }
  const auto cut = read_pair_of(*within, diagnostics);
  if (!cut) return std::nullopt;
  if (cut->unit != unit || !(cut->a < cut->b)) {
    diagnostics.error(within->mark, "range",
                      "expected the smaller value first, in the unit of 'normal'");
    return std::nullopt;
  }
  d.low = cut->a, d.high = cut->b;
  return d;
}

void add_axis(SweepDescription& sweep, SweepGroup& group, SweepAxis axis,
              Diagnostics& diagnostics) {
  // A vector and one of its values would be set one after the other: the first has no effect.
  const auto is_part = [](const std::string& whole, const std::string& part) {
    return part.starts_with(whole) && part.size() > whole.size() &&
           (part[whole.size()] == '.' || part[whole.size()] == '[');
  };
  const auto twice = [&](const SweepAxis& other) {
    return other.name == axis.name || is_part(other.name, axis.name) ||
           is_part(axis.name, other.name);
  };
  if (std::ranges::any_of(sweep.axes, twice)) {
    diagnostics.error(axis.mark, "duplicate", fmt::format("'{}' is given values twice", axis.name));
  }
  if (!core::is_dotted_name(axis.name)) {
    diagnostics.error(axis.mark, "name", fmt::format("'{}' is no name", axis.name));
  }
  group.size = axis.values.size();
  group.axes.push_back(sweep.axes.size());
  sweep.axes.push_back(std::move(axis));
}

}  // namespace

void read_sweep_vary(const YamlNode& node, SweepDescription& sweep, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "values by name", diagnostics)) return;
  for (const core::YamlEntry& entry : node.entries) {
    auto axis =
        entry.value.is_map() ? read_grid(entry, diagnostics) : read_list(entry, diagnostics);
    if (!axis) continue;
    if (!entry.value.is_map()) refuse_equal_values(*axis, diagnostics);
    SweepGroup group;
    add_axis(sweep, group, std::move(*axis), diagnostics);
    sweep.groups.push_back(std::move(group));
  }
}

void read_sweep_zip(const YamlNode& node, SweepDescription& sweep, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "lists by name", diagnostics)) return;
  SweepGroup group;
  for (const core::YamlEntry& entry : node.entries) {
    auto axis = read_list(entry, diagnostics);
    if (!axis) continue;
    if (!group.axes.empty() && axis->values.size() != group.size) {
      diagnostics.error(
          entry.value.mark, "size",
          fmt::format("{} values beside {} of '{}': zipped lists are of one length",
                      axis->values.size(), group.size, sweep.axes[group.axes.front()].name));
      continue;
    }
    add_axis(sweep, group, std::move(*axis), diagnostics);
  }
  if (group.axes.empty()) return;
  refuse_equal_rows(sweep, group, diagnostics);
  sweep.groups.push_back(std::move(group));
}

void read_sweep_sample(const YamlNode& node, SweepDescription& sweep, Diagnostics& diagnostics) {
  if (!core::expect_map(node, "a map with 'count' and 'of'", diagnostics)) return;
  core::check_keys(node, kSweepSampleKeys, diagnostics);
  const YamlNode* of = core::require_key(node, "of", diagnostics);
  const YamlNode* count_node = core::require_key(node, "count", diagnostics);
  if (of == nullptr || count_node == nullptr) return;
  const auto count = core::read_integer(*count_node, 1, 1'000'000, diagnostics);
  std::int64_t seed = 1;
  if (const YamlNode* key = node.find("seed")) {
    seed = core::read_integer(*key, 0, 1'000'000'000, diagnostics).value_or(1);
  }
  SampleMethod method = SampleMethod::random;
  if (const YamlNode* key = node.find("method")) {
    const auto index = core::read_choice(*key, kSweepMethods, diagnostics, "a method");
    method = static_cast<SampleMethod>(index.value_or(0));
  }
  if (!count || !core::expect_map(*of, "distributions by name", diagnostics)) return;
  SweepGroup group;
  for (const core::YamlEntry& entry : of->entries) {
    SweepAxis axis{entry.key, entry.key_mark, {}, "", false};
    const auto distribution = read_distribution(entry.value, axis.unit, diagnostics);
    if (!distribution) continue;
    for (const double u : unit_draws(entry.key, static_cast<std::uint64_t>(seed),
                                     static_cast<std::size_t>(*count), method)) {
      axis.values.push_back(
          computed_value(quantile(*distribution, u), axis.unit, entry.value.mark));
    }
    add_axis(sweep, group, std::move(axis), diagnostics);
  }
  if (!group.axes.empty()) sweep.groups.push_back(std::move(group));
}

}  // namespace footfall::lab
