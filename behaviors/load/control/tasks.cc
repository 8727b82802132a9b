// Tasks of the merged control: type, axes, point, gains, limits; see tasks.h.
#include "behaviors/load/control/tasks.h"

#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language/language.h"
#include "behaviors/load/control/gains.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

using tasks::TaskType;
using tasks::TaskTypeInfo;

// Index into the model's points: contacts first, then the robot's points.
int find_point(LoadContext& context, const core::YamlNode& node) {
  if (!core::expect_scalar(node, "the name of a point", context.diagnostics)) return -1;
  const auto& robot = context.behavior.robot;
  std::vector<std::string> names = context.contact_names();
  for (const auto& point : robot.points) names.push_back(point.name);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == node.scalar) return static_cast<int>(k);
  }
  context.error(node.mark, "unknown-point",
                fmt::format("unknown point '{}'{}", node.scalar,
                            core::did_you_mean_or_list(node.scalar, names)));
  return -1;
}

int find_instance(LoadContext& context, const DraftItem& item, TaskType type, int point) {
  auto& instances = context.behavior.task_instances;
  for (std::size_t k = 0; k < instances.size(); ++k) {
    if (instances[k].name == item.name && instances[k].type == type &&
        instances[k].point == point) {
      return static_cast<int>(k);
    }
  }
  int signals = 0;
  const auto& names = context.behavior.task_names;
  while (signals < static_cast<int>(names.size()) &&
         names[static_cast<std::size_t>(signals)].name != item.name) {
    ++signals;
  }
  instances.push_back({item.name, type, point, signals});
  return static_cast<int>(instances.size()) - 1;
}

// Position of an axis: its item in `axes` or `joints` if they list one for each.
core::Mark axis_mark(const DraftItem& item, const DraftKey* axes, std::size_t k,
                     std::size_t count) {
  if (axes == nullptr) return item.mark;
  const bool listed = axes->node->is_sequence() && axes->node->items.size() == count;
  return listed ? axes->node->items[k].mark : axes->node->mark;
}

// The gains of a task from every layer that defines some, outermost first.
std::vector<GainSource> gain_sources(LoadContext& context, const DraftItem& item,
                                     const Draft& draft) {
  std::vector<DraftGains> layers = draft.gains;
  layers.insert(layers.end(), item.gains.begin(), item.gains.end());
  std::stable_sort(layers.begin(), layers.end(),
                   [](const auto& a, const auto& b) { return a.layer < b.layer; });
  std::vector<GainSource> sources;
  for (const DraftGains& gains : layers) {
    GainEntry* entry = nullptr;
    const core::YamlNode* own = nullptr;
    if (gains.node->is_map()) {
      own = gains.of_task ? gains.node : gains.node->find(item.name);
      if (own != nullptr) entry = inline_gains(context, gains.name, item.name, *own);
    } else if (!gains.node->is_scalar()) {
      core::report_expected(*gains.node, "gains", context.diagnostics);
    } else if (require_gain_table(context, *gains.node)) {
      entry = find_gains(context, gains.node->scalar, item.name);
    }
    if (entry == nullptr) continue;
    entry->overlaid = true;
    sources.push_back({entry, own != nullptr ? own : entry->node, gains.owner});
  }
  return sources;
}

void report_no_gains(LoadContext& context, const DraftItem& item, const Draft& draft) {
  std::string tables;
  for (auto gains = draft.gains.rbegin(); gains != draft.gains.rend(); ++gains) {
    if (!gains->node->is_scalar()) continue;
    if (!require_gain_table(context, *gains->node)) return;
    tables += fmt::format("{}'{}'", tables.empty() ? "" : " and ", gains->node->scalar);
  }
  context.error(item.mark, "no-gains",
                tables.empty() ? fmt::format("task '{}' has no gains", item.name)
                               : fmt::format("task '{}' has no gains: none in it, none in table {}",
                                             item.name, tables));
}

// Notes kp without kd, and ki without kp, after merging all layers.
void note_incomplete_gains(LoadContext& context, const std::vector<GainSource>& sources) {
  const auto node_of = [&](const char* gain) -> const core::YamlNode* {
    for (auto source = sources.rbegin(); source != sources.rend(); ++source) {
      if (source->entry->node->find(gain) != nullptr) return source->entry->node;
    }
    return nullptr;
  };
  const core::YamlNode* p = node_of("kp");
  if (const core::YamlNode* i = node_of("ki"); i != nullptr && p == nullptr) {
    context.incomplete_gains.emplace_back(i->mark,
                                          "ki without kp cannot be stable: is a kp missing?");
  } else if (p != nullptr && node_of("kd") == nullptr) {
    context.incomplete_gains.emplace_back(
        p->mark, "kp without kd never comes to rest: add a kd (`kd: 0` if it is meant)");
  }
}

// Compiles kp, ki and kd, each from the innermost layer that defines it.
void compile_gains(LoadContext& context, const DraftItem& item, const Draft& draft,
                   const TaskTypeInfo& type, const AxesScope& axes, std::vector<AxisSpec>& out) {
  const int before = context.diagnostics.error_count();
  const std::vector<GainSource> sources = gain_sources(context, item, draft);
  if (sources.empty()) {
    if (context.diagnostics.error_count() == before) report_no_gains(context, item, draft);
    return;
  }
  note_incomplete_gains(context, sources);
  for (std::size_t k = 0; k < kGainNames.size(); ++k) {
    const auto source = std::find_if(sources.rbegin(), sources.rend(), [&](const auto& s) {
      return s.entry->node->find(kGainNames[k]) != nullptr;
    });
    if (source == sources.rend()) continue;
    const core::Mark mark = source->entry->node->find(kGainNames[k])->mark;
    source->entry->used[k] = true;
    for (const GainSource& below : sources) {
      core::Mark& shadow = below.entry->shadow[k];
      if (shadow.file < 0) shadow = mark;  // the first of several
    }
    if (type.gains.find(kGainNames[k]) == std::string_view::npos) {
      context.error(mark, "misplaced-key",
                    fmt::format("{}, no {}", type.gains_note, kGainNames[k]));
    }
    use_gain(context, *source, k, axes, out);
  }
}

void compile_frame(LoadContext& context, const DraftItem& item, const tasks::TaskTypeInfo& type,
                   const std::vector<int>& axes, TaskSpec& spec) {
  if (type.frames.empty()) return;
  spec.frame = type.frames.front();
  const DraftKey* key = item.find("frame");
  if (key == nullptr) return;
  const auto choice = core::read_choice(*key->node, kFrames, context.diagnostics, "a frame");
  if (!choice) return;
  const auto frame = static_cast<tasks::Frame>(1 + *choice);
  if (std::find(type.frames.begin(), type.frames.end(), frame) == type.frames.end()) {
    std::vector<std::string_view> names;
    for (const tasks::Frame f : type.frames)
      names.push_back(kFrames[static_cast<std::size_t>(f) - 1].word);
    context.error(key->node->mark, "misplaced-name",
                  fmt::format("a {} has the frame {}, got {}", type.name, fmt::join(names, " or "),
                              core::describe(*key->node)));
    return;
  }
  spec.frame = frame;
  const bool turns = type.is_angle(0);
  const auto has = [&](int axis) {
    return std::find(axes.begin(), axes.end(), axis) != axes.end();
  };
  if (turns && frame == tasks::Frame::world && has(0) != has(1)) {
    context.error(key->node->mark, "misplaced-name",
                  "about the world's axes roll and pitch go together: one alone means nothing at "
                  "another yaw (take `frame: heading`)");
  }
}

// A non-negative value for each axis.
void compile_limits(LoadContext& context, const DraftItem& item, const char* name, AxesScope axes,
                    int AxisSpec::*member, std::vector<AxisSpec>& out) {
  const DraftKey* key = item.find(name);
  if (key == nullptr) return;
  axes.owner = key->owner;
  const std::vector<int> values = compile_axes(context, *key->node, axes, true);
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].*member = values[k];
    const auto value = context.constant_value(values[k]);
    if (!value || *value >= 0.0) continue;
    const bool listed = key->node->is_sequence();
    context.error(listed ? key->node->items[k].mark : key->node->mark, "out-of-range",
                  fmt::format("{} cannot be negative", name));
    return;
  }
}

// The integral needs ki; for an angular momentum, kp.
void warn_idle_limit(LoadContext& context, const DraftItem& item, const TaskTypeInfo& type,
                     const std::vector<AxisSpec>& specs) {
  const DraftKey* limit = item.find("integral_limit");
  const bool integrates = std::any_of(specs.begin(), specs.end(), [&](const AxisSpec& axis) {
    return type.is_rate ? axis.kp >= 0 || axis.computed[0] >= 0
                        : axis.ki >= 0 || axis.computed[1] >= 0;
  });
  if (limit == nullptr || integrates) return;
  context.warning(
      limit->node->mark, "no-effect",
      fmt::format("`integral_limit` without {} has no effect", type.is_rate ? "kp" : "ki"));
}

void check_task_keys(LoadContext& context, const DraftItem& item, const TaskTypeInfo& type) {
  const std::vector<std::string> known = core::key_names(kTaskKeys, type.name);
  core::YamlNode map;  // merged keys, for check_keys
  map.kind = core::YamlNode::Kind::map;
  for (const DraftKey& key : item.keys) {
    if (key.key == "doc") core::check_doc(*key.node, context.diagnostics);
    if (std::find(known.begin(), known.end(), key.key) != known.end()) continue;
    map.entries.push_back({key.key, key.mark, false, {}});
  }
  core::check_keys(map, known, context.diagnostics);
}

// The type of a task, from its own keys or those of the stack; nullopt after an error.
std::optional<tasks::TaskType> read_type(LoadContext& context, const DraftItem& item,
                                         const Draft& draft) {
  const DraftKey* type_key = item.find("type");
  if (type_key == nullptr && draft.misspelt) return std::nullopt;
  if (type_key == nullptr) {
    std::vector<std::string> names;
    for (const DraftItem& other : draft.tasks) {
      if (other.name != item.name) names.push_back(other.name);
    }
    context.error(item.mark, "unknown-task",
                  fmt::format("task '{}' is not in the stack in force, and has no type{}",
                              item.name, core::did_you_mean_or_list(item.name, names)));
    return std::nullopt;
  }
  return require_task_type(*type_key->node, context.diagnostics);
}

// The axes that a task controls; empty after an error, or if there is nothing to control.
std::vector<int> controlled_axes(LoadContext& context, const DraftItem& item, tasks::TaskType type,
                                 const DraftKey* axes_key) {
  const int before = context.diagnostics.error_count();
  const std::vector<int> axes =
      read_axes(context, type, axes_key == nullptr ? nullptr : axes_key->node, context.diagnostics);
  if (context.diagnostics.error_count() != before) return {};
  if (axes.empty() && axes_key != nullptr && axes_key->node->is_sequence() &&
      axes_key->node->items.empty()) {
    context.error(axes_key->node->mark, "empty-value",
                  fmt::format("`{}: []` leaves nothing to control: name some, or remove the task "
                              "with `{}: off`",
                              axes_key->key, item.name));
  }
  return axes;
}

}  // namespace

int compile_limit(LoadContext& context, const DraftItem& item, const char* name,
                  core::Dimension dimension) {
  const DraftKey* key = item.find(name);
  if (key == nullptr) return -1;
  ValueScope scope;
  scope.state = key->owner;
  const int expression = context.compile_value(*key->node, dimension, scope);
  const auto value = context.constant_value(expression);
  if (value && *value < 0.0) {
    context.error(key->node->mark, "out-of-range", fmt::format("{} cannot be negative", name));
  }
  return expression;
}

std::optional<TaskSpec> compile_task(LoadContext& context, const DraftItem& item,
                                     const Draft& draft) {
  const auto type = read_type(context, item, draft);
  if (!type) return std::nullopt;
  const TaskTypeInfo& info = tasks::info(*type);
  check_task_keys(context, item, info);
  TaskSpec spec;
  spec.type = *type;
  spec.mark = item.mark;
  if (info.of_point()) {
    const DraftKey* point = item.find("point");
    if (point == nullptr) {
      context.error(item.mark, "missing-key", fmt::format("task '{}' needs a `point`", item.name));
      return std::nullopt;
    }
    spec.point = find_point(context, *point->node);
    if (spec.point < 0) return std::nullopt;
  }
  const DraftKey* axes_key = item.find(info.of_joints() ? "joints" : "axes");
  const std::vector<int> axes = controlled_axes(context, item, *type, axes_key);
  if (axes.empty()) return std::nullopt;
  const std::vector<std::string> all = tasks::axis_names(*type, context.behavior.robot);
  std::vector<std::string> names;
  std::vector<core::Dimension> positions;
  std::vector<core::Dimension> accelerations;
  std::vector<AxisSpec> specs;
  for (const int axis : axes) {
    names.push_back(all[static_cast<std::size_t>(axis)]);
    positions.push_back(info.dimension(axis));
    accelerations.push_back(info.commanded_dimension(axis));
    specs.emplace_back();
    specs.back().axis = axis;
    specs.back().mark = axis_mark(item, axes_key, specs.size() - 1, axes.size());
  }
  compile_frame(context, item, info, axes, spec);
  if (const DraftKey* priority = item.find("priority")) {
    spec.priority = static_cast<int>(
        core::read_integer(*priority->node, 1, 1000, context.diagnostics).value_or(1));
  }
  AxesScope scope{names, positions, positions, 0, info.of_joints(), false};
  compile_gains(context, item, draft, info, scope, specs);
  compile_reference(context, item, scope, spec, specs);
  scope.dimensions = accelerations;
  compile_limits(context, item, "acceleration_limit", scope, &AxisSpec::acceleration_limit, specs);
  scope.dimensions = scaled(positions, core::kTime);
  compile_limits(context, item, "integral_limit", scope, &AxisSpec::integral_limit, specs);
  warn_idle_limit(context, item, info, specs);
  scope.dimensions.assign(positions.size(), core::kNone);
  compile_limits(context, item, "weight", scope, &AxisSpec::weight, specs);
  spec.instance = find_instance(context, item, spec.type, spec.point);
  spec.axes = {static_cast<int>(context.behavior.axes.size()), static_cast<int>(specs.size())};
  context.behavior.axes.insert(context.behavior.axes.end(), specs.begin(), specs.end());
  return spec;
}

}  // namespace footfall::behaviors
