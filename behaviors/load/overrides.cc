// --set NAME=VALUE: edits the file's tree before anything is compiled, so that an override is
// checked exactly like the value that it replaces.
#include <fmt/format.h>

#include <charconv>
#include <span>

#include "behaviors/language/language.h"
#include "behaviors/load/context.h"
#include "behaviors/load/steps.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/dotted_name.h"
#include "model/robot/torque_loop.h"

namespace footfall::behaviors {
namespace {

std::vector<std::string> keys_of(const core::YamlNode& map) {
  std::vector<std::string> keys;
  for (const core::YamlEntry& entry : map.entries) keys.push_back(entry.key);
  return keys;
}

core::YamlNode* child(core::YamlNode& map, std::string_view key) {
  for (core::YamlEntry& entry : map.entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

void put_or_replace(core::YamlNode& map, const std::string& key, core::YamlNode value) {
  if (core::YamlNode* old = child(map, key)) {
    *old = std::move(value);
  } else {
    const core::Mark mark = value.mark;
    map.entries.push_back({key, mark, false, std::move(value)});
  }
}

// What `parts` lead to; nullptr if there is nothing.
core::YamlNode* look(core::YamlNode& start, std::span<const std::string> parts) {
  core::YamlNode* node = &start;
  for (const std::string& part : parts) {
    node = node->is_map() ? child(*node, part) : nullptr;
    if (node == nullptr) break;
  }
  return node;
}

// The map that `parts` lead to, nullptr and an error otherwise.
core::YamlNode* require_map(LoadContext& context, const std::string& name,
                            std::span<const std::string> parts, core::Mark mark) {
  core::YamlNode* node = &context.root;
  for (const std::string& part : parts) {
    core::YamlNode* const next = child(*node, part);
    if (next != nullptr && next->is_map()) {
      node = next;
      continue;
    }
    const std::string why = next != nullptr ? fmt::format("'{}' has no parts of this kind", part)
                                            : fmt::format("there is no '{}'{}", part,
                                                          core::did_you_mean(part, keys_of(*node)));
    context.error(mark, "unknown-setting", fmt::format("--set {}: {}", name, why));
    return nullptr;
  }
  return node;
}

// The unit of a value, or else of the range beside it.
std::optional<core::Dimension> written_dimension(const core::YamlNode& node) {
  if (node.is_scalar()) {
    const auto quantity = core::parse_quantity(node.scalar);
    return quantity && !quantity->bare ? std::optional(quantity->dimension) : std::nullopt;
  }
  for (const core::YamlNode& item : node.items) {
    if (const auto dimension = written_dimension(item)) return dimension;
  }
  for (const char* key : {"value", "range"}) {
    const core::YamlNode* part = node.find(key);
    const auto dimension = part == nullptr ? std::nullopt : written_dimension(*part);
    if (dimension) return dimension;
  }
  return std::nullopt;
}

// `NAME.AXIS` and `NAME[NUMBER]` in their two parts; the second one is empty if there is none.
std::array<std::string, 2> split_part(const std::string& name) {
  const bool numbered = name.ends_with(']');
  const std::size_t end = name.rfind(numbered ? '[' : '.');
  if (end == std::string::npos) return {name, ""};
  return {name.substr(0, end), name.substr(end + 1, name.size() - end - (numbered ? 2 : 1))};
}

// The value `x` or `1` of a list; nullptr if there is none.
core::YamlNode* item_of(core::YamlNode* list, const std::string& part) {
  constexpr std::string_view kAxes = "xyz";
  if (list == nullptr || !list->is_sequence()) return nullptr;
  std::size_t index = part.size() == 1 ? kAxes.find(part) : std::string_view::npos;
  const auto [stop, error] = std::from_chars(part.data(), part.data() + part.size(), index);
  const bool number = error == std::errc() && stop == part.data() + part.size();
  if (!number && index == std::string_view::npos) return nullptr;
  return index < list->items.size() ? &list->items[index] : nullptr;
}

// `goal.x`, `goal[0]`: one value of a parameter that is a list; nullptr if there is none.
core::YamlNode* component(core::YamlNode& parameters, const std::string& name) {
  const auto [whole, part] = split_part(name);
  core::YamlNode* list = part.empty() ? nullptr : child(parameters, whole);
  if (list != nullptr && list->is_map()) list = child(*list, "value");
  return item_of(list, part);
}

void set_parameter(LoadContext& context, const std::string& name, core::YamlNode value) {
  core::YamlNode* parameters = child(context.root, "parameters");
  core::YamlNode* parameter = parameters == nullptr ? nullptr : child(*parameters, name);
  if (parameter == nullptr && parameters != nullptr) parameter = component(*parameters, name);
  if (parameter == nullptr) {
    std::vector<std::string> known = {"estimator", "gains", "planners", "torque_loop"};
    if (parameters != nullptr) known = keys_of(*parameters);
    context.error(value.mark, "unknown-parameter",
                  fmt::format("--set {}: unknown parameter '{}'{}", name, name,
                              core::did_you_mean(name, known)));
    return;
  }
  const auto had = written_dimension(*parameter), has = written_dimension(value);
  if (had && has && !(*had == *has)) {
    context.error(value.mark, "dimension",
                  fmt::format("--set {}: expected {}, got {}", name, core::dimension_name(*had),
                              core::describe(value)));
  } else if (parameter->is_map()) {
    put_or_replace(*parameter, "value", std::move(value));
  } else {
    *parameter = std::move(value);
  }
}

bool is_gain(std::string_view key) { return key == "kp" || key == "ki" || key == "kd"; }

// `gains.single.swing.kp`, or one axis of it, `.kp.x` and `.kp[0]`.
void set_gain(LoadContext& context, const std::string& name, core::YamlNode value) {
  std::string gain = name, axis;
  if (const auto parts = core::split_dots(name); parts.size() > 4 || name.ends_with(']')) {
    const auto [whole, part] = split_part(name);
    gain = whole, axis = part;
  }
  const std::vector<std::string> parts = core::split_dots(gain);
  if (parts.size() != 4 || !is_gain(parts.back())) {
    context.error(value.mark, "unknown-setting",
                  fmt::format("--set {}: expected gains.TABLE.TASK.kp, ki or kd, or one axis of "
                              "it, gains.TABLE.TASK.kp.AXIS",
                              name));
    return;
  }
  core::YamlNode* const table = look(context.root, std::span(parts).first(3));
  if (table == nullptr || !table->is_map() || !axis.empty()) {
    context.gain_settings.push_back({name, gain, axis, std::move(value)});
    return;
  }
  put_or_replace(*table, parts.back(), std::move(value));
}

// `torque_loop.stance.p`, or one joint of it, `.p.right_knee` and `.p[2]`. A gain that the table
// does not name yet is added to it.
void set_torque_loop(LoadContext& context, const std::string& name, core::YamlNode value) {
  std::string gain = name, joint;
  if (const auto parts = core::split_dots(name); parts.size() > 3 || name.ends_with(']')) {
    const auto [whole, part] = split_part(name);
    gain = whole, joint = part;
  }
  const std::vector<std::string> parts = core::split_dots(gain);
  const bool known = parts.size() == 3 && parts[1] != "ranges" &&
                     core::find_key(model::kTorqueLoopKeys, parts[2]) != nullptr;
  const bool by_joint = known && parts[2] != "type" && parts[2] != "damps";
  if (!known || (!joint.empty() && !by_joint)) {
    context.error(value.mark, "unknown-setting",
                  fmt::format("--set {}: expected torque_loop.TABLE.GAIN ({}), or one joint of it, "
                              "torque_loop.TABLE.GAIN.JOINT",
                              name, fmt::join(core::key_names(model::kTorqueLoopKeys), ", ")));
    return;
  }
  core::YamlNode* const table = require_map(context, name, std::span(parts).first(2), value.mark);
  if (table == nullptr) return;
  if (joint.empty()) {
    put_or_replace(*table, parts.back(), std::move(value));
    return;
  }
  const bool number = joint.find_first_not_of("0123456789") == std::string::npos;
  if (child(*table, parts.back()) == nullptr && !number) {
    core::YamlNode map;
    map.kind = core::YamlNode::Kind::map;
    map.mark = value.mark;
    put_or_replace(map, joint, std::move(value));
    put_or_replace(*table, parts.back(), std::move(map));
    return;
  }
  context.gain_settings.push_back({name, gain, joint, std::move(value)});
}

// `planners.foot.kappa`, or one value of a list, `.reversal.x` and `.reversal[0]`.
void set_planner(LoadContext& context, const std::string& name, core::YamlNode value) {
  const std::vector<std::string> parts = core::split_dots(name);
  const auto [whole, part] = split_part(name);
  const std::vector<std::string> outer = core::split_dots(whole);
  if (core::YamlNode* const item = item_of(look(context.root, outer), part)) {
    *item = std::move(value);
  } else if (parts.size() != 3) {
    context.error(value.mark, "unknown-setting",
                  fmt::format("--set {}: expected planners.NAME.KEY, or one value of a list, "
                              "planners.NAME.KEY.x",
                              name));
  } else if (core::YamlNode* const map =
                 require_map(context, name, std::span(parts).first(2), value.mark)) {
    put_or_replace(*map, parts.back(), std::move(value));
  }
}

// `estimator.lambda`, `estimator.type`; the section is made if there is none.
void set_estimator(LoadContext& context, const std::string& name, core::YamlNode value) {
  const std::vector<std::string> parts = core::split_dots(name);
  const std::vector<std::string> known = core::key_names(kEstimatorKeys);
  if (parts.size() != 2 || core::find_key(kEstimatorKeys, parts[1]) == nullptr) {
    context.error(value.mark, "unknown-setting",
                  fmt::format("--set {}: expected estimator.KEY{}", name,
                              core::did_you_mean_or_list(parts.size() < 2 ? "" : parts[1], known)));
    return;
  }
  if (child(context.root, "estimator") == nullptr) {
    core::YamlNode section;
    section.kind = core::YamlNode::Kind::map;
    section.mark = value.mark;
    put_or_replace(context.root, "estimator", std::move(section));
  }
  if (core::YamlNode* const map = require_map(context, name, std::span(parts).first(1), value.mark))
    put_or_replace(*map, parts[1], std::move(value));
}

void apply(LoadContext& context, const std::string& name, const std::string& text) {
  if (text.find_first_not_of(" \t") == std::string::npos) {
    context.error({}, "expected", fmt::format("--set {}: expected a value after '='", name));
    return;
  }
  core::YamlNode value = core::load_yaml_text(text, "--set " + name, context.diagnostics);
  if (value.is_null()) return;
  const std::vector<std::string> parts = core::split_dots(name);
  if (parts[0] == "gains") {
    set_gain(context, name, std::move(value));
  } else if (parts[0] == "torque_loop") {
    set_torque_loop(context, name, std::move(value));
  } else if (parts[0] == "estimator") {
    set_estimator(context, name, std::move(value));
  } else if (parts[0] == "planners") {
    set_planner(context, name, std::move(value));
  } else {
    set_parameter(context, name, std::move(value));
  }
}

}  // namespace

void apply_overrides(LoadContext& context) {
  for (const auto& [name, text] : context.options.set) apply(context, name, text);
}

}  // namespace footfall::behaviors
