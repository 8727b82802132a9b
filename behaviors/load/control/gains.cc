// Gain tables: `gains.TABLE.TASK.kp` etc. as slots of the value array.
#include "behaviors/load/control/gains.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "behaviors/language/language.h"
#include "behaviors/load/control/steps.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/dotted_name.h"
#include "core/yaml/glob.h"

namespace footfall::behaviors {
namespace {

// Axes of the first task that uses an entry.
struct GainAxes {
  std::vector<std::string> names;  // in the task's order
  bool joints = false;
};

constexpr std::array<core::Dimension, 3> kDimensions = {core::kRateSquared,
                                                        core::Dimension{0, 0, -3}, core::kRate};

void load_ranges(LoadContext& context, const core::YamlNode& ranges) {
  if (!core::expect_map(ranges, "ranges of kp, ki and kd", context.diagnostics)) return;
  core::check_keys(ranges, kGainRangesKeys, context.diagnostics);
  for (std::size_t k = 0; k < 3; ++k) {
    if (const auto* node = ranges.find(kGainNames[k])) {
      context.gain_ranges[k] = core::read_range(*node, kDimensions[k], context.diagnostics);
      if (context.gain_ranges[k]) context.behavior.gain_limits[k] = *context.gain_ranges[k];
    }
  }
}

// Whether a value contains a parameter, an expression or a signal.
bool is_computed(const core::YamlNode& node) {
  if (node.is_sequence()) return std::any_of(node.items.begin(), node.items.end(), is_computed);
  if (node.is_map()) {
    return std::any_of(node.entries.begin(), node.entries.end(),
                       [](const core::YamlEntry& entry) { return is_computed(entry.value); });
  }
  if (core::is_reference(node) || core::is_expression(node)) return true;
  const char first = node.scalar.empty() ? '0' : node.scalar.front();
  return (first >= 'a' && first <= 'z') && node.scalar.find('.') != std::string::npos;
}

// One value an axis: a single number for all, a list, or a map by axis (joints: with patterns).
std::optional<std::vector<double>> read_values(LoadContext& context, const core::YamlNode& node,
                                               core::Dimension dimension, const GainAxes& use) {
  const std::size_t size = std::max<std::size_t>(use.names.size(), 1);
  if (node.is_sequence() && use.names.empty()) {
    std::vector<double> values;
    for (const core::YamlNode& item : node.items) {
      values.push_back(core::read_quantity(item, dimension, context.diagnostics).value_or(0.0));
    }
    return values;
  }
  if (!node.is_map()) {
    if (node.is_scalar()) {
      const auto value = core::read_quantity(node, dimension, context.diagnostics);
      return value ? std::optional(std::vector<double>(size, *value)) : std::nullopt;
    }
    return core::read_vector(node, dimension, use.names, context.diagnostics);
  }
  std::vector<double> values(size, 0.0);
  const int before = context.diagnostics.error_count();
  const auto entries =
      core::match_names(node, use.names, use.joints ? "joint" : "axis", context.diagnostics);
  for (std::size_t k = 0; k < entries.size(); ++k) {
    if (entries[k] == nullptr) {
      if (!use.joints && context.diagnostics.error_count() == before) {
        context.error(node.mark, "missing-key",
                      fmt::format("no value for '{}' (0 if it is meant)", use.names[k]));
      }
      continue;
    }
    values[k] =
        core::read_quantity(entries[k]->value, dimension, context.diagnostics).value_or(0.0);
  }
  return values;
}

void check_values(LoadContext& context, const core::YamlNode& node, const ParameterInfo& info,
                  const std::vector<double>& values) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool single = node.is_sequence() && k < node.items.size();
    const core::YamlNode& place = single ? node.items[k] : node;
    if (values[k] < 0.0) {
      context.error(place.mark, "out-of-range", "a gain cannot be negative");
    } else if (info.has_range() && (values[k] < info.min || values[k] > info.max)) {
      context.error(place.mark, "out-of-range",
                    fmt::format("{} is outside gains.ranges, {} to {}", core::describe(place),
                                info.min, info.max));
    } else {
      continue;
    }
    return;
  }
}

// Index of an axis by name or number; an error and nothing if there is none.
std::optional<std::size_t> find_axis(LoadContext& context, const GainSetting& setting,
                                     const GainAxes& use) {
  std::size_t index = 0;
  const char* const end = setting.axis.data() + setting.axis.size();
  const auto [stop, problem] = std::from_chars(setting.axis.data(), end, index);
  if (problem != std::errc() || stop != end) {
    index =
        static_cast<std::size_t>(std::ranges::find(use.names, setting.axis) - use.names.begin());
  }
  if (index < use.names.size()) return index;
  context.error(setting.value.mark, "unknown-setting",
                fmt::format("--set {}: {} has no axis '{}'{}", setting.name, setting.gain,
                            setting.axis, core::did_you_mean_or_list(setting.axis, use.names)));
  return std::nullopt;
}

void refuse_gain_settings(LoadContext& context, const ParameterInfo& info) {
  for (const GainSetting& setting : context.gain_settings) {
    if (setting.gain != info.name) continue;
    context.error(setting.value.mark, "unknown-setting",
                  fmt::format("--set {}: {} is computed; set what it is computed from, or all of "
                              "it",
                              setting.name, setting.gain));
  }
}

// Puts the values of --set in; returns whether there were any by axis.
bool apply_gain_settings(LoadContext& context, const ParameterInfo& info, const GainAxes& use,
                         std::vector<double>& values) {
  bool any = false;
  for (const GainSetting& setting : context.gain_settings) {
    if (setting.gain != info.name) continue;
    std::optional<std::vector<double>> all;
    if (setting.axis.empty()) {
      all = read_values(context, setting.value, info.dimension, use);
    } else if (const auto axis = find_axis(context, setting, use)) {
      const auto value = core::read_quantity(setting.value, info.dimension, context.diagnostics);
      if (value) all = values, (*all)[*axis] = *value;
      any = true;
    }
    if (!all || all->size() != values.size()) continue;  // told
    values = *all;
    check_values(context, setting.value, info, values);
  }
  return any;
}

void make_slots(LoadContext& context, GainEntry& entry, const GainAxes& use) {
  Behavior& behavior = context.behavior;
  entry.made = true;
  entry.axes = use.names;
  for (std::size_t k = 0; k < 3; ++k) {
    const core::YamlNode* node = entry.node->find(kGainNames[k]);
    if (node == nullptr) continue;
    entry.computed[k] = is_computed(*node);
    ParameterInfo info;
    info.name = entry.name + "." + kGainNames[k];
    info.dimension = kDimensions[k];
    if (entry.computed[k]) {
      refuse_gain_settings(context, info);
      continue;
    }
    const int before = context.diagnostics.error_count();
    auto values = read_values(context, *node, kDimensions[k], use);
    if (!values || values->empty()) continue;
    const bool good = context.diagnostics.error_count() == before;
    info.slot = static_cast<int>(behavior.values.size());
    info.size = static_cast<int>(values->size());
    info.gain = true;
    info.axes = use.names;
    info.mark = node->mark;
    if (const auto& range = context.gain_ranges[k]) {
      info.min = (*range)[0];
      info.max = (*range)[1];
      info.live = true;
    }
    if (good) check_values(context, *node, info, *values);
    entry.by_axis[k] = apply_gain_settings(context, info, use, *values);
    entry.slots[k] = info.slot;
    entry.sizes[k] = info.size;
    behavior.parameters.push_back(info);
    behavior.values.insert(behavior.values.end(), values->begin(), values->end());
  }
}

// Compiles a gain given by expressions, axis by axis; constants are range-checked here.
void compute_gain(LoadContext& context, const core::YamlNode& node, std::size_t gain,
                  AxesScope axes, std::vector<AxisSpec>& out) {
  axes.dimensions.assign(axes.names.size(), kDimensions[gain]);
  const std::vector<int> values = compile_axes(context, node, axes, true);
  const auto& limits = context.behavior.gain_limits[gain];
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i].computed[gain] = values[i];
    const auto value = context.constant_value(values[i]);
    if (!value || (*value >= limits[0] && *value <= limits[1])) continue;
    const core::YamlNode& place = node.is_sequence() ? node.items[i] : node;
    context.error(
        place.mark, "out-of-range",
        fmt::format("{} is {}: a gain is at least {}{}", core::describe(place), *value, limits[0],
                    context.gain_ranges[gain]
                        ? fmt::format(" and at most {} (gains.ranges)", limits[1])
                        : ""));
    return;
  }
}

bool check_entry(LoadContext& context, const core::YamlNode& node) {
  if (!core::expect_map(node, "gains: a map with kp, ki, kd", context.diagnostics)) return false;
  core::check_keys(node, kGainsKeys, context.diagnostics);
  if (node.entries.empty()) {
    context.error(node.mark, "missing-key", "expected at least one of kp, ki, kd");
  }
  return true;
}

}  // namespace

void load_gains(LoadContext& context) {
  const core::YamlNode* section = context.section("gains");
  if (section == nullptr || !core::expect_map(*section, "gain tables", context.diagnostics)) return;
  if (const auto* ranges = section->find("ranges")) load_ranges(context, *ranges);
  for (const core::YamlEntry& table : section->entries) {
    if (table.key == "ranges") continue;
    if (!core::check_name(table, context.diagnostics, "the name of a gain table")) continue;
    if (!core::expect_map(table.value, "gains by task", context.diagnostics)) continue;
    for (const core::YamlEntry& task : table.value.entries) {
      const std::string name = fmt::format("gains.{}.{}", table.key, task.key);
      GainEntry& entry = context.gain_entries[name];
      entry.made = !check_entry(context, task.value);  // on error, no slots are created
      entry.node = &task.value;
      entry.name = name;
      entry.in_table = true;
    }
  }
}

GainEntry* find_gains(LoadContext& context, const std::string& table, const std::string& task) {
  const auto found = context.gain_entries.find(fmt::format("gains.{}.{}", table, task));
  return found == context.gain_entries.end() ? nullptr : &found->second;
}

bool require_gain_table(LoadContext& context, const core::YamlNode& name) {
  if (!core::expect_scalar(name, "the name of a gain table", context.diagnostics)) return false;
  const core::YamlNode* section = context.section("gains");
  std::vector<std::string> tables;
  if (section != nullptr) {
    for (const auto& entry : section->entries) {
      if (entry.key != "ranges") tables.push_back(entry.key);
    }
  }
  for (const std::string& table : tables) {
    if (table == name.scalar) return true;
  }
  context.error(name.mark, "unknown-gains",
                fmt::format("unknown gain table '{}'{}", name.scalar,
                            core::did_you_mean_or_list(name.scalar, tables)));
  return false;
}

GainEntry* inline_gains(LoadContext& context, const std::string& owner, const std::string& task,
                        const core::YamlNode& node) {
  std::string name = fmt::format("gains.{}.{}", owner, task);
  const auto same_place = [&](const core::YamlNode& other) {  // several states name the same stack
    return other.mark.file == node.mark.file && other.mark.line == node.mark.line &&
           other.mark.column == node.mark.column;
  };
  while (context.gain_entries.contains(name) && !same_place(*context.gain_entries[name].node)) {
    name += "_own";
  }
  GainEntry& entry = context.gain_entries[name];
  if (entry.node == nullptr && !check_entry(context, node)) {
    context.gain_entries.erase(name);
    return nullptr;
  }
  if (entry.node == nullptr) entry.node = &node;
  entry.name = name;
  return &entry;
}

void use_gain(LoadContext& context, const GainSource& source, std::size_t gain,
              const AxesScope& axes, std::vector<AxisSpec>& out) {
  GainEntry& entry = *source.entry;
  if (!entry.made) make_slots(context, entry, {axes.names, axes.joints});
  const core::YamlNode& node = *entry.node->find(kGainNames[gain]);
  if (entry.computed[gain]) {
    compute_gain(context, *source.node->find(kGainNames[gain]), gain,
                 {axes.names, axes.positions, {}, source.owner, axes.joints}, out);
    return;
  }
  if (entry.slots[gain] < 0) return;
  if ((!node.is_scalar() || entry.by_axis[gain]) && entry.axes != axes.names) {
    context.error(
        node.mark, "size",
        fmt::format("{} serves a task with other axes too: write one number", entry.name));
  }
  constexpr std::array<int AxisSpec::*, 3> kMembers = {&AxisSpec::kp, &AxisSpec::ki, &AxisSpec::kd};
  for (std::size_t i = 0; i < out.size(); ++i) {
    const int offset = std::min(static_cast<int>(i), entry.sizes[gain] - 1);
    out[i].*kMembers[gain] = entry.slots[gain] + offset;
  }
}

void warn_incomplete_gains(LoadContext& context) {
  for (const auto& [mark, text] : context.incomplete_gains) {
    context.absence(mark, "incomplete-gains", text);
  }
}

// The name that was perhaps meant by an unused entry: of a table that some task uses, or of another
// task in the same table.
std::string meant_gains(const LoadContext& context, const GainEntry& unused) {
  const std::vector<std::string> parts = core::split_dots(unused.name);
  std::vector<std::string> tables, entries;
  for (const auto& [name, entry] : context.gain_entries) {
    if (!entry.overlaid || !entry.in_table) continue;
    const std::vector<std::string> other = core::split_dots(name);
    (other[1] == parts[1] ? entries : tables).push_back(other[1] == parts[1] ? other[2] : other[1]);
  }
  return entries.empty() ? core::did_you_mean(parts[1], tables)
                         : core::did_you_mean(parts[2], entries);
}

// Warns about values of an entry that an inner layer's hide from every task.
void warn_shadowed_gains(LoadContext& context, const GainEntry& entry) {
  for (std::size_t k = 0; k < kGainNames.size(); ++k) {
    const core::YamlNode* value = entry.node->find(kGainNames[k]);
    const core::Mark shadow = entry.shadow[k];
    if (value == nullptr || entry.used[k] || shadow.file < 0) continue;
    const std::string name =
        entry.in_table ? entry.name + "." + kGainNames[k] : std::string("this ") + kGainNames[k];
    context.absence(value->mark, "unused",
                    fmt::format("no task uses {}: the value at {}:{}:{} takes precedence", name,
                                context.diagnostics.file(shadow.file), shadow.line, shadow.column));
  }
}

void make_unused_gains(LoadContext& context) {
  for (auto& [name, entry] : context.gain_entries) {
    if (entry.overlaid) warn_shadowed_gains(context, entry);
    if (entry.made) continue;
    if (!entry.overlaid) {
      context.absence(entry.node->mark, "unused",
                      fmt::format("no task uses {}{}", name, meant_gains(context, entry)));
    }
    make_slots(context, entry, {});
  }
}

void check_gain_settings(LoadContext& context) {
  std::vector<std::string> names;
  for (const ParameterInfo& parameter : context.behavior.parameters) {
    if (parameter.gain) names.push_back(parameter.name);
  }
  for (const auto& [name, entry] : context.gain_entries) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (entry.computed[k]) names.push_back(name + "." + kGainNames[k]);
    }
  }
  for (const GainSetting& setting : context.gain_settings) {
    if (std::ranges::find(names, setting.gain) != names.end()) continue;
    context.error(setting.value.mark, "unknown-setting",
                  fmt::format("--set {}: there is no '{}'{}", setting.name, setting.gain,
                              core::did_you_mean(setting.gain, names)));
  }
}

}  // namespace footfall::behaviors
