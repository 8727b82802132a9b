// `planners:`, type velocity_reversal.
#include <fmt/format.h>

#include <limits>

#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
const std::vector<std::string> kAxes = {"x", "y"};

void read_pair(LoadContext& context, const core::YamlNode& map, const char* key,
               core::Dimension dimension, std::array<double, 2>& out) {
  const core::YamlNode* node = map.find(key);
  if (node == nullptr) return;
  const auto values = core::read_vector(*node, dimension, kAxes, context.diagnostics);
  if (values) out = {(*values)[0], (*values)[1]};
}

// Default range of kappa. [Kim16] prints kappa with the wrong sign, and with a negative kappa every
// step is longer than the last one.
constexpr std::array<double, 2> kKappaRange = {0.0, 1.0};

void check_kappa(LoadContext& context, core::Mark mark, const double* values, int count,
                 const std::array<double, 2>& range) {
  for (int k = 0; k < count; ++k) {
    if (values[k] >= range[0] && values[k] <= range[1]) continue;
    context.error(mark, "out-of-range",
                  fmt::format("kappa {:g} is outside {:g} .. {:g}; to allow it give `kappa` a "
                              "`value` and a `range`, or a parameter with one",
                              values[k], range[0], range[1]));
    return;
  }
}

void read_kappa_parameter(LoadContext& context, const core::YamlNode& node, PlannerInfo& planner) {
  const std::string name = node.scalar.substr(1);
  const int index = context.behavior.find_parameter(name);
  if (index < 0) {
    context.error(node.mark, "unknown-parameter",
                  fmt::format("unknown parameter '${}'{}", name,
                              core::did_you_mean(name, context.parameter_names())));
    return;
  }
  const ParameterInfo& info = context.behavior.parameters[static_cast<std::size_t>(index)];
  if (info.size > 2) {
    context.error(node.mark, "size",
                  fmt::format("kappa has 1 or 2 values, '{}' has {}", name, info.size));
    return;
  }
  if (!info.bare && !(info.dimension == core::kNone)) {
    context.error(node.mark, "dimension",
                  fmt::format("expected a number, got {}", core::dimension_name(info.dimension)));
    return;
  }
  const std::array<double, 2> range =
      info.has_range() ? std::array<double, 2>{info.min, info.max} : kKappaRange;
  check_kappa(context, node.mark, &context.behavior.values[static_cast<std::size_t>(info.slot)],
              info.size, range);
  planner.kappa_parameter = index;
  planner.kappa_slot = info.slot;
  planner.kappa_size = info.size;
}

// `[x, y]`, one number, by axis, `$parameter`, or any of the first three under `value` with a
// `range`.
void read_kappa(LoadContext& context, const core::YamlNode& map, PlannerInfo& planner) {
  const core::YamlNode* node = map.find("kappa");
  if (node == nullptr) return;
  if (core::is_reference(*node)) {
    read_kappa_parameter(context, *node, planner);
    return;
  }
  std::array<double, 2> range = kKappaRange;
  if (node->find("value") != nullptr) {
    core::check_keys(*node, kKappaKeys, context.diagnostics);
    if (const auto* given = node->find("range")) {
      range = core::read_range(*given, core::kNone, context.diagnostics).value_or(range);
    }
    node = node->find("value");
  }
  const auto values = core::read_vector(*node, core::kNone, kAxes, context.diagnostics);
  if (!values) return;
  planner.spec.kappa = {(*values)[0], (*values)[1]};
  check_kappa(context, node->mark, values->data(), 2, range);
}

void read_limit(LoadContext& context, const core::YamlNode& map, const char* key,
                core::Dimension dimension, double& out) {
  const core::YamlNode* node = map.find(key);
  if (node == nullptr) return;
  out = core::read_bounded(*node, dimension, 0.0, kInfinity, context.diagnostics).value_or(0.0);
}

void read_goal(LoadContext& context, const core::YamlNode& map, PlannerInfo& planner) {
  planner.goal = {0.0, 0.0};
  const core::YamlNode* node = map.find("goal");
  if (node == nullptr) return;
  if (!core::is_reference(*node)) {
    const auto values = core::read_vector(*node, core::kLength, kAxes, context.diagnostics);
    if (values) planner.goal = *values;
    return;
  }
  const std::string name = node->scalar.substr(1);
  const int index = context.behavior.find_parameter(name);
  if (index < 0) {
    context.error(node->mark, "unknown-parameter",
                  fmt::format("unknown parameter '${}'{}", name,
                              core::did_you_mean(name, context.parameter_names())));
    return;
  }
  ParameterInfo& info = context.behavior.parameters[static_cast<std::size_t>(index)];
  if (info.size != 2) {
    context.error(node->mark, "size",
                  fmt::format("a goal has 2 values, '{}' has {}", name, info.size));
  } else if (!info.bare && !(info.dimension == core::kLength)) {
    context.error(node->mark, "dimension",
                  fmt::format("expected a length, got {}", core::dimension_name(info.dimension)));
  } else {
    planner.goal_slot = info.slot;
    info.dimension = core::kLength;  // from here on `[0, 0]` is a position
    info.bare = false;
  }
}

void read_reach(LoadContext& context, const core::YamlNode& map, FootPlannerSpec& spec) {
  const core::YamlNode* reach = map.find("reach");
  if (reach == nullptr || !core::expect_map(*reach, "a map with x and y", context.diagnostics)) {
    return;
  }
  core::check_keys(*reach, kReachKeys, context.diagnostics);
  read_limit(context, *reach, "x", core::kLength, spec.reach_x);
  const core::YamlNode* y = reach->find("y");
  if (y == nullptr) return;
  if (const auto range = core::read_range(*y, core::kLength, context.diagnostics)) {
    spec.min_width = (*range)[0];
    spec.max_width = (*range)[1];
    if (spec.min_width < 0.0) {
      context.error(y->mark, "out-of-range", "a step width cannot be negative");
    }
  }
}

void read_extension(LoadContext& context, const core::YamlNode& map, FootPlannerSpec& spec) {
  const core::YamlNode* extension = map.find("extension");
  if (extension == nullptr || core::is_off(*extension)) return;
  if (!core::expect_map(*extension, "a map with speed and limit", context.diagnostics)) return;
  core::check_keys(*extension, kExtensionKeys, context.diagnostics);
  read_limit(context, *extension, "speed", core::kVelocity, spec.extension_speed);
  read_limit(context, *extension, "limit", core::kTime, spec.extension_limit);
}

void load_planner(LoadContext& context, const core::YamlEntry& entry) {
  if (!core::check_name(entry, context.diagnostics, "the name of a planner")) return;
  const core::YamlNode& map = entry.value;
  if (!core::expect_map(map, "a planner", context.diagnostics)) return;
  if (const auto* type = core::require_key(map, "type", context.diagnostics)) {
    core::read_choice(*type, kPlannerTypes, context.diagnostics, "a type of planner");
  }
  core::check_keys(map, kPlannerKeys, context.diagnostics);
  PlannerInfo planner;
  planner.name = entry.key;
  planner.mark = map.find("kappa") != nullptr ? map.find("kappa")->mark : entry.key_mark;
  FootPlannerSpec& spec = planner.spec;
  read_kappa(context, map, planner);
  read_pair(context, map, "reversal", core::kTime, spec.reversal);
  for (const double time : spec.reversal) {
    if (time > 0.0) continue;
    context.error(map.find("reversal")->mark, "out-of-range",
                  "the time to velocity reversal must be above 0 s");
    break;
  }
  core::read_quantity(map, "width_offset", core::kLength, spec.width_offset, context.diagnostics);
  read_limit(context, map, "goal_error_limit", core::kLength, spec.goal_error_limit);
  read_limit(context, map, "goal_speed", core::kVelocity, spec.goal_speed);
  read_limit(context, map, "velocity_filter", core::kTime, spec.velocity_filter);
  const double period = 1e3 / static_cast<double>(context.behavior.rate_mhz);
  if (spec.velocity_filter > 0.0 && spec.velocity_filter < period) {
    context.error(map.find("velocity_filter")->mark, "out-of-range",
                  fmt::format("the time constant must be 0 s (off) or at least one tick, {:.4g} ms",
                              1e3 * period));
  }
  read_reach(context, map, spec);
  read_extension(context, map, spec);
  read_goal(context, map, planner);
  for (const char* what : {"done", "late", "failed"}) {
    const int event = context.add_event(fmt::format("planner.{}.{}", planner.name, what));
    (what[0] == 'd'   ? planner.done_event
     : what[0] == 'l' ? planner.late_event
                      : planner.failed_event) = event;
  }
  context.behavior.planners.push_back(std::move(planner));
}

}  // namespace

void load_planners(LoadContext& context) {
  const core::YamlNode* section = context.section("planners");
  if (section == nullptr || !core::expect_map(*section, "planners by name", context.diagnostics)) {
    return;
  }
  if (!context.behavior.has_robot && !section->entries.empty()) {
    context.error(section->mark, "needs-robot", "planners need a robot: this behavior names none");
    return;
  }
  for (const core::YamlEntry& entry : section->entries) load_planner(context, entry);
  if (context.behavior.planners.size() > static_cast<std::size_t>(core::kMaxPlanners)) {
    context.error(section->mark, "too-many",
                  fmt::format("at most {} planners", core::kMaxPlanners));
  }
}

}  // namespace footfall::behaviors
