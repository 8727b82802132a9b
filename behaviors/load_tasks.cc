// Tasks of a draft: type, axes, point, gains, limits; see load_tasks.h.
#include "behaviors/load_tasks.h"

#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language.h"
#include "behaviors/load_gains.h"

namespace footfall::behaviors {
namespace {

using tasks::TaskType;

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

// Where an axis is written: its entry in `axes` or `joints`, if there is one for each.
core::Mark axis_mark(const DraftItem& item, const DraftKey* axes, std::size_t k,
                     std::size_t count) {
  if (axes == nullptr) return item.mark;
  const bool listed = axes->node->is_sequence() && axes->node->items.size() == count;
  return listed ? axes->node->items[k].mark : axes->node->mark;
}

// Gains written in the task, else those a state gives, innermost first, else the stack's table.
GainEntry* choose_gains(LoadContext& context, const DraftItem& item, const Draft& draft) {
  if (const DraftKey* own = item.find("gains")) {
    if (own->node->is_map()) return inline_gains(context, item.gains_owner, item.name, *own->node);
    if (!own->node->is_scalar()) {
      core::report_expected(*own->node, "gains", context.diagnostics);
      return nullptr;
    }
    if (!require_gain_table(context, *own->node)) return nullptr;
    if (GainEntry* entry = find_gains(context, own->node->scalar, item.name)) return entry;
  }
  std::string tables;
  for (auto gains = draft.gains.rbegin(); gains != draft.gains.rend(); ++gains) {
    if (gains->node->is_map()) {
      if (const core::YamlNode* entry = gains->node->find(item.name)) {
        const auto& path = context.behavior.states[static_cast<std::size_t>(gains->owner)].path;
        return inline_gains(context, path, item.name, *entry);
      }
      continue;
    }
    if (!require_gain_table(context, *gains->node)) return nullptr;
    if (GainEntry* entry = find_gains(context, gains->node->scalar, item.name)) return entry;
    tables += fmt::format("{}'{}'", tables.empty() ? "" : " and ", gains->node->scalar);
  }
  context.error(item.mark, "no-gains",
                tables.empty() ? fmt::format("task '{}' has no gains", item.name)
                               : fmt::format("task '{}' has no gains: none in it, none in table {}",
                                             item.name, tables));
  return nullptr;
}

void compile_gains(LoadContext& context, const DraftItem& item, const Draft& draft,
                   const TaskTypeInfo& type, const std::vector<std::string>& axes,
                   std::vector<AxisSpec>& out) {
  GainEntry* entry = choose_gains(context, item, draft);
  if (entry == nullptr) return;
  if (type.type == TaskType::joint_damping) {
    for (const char* key : {"kp", "ki"}) {
      if (const auto* node = entry->node->find(key)) {
        context.error(node->mark, "misplaced-key",
                      fmt::format("joint_damping has kd only, no {}", key));
      }
    }
  }
  use_gains(context, *entry, {axes, type.joints}, out);
}

void compile_frame(LoadContext& context, const DraftItem& item, TaskSpec& spec) {
  const bool orientation = spec.type == TaskType::body_orientation;
  spec.frame = orientation ? tasks::Frame::heading : tasks::Frame::world;
  const DraftKey* key = item.find("frame");
  if (key == nullptr) return;
  const std::string expected = orientation ? "heading" : "world";
  if (key->node->scalar == expected) return;
  const auto choice = core::read_choice(*key->node, kFrames, context.diagnostics, "a frame");
  if (choice) {
    context.error(key->node->mark, "not-available",
                  fmt::format("frame '{}' of a {} is not available in this version (expected {})",
                              key->node->scalar, item.find("type")->node->scalar, expected));
  }
}

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

void check_task_keys(LoadContext& context, const DraftItem& item, const TaskTypeInfo& type) {
  const std::vector<std::string> known = core::key_names(kTaskKeys, type.name);
  core::YamlNode map;  // the merged keys, for check_keys
  map.kind = core::YamlNode::Kind::map;
  for (const DraftKey& key : item.keys) {
    if (key.key == "doc") core::check_doc(*key.node, context.diagnostics);
    if (std::find(known.begin(), known.end(), key.key) != known.end()) continue;
    map.entries.push_back({key.key, key.mark, false, {}});
  }
  core::check_keys(map, known, context.diagnostics);
}

}  // namespace

std::optional<TaskSpec> compile_task(LoadContext& context, const DraftItem& item,
                                     const Draft& draft) {
  const DraftKey* type_key = item.find("type");
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
  const TaskTypeInfo* type = require_task_type(*type_key->node, context.diagnostics);
  if (type == nullptr) return std::nullopt;
  check_task_keys(context, item, *type);
  TaskSpec spec;
  spec.type = type->type;
  spec.mark = item.mark;
  if (type->type == TaskType::point_position) {
    const DraftKey* point = item.find("point");
    if (point == nullptr) {
      context.error(item.mark, "missing-key", fmt::format("task '{}' needs a `point`", item.name));
      return std::nullopt;
    }
    spec.point = find_point(context, *point->node);
    if (spec.point < 0) return std::nullopt;
  }
  const DraftKey* axes_key = item.find(type->joints ? "joints" : "axes");
  const int before = context.diagnostics.error_count();
  const std::vector<int> axes = read_axes(
      context, *type, axes_key == nullptr ? nullptr : axes_key->node, context.diagnostics);
  if (context.diagnostics.error_count() != before) return std::nullopt;
  if (axes.empty()) {
    if (axes_key != nullptr && axes_key->node->is_sequence() && axes_key->node->items.empty()) {
      context.error(axes_key->node->mark, "empty-value",
                    fmt::format("`{}: []` leaves nothing to control: name some, or remove the task "
                                "with `{}: off`",
                                axes_key->key, item.name));
    }
    return std::nullopt;
  }
  const std::vector<std::string> all = all_axes(context, *type);
  std::vector<std::string> names;
  std::vector<AxisSpec> specs;
  for (const int axis : axes) {
    names.push_back(all[static_cast<std::size_t>(axis)]);
    specs.emplace_back();
    specs.back().axis = axis;
    specs.back().mark = axis_mark(item, axes_key, specs.size() - 1, axes.size());
  }
  compile_frame(context, item, spec);
  if (const DraftKey* priority = item.find("priority")) {
    spec.priority = static_cast<int>(
        core::read_integer(*priority->node, 1, 1000, context.diagnostics).value_or(1));
  }
  compile_gains(context, item, draft, *type, names, specs);
  spec.weight = compile_limit(context, item, "weight", core::kNone);
  spec.acceleration_limit = compile_limit(context, item, "acceleration_limit",
                                          type->angular ? core::kRateSquared : core::kAcceleration);
  spec.integral_limit =
      compile_limit(context, item, "integral_limit", type->position() * core::kTime);
  const bool integrates =
      std::any_of(specs.begin(), specs.end(), [](const AxisSpec& axis) { return axis.ki >= 0; });
  if (const DraftKey* limit = item.find("integral_limit"); limit != nullptr && !integrates) {
    context.warning(limit->node->mark, "no-effect", "`integral_limit` without ki has no effect");
  }
  compile_reference(context, item, *type, names, spec, specs);
  spec.instance = find_instance(context, item, spec.type, spec.point);
  spec.axes = {static_cast<int>(context.behavior.axes.size()), static_cast<int>(specs.size())};
  context.behavior.axes.insert(context.behavior.axes.end(), specs.begin(), specs.end());
  return spec;
}

std::optional<InternalSpec> compile_internal(LoadContext& context, const DraftItem& item) {
  core::YamlNode map;
  map.kind = core::YamlNode::Kind::map;
  for (const DraftKey& key : item.keys) map.entries.push_back({key.key, key.mark, false, {}});
  core::check_keys(map, kInternalKeys, context.diagnostics);
  const DraftKey* between = item.find("between");
  const DraftKey* reference = item.find("reference");
  if (between == nullptr || reference == nullptr) {
    context.error(item.mark, "missing-key",
                  fmt::format("internal force '{}' needs `between` and `reference`", item.name));
    return std::nullopt;
  }
  if (between->node->is_scalar() && between->node->scalar == "all") {
    context.error(between->node->mark, "not-available",
                  "'between: all' is not available in this version");
    return std::nullopt;
  }
  if (!between->node->is_sequence() || between->node->items.size() != 2) {
    core::report_expected(*between->node, "two contacts", context.diagnostics);
    return std::nullopt;
  }
  InternalSpec spec;
  spec.contact_a = context.require_contact(between->node->items[0]);
  spec.contact_b = context.require_contact(between->node->items[1]);
  if (spec.contact_a < 0 || spec.contact_b < 0) return std::nullopt;
  if (spec.contact_a == spec.contact_b) {
    context.error(between->node->items[1].mark, "same-foot",
                  "an internal force acts between two feet, not one");
  }
  ValueScope scope;
  scope.state = reference->owner;
  spec.mark = reference->node->mark;
  spec.reference = context.compile_value(*reference->node, core::kForce, scope);
  spec.feedback = compile_limit(context, item, "feedback", core::kNone);
  if (const DraftKey* convention = item.find("convention")) {
    const auto choice = core::read_choice(*convention->node, kConventions, context.diagnostics);
    if (choice && *choice == 1) spec.scale = 0.5;
  }
  const auto& names = context.behavior.internal_instances;
  while (names[static_cast<std::size_t>(spec.instance)] != item.name) ++spec.instance;
  return spec;
}

}  // namespace footfall::behaviors
