// The reference of a task: a value an axis, or a trajectory.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language.h"
#include "behaviors/load_tasks.h"
#include "core/glob.h"

namespace footfall::behaviors {
namespace {

// `true`, `false`, or the part of the trajectory's time during which it follows.
double read_retarget(const core::YamlNode& node, core::Diagnostics& diagnostics) {
  constexpr double kUsual = 0.8;
  if (node.scalar == "true" || node.scalar == "false" || !node.is_scalar()) {
    return core::read_bool(node, diagnostics).value_or(false) ? kUsual : 0.0;
  }
  return core::read_bounded(node, core::kNone, 0.0, 0.95, diagnostics,
                            "true, false or a part of the time")
      .value_or(0.0);
}

// Where the values of a task's axes are written.
struct AxesScope {
  const std::vector<std::string>& names;
  core::Dimension dimension;  // of the values
  core::Dimension position;   // of the task
  int owner = 0;
  bool joints = false;
};

int compile_axis(LoadContext& context, const core::YamlNode& node, const AxesScope& axes,
                 std::size_t k) {
  ValueScope scope;
  scope.state = axes.owner;
  scope.entry_axes = &axes.names;
  scope.entry_axis = static_cast<int>(k);
  scope.entry_dimension = axes.position;
  return context.compile_value(node, axes.dimension, scope);
}

// A vector parameter, by axis x y z or in the axes' order.
bool compile_parameter(LoadContext& context, const core::YamlNode& node, const AxesScope& axes,
                       std::vector<int>& out) {
  if (!core::is_reference(node)) return false;
  const int index = context.behavior.find_parameter(node.scalar.substr(1));
  if (index < 0) return false;
  const ParameterInfo& info = context.behavior.parameters[static_cast<std::size_t>(index)];
  if (info.size == 1) return false;
  if (info.size != static_cast<int>(axes.names.size())) {
    context.error(node.mark, "size",
                  fmt::format("parameter '{}' has {} values, the task has {} axes", info.name,
                              info.size, axes.names.size()));
    return true;
  }
  if (!info.bare && !(info.dimension == axes.dimension)) {
    context.error(node.mark, "dimension",
                  fmt::format("expected {}, got {}", core::dimension_name(axes.dimension),
                              core::dimension_name(info.dimension)));
    return true;
  }
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k] =
        context.behavior.expressions.add_parameter(info.slot + static_cast<int>(k), axes.dimension);
  }
  return true;
}

// A vector of signals, e.g. planner.foot.target.
bool compile_signals(LoadContext& context, const core::YamlNode& node, const AxesScope& axes,
                     std::vector<int>& out) {
  const core::SignalTable& signals = context.behavior.signals;
  std::vector<int> found;
  for (const std::string& name : axes.names) {
    found.push_back(signals.find(node.scalar + "." + name));
    if (found.back() < 0) return false;
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    const core::Dimension dimension = signals.info(found[k]).dimension;
    if (!(dimension == axes.dimension)) {
      context.error(node.mark, "dimension",
                    fmt::format("expected {}, got {}", core::dimension_name(axes.dimension),
                                core::dimension_name(dimension)));
      return true;
    }
    out[k] = context.behavior.expressions.add_signal(found[k], dimension);
  }
  return true;
}

// One expression an axis; -1 where nothing is said, which only `partial` allows.
std::vector<int> compile_axes(LoadContext& context, const core::YamlNode& node,
                              const AxesScope& axes, bool partial) {
  std::vector<int> out(axes.names.size(), -1);
  if (node.is_sequence()) {
    if (node.items.size() != axes.names.size()) {
      context.error(node.mark, "size",
                    fmt::format("expected {} values, one for each of {}, got {}", axes.names.size(),
                                fmt::join(axes.names, " "), node.items.size()));
      return out;
    }
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = compile_axis(context, node.items[k], axes, k);
    }
  } else if (node.is_map()) {
    const auto entries =
        core::match_names(node, axes.names, axes.joints ? "joint" : "axis", context.diagnostics);
    for (std::size_t k = 0; k < entries.size(); ++k) {
      if (entries[k] != nullptr) {
        out[k] = compile_axis(context, entries[k]->value, axes, k);
      } else if (!partial) {
        context.error(node.mark, "missing-key", fmt::format("no value for '{}'", axes.names[k]));
      }
    }
  } else if (node.is_null()) {
    core::report_expected(node, "a reference", context.diagnostics);
  } else if (!compile_parameter(context, node, axes, out) &&
             !compile_signals(context, node, axes, out)) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = compile_axis(context, node, axes, k);
  }
  return out;
}

// The value of each axis and where it is written.
void set_values(const core::YamlNode& node, const std::vector<int>& values,
                std::vector<AxisSpec>& out) {
  const bool listed = node.is_sequence() && node.items.size() == out.size();
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].value = values[k];
    out[k].value_mark = listed ? node.items[k].mark : node.mark;
  }
}

std::optional<Shape> read_shape(LoadContext& context, const core::YamlNode& map) {
  const core::YamlNode& name = *map.find("trajectory");
  for (const char* later : {"ellipse", "waypoints", "surface"}) {
    if (name.scalar != later) continue;
    context.error(name.mark, "not-available",
                  fmt::format("trajectory '{}' is not available in this version", later));
    return std::nullopt;
  }
  const auto choice = core::read_choice(name, kTrajectories, context.diagnostics, "a trajectory");
  if (!choice) return std::nullopt;
  const core::YamlNode* order = map.find("order");
  if (*choice != 1 && order != nullptr) {
    context.error(order->mark, "misplaced-key", "only a polynomial has an order");
  }
  if (*choice != 1) {
    return *choice == 0 ? Shape::hold : *choice == 2 ? Shape::cosine : Shape::minimum_jerk;
  }
  if (order == nullptr) {
    context.error(map.mark, "missing-key", "a polynomial needs `order: 3` or `order: 5`");
    return std::nullopt;
  }
  if (order->scalar != "3" && order->scalar != "5") {
    context.error(order->mark, "expected",
                  fmt::format("expected order 3 or 5, got {}", core::describe(*order)));
    return std::nullopt;
  }
  return order->scalar == "3" ? Shape::polynomial3 : Shape::polynomial5;
}

void compile_trajectory(LoadContext& context, const core::YamlNode& map, AxesScope axes,
                        ReferenceSpec& reference, std::vector<AxisSpec>& out) {
  core::check_keys(map, kTrajectoryKeys, context.diagnostics);
  const auto shape = read_shape(context, map);
  if (!shape) return;
  reference.kind = ReferenceSpec::Kind::trajectory;
  reference.shape = *shape;
  const core::YamlNode* to = map.find("to");
  const core::YamlNode* over = map.find("over");
  const core::YamlNode* end_velocity = map.find("end_velocity");
  if (*shape == Shape::hold) {
    for (const core::YamlNode* node : {to, over, end_velocity}) {
      if (node != nullptr) {
        context.error(node->mark, "misplaced-key", "`hold` stays where it is: no to, no over");
      }
    }
    return;
  }
  if (to == nullptr || over == nullptr) {
    context.error(map.mark, "missing-key", "a trajectory needs `to` and `over`");
    return;
  }
  ValueScope scope;
  scope.state = axes.owner;
  reference.over = context.compile_time(*over, scope);
  reference.over_mark = over->mark;
  set_values(*to, compile_axes(context, *to, axes, true), out);
  if (end_velocity != nullptr) {
    if (*shape == Shape::cosine) {
      context.error(end_velocity->mark, "misplaced-key",
                    "a cosine ends at rest: take polynomial or minimum_jerk");
    }
    axes.dimension = axes.position / core::kTime;
    const std::vector<int> speeds = compile_axes(context, *end_velocity, axes, true);
    for (std::size_t k = 0; k < out.size(); ++k) out[k].end_velocity = speeds[k];
  }
  if (const auto* retarget = map.find("retarget")) {
    reference.retarget = read_retarget(*retarget, context.diagnostics);
  }
}

}  // namespace

void compile_reference(LoadContext& context, const DraftItem& item, const TaskTypeInfo& type,
                       const std::vector<std::string>& axes, TaskSpec& spec,
                       std::vector<AxisSpec>& out) {
  if (type.type == tasks::TaskType::joint_damping) return;
  const DraftKey* key = item.find("reference");
  if (key == nullptr) {
    context.error(item.mark, "missing-key",
                  fmt::format("task '{}' needs a `reference`", item.name));
    return;
  }
  const AxesScope scope{axes, type.position(), type.position(), key->owner, type.joints};
  spec.reference.owner = key->owner;
  if (key->node->find("trajectory") != nullptr) {
    compile_trajectory(context, *key->node, scope, spec.reference, out);
    return;
  }
  spec.reference.kind = ReferenceSpec::Kind::value;
  set_values(*key->node, compile_axes(context, *key->node, scope, false), out);
}

}  // namespace footfall::behaviors
