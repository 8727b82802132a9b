// Compiles values by axis to expressions; see axes.h.
#include "behaviors/load/control/axes.h"

#include <fmt/format.h>

#include <numeric>

#include "core/diagnostics/did_you_mean.h"
#include "core/yaml/glob.h"

namespace footfall::behaviors {
namespace {

int compile_axis(LoadContext& context, const core::YamlNode& node, const AxesScope& axes,
                 std::size_t k) {
  ValueScope scope;
  scope.state = axes.owner;
  if (axes.entry) {
    scope.entry_axes = &axes.names;
    scope.entry_axis = static_cast<int>(k);
    scope.entry_dimensions = &axes.positions;
  }
  return context.compile_value(node, axes.dimensions[k], scope);
}

void report_dimension(LoadContext& context, const core::YamlNode& node, core::Dimension expected,
                      core::Dimension got) {
  context.error(node.mark, "dimension",
                fmt::format("expected {}, got {}", core::dimension_name(expected),
                            core::dimension_name(got)));
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
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!info.bare && !(info.dimension == axes.dimensions[k])) {
      report_dimension(context, node, axes.dimensions[k], info.dimension);
      return true;
    }
    const int slot = info.slot + static_cast<int>(k);
    out[k] = context.remember_place(
        context.behavior.expressions.add_parameter(slot, axes.dimensions[k]), node.mark);
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
    if (!(dimension == axes.dimensions[k])) {
      report_dimension(context, node, axes.dimensions[k], dimension);
      return true;
    }
    out[k] = context.remember_place(context.behavior.expressions.add_signal(found[k], dimension),
                                    node.mark);
  }
  return true;
}

}  // namespace

std::optional<tasks::TaskType> require_task_type(const core::YamlNode& node,
                                                 core::Diagnostics& diagnostics) {
  if (!core::expect_scalar(node, "a type of task", diagnostics)) return std::nullopt;
  if (const auto type = tasks::find_task_type(node.scalar)) return type;
  std::vector<std::string> names;
  for (const tasks::TaskTypeRow& row : tasks::kTaskTypes) names.emplace_back(row.info.name);
  diagnostics.error(node.mark, "unknown-task-type",
                    fmt::format("unknown task type '{}'{}", node.scalar,
                                core::did_you_mean_or_list(node.scalar, names)));
  return std::nullopt;
}

std::vector<int> read_axes(const LoadContext& context, tasks::TaskType type,
                           const core::YamlNode* axes, core::Diagnostics& diagnostics) {
  const std::vector<std::string> names = tasks::axis_names(type, context.behavior.robot);
  if (axes == nullptr) {
    std::vector<int> all(names.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const char* what = tasks::info(type).of_joints() ? "joint" : "axis";
  return core::expand_names(*axes, names, what, diagnostics);
}

std::vector<core::Dimension> scaled(const std::vector<core::Dimension>& positions,
                                    core::Dimension factor) {
  std::vector<core::Dimension> out;
  for (const core::Dimension position : positions) out.push_back(position * factor);
  return out;
}

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
    core::report_expected(node, "a value", context.diagnostics);
  } else if (!compile_parameter(context, node, axes, out) &&
             !compile_signals(context, node, axes, out)) {
    for (std::size_t k = 0; k < out.size(); ++k) {
      out[k] = compile_axis(context, node, axes, k);
      if (out[k] < 0) break;  // further errors would repeat the first one
    }
  }
  return out;
}

}  // namespace footfall::behaviors
