// Factors of a sweep; see factors.h.
#include "lab/sweep/results/factors.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/text/json_text.h"
#include "core/units/units.h"

namespace footfall::lab {
namespace {

constexpr std::size_t kMostLevels = 24;  // more levels are grouped into bins
constexpr std::size_t kBins = 8;

// The number in a value as written, in the unit of the axis; in SI if the text has another unit.
double number_in(const std::string& text, const std::string& unit) {
  const auto quantity = core::parse_quantity(text);
  if (!quantity) return std::numeric_limits<double>::quiet_NaN();
  char* end = nullptr;
  const double written = std::strtod(text.c_str(), &end);
  std::string tail = end;
  tail.erase(0, tail.find_first_not_of(" \t"));
  return tail == unit ? written : quantity->value;
}

int index_in(std::vector<std::string>& levels, const std::string& text) {
  const auto at = std::ranges::find(levels, text);
  const auto index = static_cast<int>(at - levels.begin());
  if (at == levels.end()) levels.push_back(text);
  return index;
}

// Groups the values into bins with about equal numbers of runs.
void put_in_bins(SweepFactor& factor) {
  std::vector<double> sorted = factor.number;
  std::ranges::sort(sorted);
  std::vector<double> edges;
  for (std::size_t k = 0; k <= kBins; ++k) {
    edges.push_back(quantile_of(sorted, static_cast<double>(k) / kBins));
  }
  factor.binned = true;
  factor.levels.clear();
  for (std::size_t k = 0; k < kBins; ++k) {
    factor.levels.push_back(fmt::format("{:.4g} to {:.4g}{}{}", edges[k], edges[k + 1],
                                        factor.unit.empty() ? "" : " ", factor.unit));
  }
  for (std::size_t r = 0; r < factor.number.size(); ++r) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, factor.number[r]);
    factor.level[r] = static_cast<int>(above - edges.begin()) - 1;
  }
}

// Sorts levels by their numbers: samples and lists are unordered.
void sort_levels(SweepFactor& factor) {
  std::vector<std::pair<double, int>> order;
  for (std::size_t k = 0; k < factor.levels.size(); ++k) {
    order.emplace_back(number_in(factor.levels[k], factor.unit), static_cast<int>(k));
  }
  std::ranges::sort(order);
  std::vector<std::string> levels;
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const auto from = static_cast<std::size_t>(order[k].second);
    levels.push_back(factor.levels[from]);
    place[from] = static_cast<int>(k);
  }
  factor.levels = std::move(levels);
  for (int& level : factor.level) level = place[static_cast<std::size_t>(level)];
}

SweepFactor axis_factor(const SweepTable& table, const nlohmann::json& axis) {
  SweepFactor factor;
  factor.name = axis.value("name", "");
  factor.unit = axis.value("unit", "");
  factor.parameter = true;
  for (const nlohmann::json& value : axis.value("values", nlohmann::json::array())) {
    if (factor.levels.size() <= kMostLevels) index_in(factor.levels, value.get<std::string>());
  }
  const bool many = factor.levels.size() > kMostLevels;
  bool numbers = true;
  for (const SweepRow& row : table.rows) {
    const auto at = row.values.find(factor.name);
    const std::string text = at == row.values.end() ? std::string() : at->second;
    factor.number.push_back(number_in(text, factor.unit));
    numbers = numbers && std::isfinite(factor.number.back());
    factor.level.push_back(many ? 0 : index_in(factor.levels, text));
  }
  if (many && numbers) put_in_bins(factor);
  if (!many && numbers) sort_levels(factor);
  if (!numbers) {
    for (std::size_t r = 0; r < factor.level.size(); ++r) {
      factor.number[r] = static_cast<double>(factor.level[r]);
    }
    factor.unit.clear();
  }
  return factor;
}

template <typename Text>
SweepFactor word_factor(const SweepTable& table, const char* name, Text text) {
  SweepFactor factor;
  factor.name = name;
  for (const SweepRow& row : table.rows) {
    factor.level.push_back(index_in(factor.levels, text(row)));
    factor.number.push_back(static_cast<double>(factor.level.back()));
  }
  return factor;
}

}  // namespace

std::vector<SweepFactor> sweep_factors(const SweepTable& table) {
  std::vector<SweepFactor> factors;
  const auto description = core::parse_json(table.identity.description);
  if (description.is_object()) {
    for (const nlohmann::json& axis : description.value("axes", nlohmann::json::array())) {
      factors.push_back(axis_factor(table, axis));
    }
  }
  factors.push_back(word_factor(table, "world", [](const SweepRow& row) { return row.world; }));
  factors.push_back(word_factor(table, "fault", [](const SweepRow& row) { return row.fault; }));
  std::erase_if(factors, [](const SweepFactor& f) { return f.levels.size() < 2; });
  return factors;
}

std::vector<std::string> figures_of_merit(const SweepTable& table) {
  const auto description = core::parse_json(table.identity.description);
  std::vector<std::string> named;
  if (description.is_object()) {
    for (const nlohmann::json& name : description.value("figures", nlohmann::json::array()))
      named.push_back(name);
  }
  if (!named.empty()) return named;
  constexpr std::size_t kFew = 3;
  for (const char* name : {"error.pitch.max", "error.roll.max", "goal_error_m", "error.height.rms",
                           "foot_placement_m.mean", "max_torque_step_Nm"}) {
    const auto has = [name](const SweepRow& row) { return row.figures.contains(name); };
    if (named.size() < kFew && std::ranges::any_of(table.rows, has)) named.emplace_back(name);
  }
  return named;
}

std::string figure_unit(const std::string& name) {
  if (name.starts_with("error.height")) return "m";
  if (name.starts_with("error.")) return "rad";
  for (const auto& [ending, unit] :
       {std::pair("_mps", "m/s"), std::pair("_Nm", "Nm"), std::pair("_m", "m"),
        std::pair("_s", "s"), std::pair("_m.mean", "m"), std::pair("_m.max", "m")}) {
    if (name.ends_with(ending)) return unit;
  }
  return "";
}

}  // namespace footfall::lab
