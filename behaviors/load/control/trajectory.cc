// `reference: {trajectory: ...}`: allowed keys of each shape, and their values.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "behaviors/language/language.h"
#include "behaviors/load/control/tasks.h"

namespace footfall::behaviors {
namespace {

constexpr std::size_t kMaxWaypoints = 32;

// The YAML nodes of a trajectory's keys.
struct Words {
  const core::YamlNode& map;
  std::string_view name;
  const core::YamlNode* find(std::string_view key) const { return map.find(key); }
};

// Why a key is not allowed for a shape.
std::string_view why_not(std::string_view key, std::string_view shape) {
  if (shape == "hold" && (key == "to" || key == "over" || key == "end_velocity")) {
    return "`hold` stays where it is: no to, no over";
  }
  if (key == "order") return "only a polynomial has an order";
  if (key == "to") return "each of the `points` has its own `to`";
  if (key == "end_velocity") return "a cosine ends at rest: take polynomial or minimum_jerk";
  if (key == "retarget") return "hold, ellipses and waypoints are read at entry: no retarget";
  if (key == "points") return "only waypoints have `points`";
  return "only an ellipse has `radius`, `period`, `phase`, `direction` and `ramp`";
}

void check_trajectory_keys(LoadContext& context, const Words& words) {
  core::check_keys(words.map, kTrajectoryKeys, context.diagnostics);
  for (const core::KeySpec& key : kTrajectoryKeys.keys) {
    const core::YamlNode* node = words.find(key.name);
    if (node == nullptr || core::belongs_to(key, words.name)) continue;
    context.error(node->mark, "misplaced-key", std::string(why_not(key.name, words.name)));
  }
}

std::optional<Shape> read_shape(LoadContext& context, const Words& words) {
  constexpr std::array<Shape, 7> kShapes = {
      Shape::hold,    Shape::polynomial3, Shape::cosine, Shape::minimum_jerk,
      Shape::ellipse, Shape::waypoints,   Shape::surface};
  const auto choice = core::read_choice(*words.find("trajectory"), kTrajectories,
                                        context.diagnostics, "a trajectory");
  if (!choice) return std::nullopt;
  const Shape shape = kShapes[static_cast<std::size_t>(*choice)];
  if (shape != Shape::polynomial3) return shape;
  const core::YamlNode* order = words.find("order");
  if (order == nullptr) {
    context.error(words.map.mark, "missing-key", "a polynomial needs `order: 3` or `order: 5`");
    return std::nullopt;
  }
  if (order->scalar != "3" && order->scalar != "5") {
    context.error(order->mark, "expected",
                  fmt::format("expected order 3 or 5, got {}", core::describe(*order)));
    return std::nullopt;
  }
  return order->scalar == "3" ? Shape::polynomial3 : Shape::polynomial5;
}

int compile_owned_time(LoadContext& context, const core::YamlNode& node, int owner,
                       const TimeRule& rule = {}) {
  ValueScope scope;
  scope.state = owner;
  return context.compile_time(node, scope, rule);
}

// Compiles a positive time.
int compile_span(LoadContext& context, const core::YamlNode& node, int owner) {
  return compile_owned_time(context, node, owner, {.positive = true});
}

// `true`, `false`, or the fraction of the trajectory's time during which it follows.
double read_retarget(const core::YamlNode& node, core::Diagnostics& diagnostics) {
  constexpr double kUsual = 0.8;
  if (node.scalar == "true" || node.scalar == "false" || !node.is_scalar()) {
    return core::read_bool(node, diagnostics).value_or(false) ? kUsual : 0.0;
  }
  return core::read_bounded(node, core::kNone, 0.0, 0.95, diagnostics,
                            "true, false or a part of the time")
      .value_or(0.0);
}

// `to`, `over`, `end_velocity`: of a single segment, of an ellipse's centre, above a surface.
void compile_goal(LoadContext& context, const Words& words, AxesScope axes, bool required,
                  ReferenceSpec& reference, std::vector<AxisSpec>& out) {
  const core::YamlNode* to = words.find("to");
  const core::YamlNode* over = words.find("over");
  if ((to == nullptr || over == nullptr) && (required || to != over)) {
    context.error(words.map.mark, "missing-key", "a trajectory needs `to` and `over`");
    return;
  }
  const core::YamlNode* end_velocity = words.find("end_velocity");
  if (to == nullptr) {
    if (end_velocity != nullptr) {
      context.error(end_velocity->mark, "misplaced-key", "`end_velocity` needs `to` and `over`");
    }
    return;
  }
  reference.over = compile_owned_time(context, *over, axes.owner);
  reference.over_mark = over->mark;
  set_values(*to, compile_axes(context, *to, axes, true), out);
  if (const core::YamlNode* retarget = words.find("retarget")) {
    reference.retarget = read_retarget(*retarget, context.diagnostics);
  }
  if (end_velocity == nullptr) return;
  axes.dimensions = scaled(axes.positions, core::kRate);
  const std::vector<int> speeds = compile_axes(context, *end_velocity, axes, true);
  for (std::size_t k = 0; k < out.size(); ++k) out[k].end_velocity = speeds[k];
}

void compile_ellipse(LoadContext& context, const Words& words, AxesScope axes,
                     ReferenceSpec& reference, std::vector<AxisSpec>& out) {
  const core::YamlNode* radius = words.find("radius");
  const core::YamlNode* period = words.find("period");
  if (radius == nullptr || period == nullptr) {
    context.error(words.map.mark, "missing-key", "an ellipse needs `radius` and `period`");
    return;
  }
  const std::vector<int> radii = compile_axes(context, *radius, axes, true);
  for (std::size_t k = 0; k < out.size(); ++k) out[k].radius = radii[k];
  if (const core::YamlNode* phase = words.find("phase")) {
    axes.dimensions.assign(axes.positions.size(), core::kNone);
    const std::vector<int> phases = compile_axes(context, *phase, axes, true);
    for (std::size_t k = 0; k < out.size(); ++k) out[k].phase = phases[k];
  }
  reference.period = compile_span(context, *period, axes.owner);
  if (const core::YamlNode* ramp = words.find("ramp")) {
    reference.ramp = compile_span(context, *ramp, axes.owner);
  }
  if (const core::YamlNode* direction = words.find("direction")) {
    const auto choice =
        core::read_choice(*direction, kDirections, context.diagnostics, "a direction");
    if (choice && *choice == 1) reference.direction = -1.0;
  }
}

// Passing time of a point: `at` (a time in the state or a fraction of `over`), `over` since the
// previous point, or, for the last point, the end of the trajectory's `over`.
void compile_when(LoadContext& context, const Words& words, const core::YamlNode& point, bool last,
                  int owner, WaypointSpec& spec) {
  const core::YamlNode* at = point.find("at");
  const core::YamlNode* over = point.find("over");
  if (at != nullptr && over != nullptr) {
    context.error(over->mark, "misplaced-key", "a point has `at` or `over`, not both");
    return;
  }
  const bool has_whole = words.find("over") != nullptr;
  if (at == nullptr && over == nullptr) {
    if (last && has_whole) return;
    context.error(point.mark, "missing-key",
                  "a point needs `at` (a time since entry) or `over` (since the point before)");
    return;
  }
  spec.after_previous = over != nullptr;
  const core::YamlNode& when = over != nullptr ? *over : *at;
  const auto quantity = when.is_scalar() ? core::parse_quantity(when.scalar) : std::nullopt;
  if (at == nullptr || !quantity || quantity->bare || !(quantity->dimension == core::kNone)) {
    spec.at = compile_span(context, when, owner);
    return;
  }
  spec.part = quantity->value;
  if (!has_whole) {
    context.error(when.mark, "missing-key",
                  fmt::format("'{}' of what? The trajectory has no `over`", when.scalar));
  } else if (spec.part <= 0.0 || spec.part > 1.0) {
    context.error(when.mark, "out-of-range",
                  fmt::format("expected a part of `over` up to 100 %, got '{}'", when.scalar));
  }
}

// Constant times must increase.
void check_growth(LoadContext& context, const core::YamlNode& points,
                  const std::vector<WaypointSpec>& specs) {
  std::optional<double> before = 0.0;
  for (std::size_t k = 0; k < specs.size(); ++k) {
    const auto value = context.constant_value(specs[k].at);
    if (!value || !before) {
      before = specs[k].after_previous ? std::nullopt : value;
      continue;
    }
    const double time = specs[k].after_previous ? *before + *value : *value;
    if (time <= *before) {
      context.error(
          points.items[k].mark, "out-of-range",
          fmt::format("this point comes at {} s, not after the one before ({} s)", time, *before));
    }
    before = time;
  }
}

void compile_waypoints(LoadContext& context, const Words& words, const AxesScope& axes,
                       ReferenceSpec& reference, std::vector<AxisSpec>& out) {
  const core::YamlNode* points = words.find("points");
  if (points == nullptr || !points->is_sequence() || points->items.empty()) {
    context.error(points == nullptr ? words.map.mark : points->mark, "missing-key",
                  "waypoints need `points: [{at: TIME, to: PLACE}, ...]`");
    return;
  }
  if (points->items.size() > kMaxWaypoints) {
    context.error(points->mark, "too-many",
                  fmt::format("{} points; at most {}", points->items.size(), kMaxWaypoints));
    return;
  }
  if (const core::YamlNode* over = words.find("over")) {
    reference.over = compile_span(context, *over, axes.owner);
    reference.over_mark = over->mark;
  }
  std::vector<WaypointSpec> specs;
  for (const core::YamlNode& point : points->items) {
    if (!core::expect_map(point, "{at: TIME, to: PLACE}", context.diagnostics)) continue;
    core::check_keys(point, kWaypointKeys, context.diagnostics);
    WaypointSpec& spec = specs.emplace_back();
    spec.to.assign(out.size(), -1);
    compile_when(context, words, point, &point == &points->items.back(), axes.owner, spec);
    if (const core::YamlNode* to = core::require_key(point, "to", context.diagnostics)) {
      spec.to = compile_axes(context, *to, axes, true);
    }
  }
  if (specs.size() == points->items.size()) check_growth(context, *points, specs);
  auto& all = context.behavior.waypoints;
  reference.waypoints = {static_cast<int>(all.size()), static_cast<int>(specs.size())};
  all.insert(all.end(), specs.begin(), specs.end());
  if (const core::YamlNode* end_velocity = words.find("end_velocity")) {
    AxesScope speeds = axes;
    speeds.dimensions = scaled(axes.positions, core::kRate);
    const std::vector<int> values = compile_axes(context, *end_velocity, speeds, true);
    for (std::size_t k = 0; k < out.size(); ++k) out[k].end_velocity = values[k];
  }
}

// A surface applies only to a height in the world frame.
void check_surface(LoadContext& context, const Words& words, const AxesScope& axes,
                   const TaskSpec& spec) {
  const bool has_velocity = tasks::info(spec.type).velocity != nullptr;  // of x, where z follows
  if (!has_velocity || axes.names != std::vector<std::string>{"z"} ||
      spec.frame != tasks::Frame::world) {
    context.error(words.find("trajectory")->mark, "misplaced-name",
                  "the surface is a height of the world: it goes with `axes: [z]` and `frame: "
                  "world` of a position");
  }
}

}  // namespace

void compile_trajectory(LoadContext& context, const core::YamlNode& map, const AxesScope& axes,
                        TaskSpec& spec, std::vector<AxisSpec>& out) {
  const Words words = {map, map.find("trajectory")->scalar};
  const auto shape = read_shape(context, words);
  if (!shape) return;
  check_trajectory_keys(context, words);
  ReferenceSpec& reference = spec.reference;
  reference.kind = ReferenceSpec::Kind::trajectory;
  reference.shape = *shape;
  switch (*shape) {
    case Shape::hold:
      return;
    case Shape::waypoints:
      compile_waypoints(context, words, axes, reference, out);
      return;
    case Shape::ellipse:
      compile_ellipse(context, words, axes, reference, out);
      compile_goal(context, words, axes, false, reference, out);
      return;
    case Shape::surface:
      check_surface(context, words, axes, spec);
      compile_goal(context, words, axes, false, reference, out);
      return;
    default:
      compile_goal(context, words, axes, true, reference, out);
  }
}

}  // namespace footfall::behaviors
