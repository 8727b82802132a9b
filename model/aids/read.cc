// Reads external aids; see springs.h.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <numbers>

#include "core/yaml/value_reader.h"
#include "model/aids/keys.h"
#include "model/aids/springs.h"

namespace footfall::model {
namespace {

using core::Diagnostics;
using core::YamlNode;

// What differs between the axes along which a body moves and those about which it turns.
struct AxisKind {
  const core::KeyTable& keys;
  const core::KeyTable& keys_of_hold;
  core::Dimension stiffness, damping, distance;
  std::string_view stiffness_name, damping_name, distance_name;
  double farthest;  // of travel and anchor; a rotation vector is no longer than half a turn
};

const AxisKind& kind_of(std::size_t axis) {
  static const AxisKind line = {
      kLineSpringKeys,      kHeldLineSpringKeys, kLinearStiffness,
      kLinearDamping,       core::kLength,       "a stiffness in N/m",
      "a damping in N s/m", "a length",          std::numeric_limits<double>::infinity()};
  static const AxisKind turn = {
      kTurnSpringKeys,         kHeldTurnSpringKeys, core::kTorque,
      core::kAngularMomentum,  core::kNone,         "a stiffness in Nm/rad",
      "a damping in Nm s/rad", "an angle",          std::numbers::pi};
  return axis < kFirstAngle ? line : turn;
}

class SpringReader {
 public:
  SpringReader(Diagnostics& diagnostics, bool hold) : diagnostics_(diagnostics), hold_(hold) {}

  void read_body(const YamlNode& node, BodySprings& out) const {
    if (!core::expect_scalar(node, "the name of a body", diagnostics_)) return;
    out.body = {node.scalar, file_of(node.mark), node.mark};
  }

  void read_axes(const YamlNode& map, BodySprings& out) const {
    for (std::size_t axis = 0; axis < kSpringAxes.size(); ++axis) {
      if (const YamlNode* node = map.find(kSpringAxes[axis])) {
        out.axes[axis] = read_axis(*node, kind_of(axis));
      }
    }
  }

  void read_rope(const YamlNode& node, BodySprings& out) const {
    if (!core::expect_map(node, "a rope: {to: [X, Y, Z], length: VALUE, stiffness: VALUE}",
                          diagnostics_)) {
      return;
    }
    core::check_keys(node, kRopeKeys, diagnostics_);
    Rope& rope = out.rope.emplace();
    rope.mark = node.mark;
    if (const YamlNode* to = core::require_key(node, "to", diagnostics_)) read_place(*to, rope.to);
    if (const YamlNode* from = node.find("from")) read_place(*from, rope.from);
    constexpr double kAny = std::numeric_limits<double>::infinity();
    if (const YamlNode* length = core::require_key(node, "length", diagnostics_)) {
      rope.length = core::read_bounded(*length, core::kLength, 0.0, kAny, diagnostics_, "a length")
                        .value_or(0.0);
    }
    if (const YamlNode* stiffness = core::require_key(node, "stiffness", diagnostics_)) {
      rope.mark = stiffness->mark;
      const auto read =
          core::read_quantity(*stiffness, kLinearStiffness, diagnostics_, "a stiffness in N/m");
      rope.stiffness = read.value_or(0.0);
      if (read && !(*read > 0.0)) {
        diagnostics_.error(stiffness->mark, "out-of-range",
                           fmt::format("expected a stiffness in N/m above zero, got {}",
                                       core::describe(*stiffness)));
      }
    }
    rope.file = file_of(rope.mark);
    if (const YamlNode* damping = node.find("damping")) {
      rope.damping = core::read_bounded(*damping, kLinearDamping, 0.0, kAny, diagnostics_,
                                        "a damping in N s/m");
    }
  }

  void read_slides(const YamlNode& node, BodySprings& out) const {
    out.slides_mark = node.mark;
    const auto values = core::read_vector3(node, core::kMass, diagnostics_);
    out.slides = values.value_or(out.slides);
    if (std::ranges::any_of(out.slides, [](double mass) { return mass < 0.0; })) {
      diagnostics_.error(node.mark, "out-of-range", "expected masses of 0 kg or more");
    }
  }

  // Named axes that have no values of their own.
  void read_named_axes(const YamlNode& node, BodySprings& out) const {
    if (!core::expect_sequence(node, "a list of axes: [x, y, yaw]", diagnostics_)) return;
    if (node.items.empty()) {
      diagnostics_.error(node.mark, "empty-value", "no axis would be held");
    }
    for (const YamlNode& item : node.items) {
      const auto axis = core::read_choice(item, kHoldAxes, diagnostics_, "an axis");
      if (!axis) continue;
      auto& spring = out.axes[static_cast<std::size_t>(*axis)];
      if (spring && spring->mark.line == 0) {
        diagnostics_.error(item.mark, "duplicate",
                           fmt::format("the axis '{}' is named twice", item.scalar));
      }
      if (!spring) spring.emplace();
    }
  }

 private:
  std::string file_of(core::Mark mark) const {
    const bool known = mark.file >= 0 && mark.file < diagnostics_.file_count();
    return known ? diagnostics_.file(mark.file) : "";
  }

  void read_place(const YamlNode& node, std::array<double, 3>& place) const {
    if (!node.is_sequence() || node.items.size() != place.size()) {
      core::report_expected(node, "three lengths [x, y, z]", diagnostics_);
      return;
    }
    for (std::size_t k = 0; k < place.size(); ++k) {
      place[k] =
          core::read_quantity(node.items[k], core::kLength, diagnostics_, "a length").value_or(0.0);
    }
  }

  AxisSpring read_axis(const YamlNode& node, const AxisKind& kind) const {
    AxisSpring out;
    out.mark = node.mark;
    if (!core::expect_map(node, "a spring: {stiffness: VALUE, damping: VALUE}", diagnostics_)) {
      return out;
    }
    core::check_keys(node, hold_ ? kind.keys_of_hold : kind.keys, diagnostics_);
    const YamlNode* const stiffness =
        hold_ ? node.find("stiffness") : core::require_key(node, "stiffness", diagnostics_);
    if (stiffness != nullptr) {
      out.mark = stiffness->mark;
      out.stiffness =
          core::read_quantity(*stiffness, kind.stiffness, diagnostics_, kind.stiffness_name);
      if (out.stiffness && !(*out.stiffness > 0.0)) {
        diagnostics_.error(stiffness->mark, "out-of-range",
                           fmt::format("expected {} above zero, got {}; an axis that is not named "
                                       "is free",
                                       kind.stiffness_name, core::describe(*stiffness)));
      }
    }
    out.file = file_of(out.mark);
    constexpr double kAny = std::numeric_limits<double>::infinity();
    if (const YamlNode* damping = node.find("damping")) {
      out.damping =
          core::read_bounded(*damping, kind.damping, 0.0, kAny, diagnostics_, kind.damping_name);
    }
    if (const YamlNode* travel = node.find("travel")) read_travel(*travel, kind, out);
    if (const YamlNode* at = node.find("at"); at != nullptr && !hold_) {
      out.at = core::read_bounded(*at, kind.distance, -kind.farthest, kind.farthest, diagnostics_,
                                  kind.distance_name);
    }
    return out;
  }

  void read_travel(const YamlNode& node, const AxisKind& kind, AxisSpring& out) const {
    out.travel = core::read_range(node, kind.distance, diagnostics_, kind.distance_name);
    if (!out.travel) return;
    const auto [low, high] = *out.travel;
    if (low == high) {
      diagnostics_.error(node.mark, "range",
                         "expected a travel [MIN, MAX] with MIN below MAX; without `travel` the "
                         "spring acts both ways");
    }
    if (std::max(-low, high) > kind.farthest) {
      diagnostics_.error(node.mark, "out-of-range", "expected angles from -180 deg to 180 deg");
    }
  }

  Diagnostics& diagnostics_;
  bool hold_;
};

}  // namespace

bool BodySprings::has_own_values() const {
  return std::ranges::any_of(
      axes, [](const auto& axis) { return axis && (axis->stiffness || axis->damping); });
}

std::vector<BodySprings> read_constraints(const YamlNode& node, Diagnostics& diagnostics) {
  std::vector<BodySprings> list;
  constexpr const char* kForm = "external aids by name: {NAME: {body: BODY, z: {stiffness: ...}}}";
  if (!core::expect_map(node, kForm, diagnostics)) return list;
  const SpringReader reader(diagnostics, false);
  for (const core::YamlEntry& entry : node.entries) {
    core::check_name(entry, diagnostics, "an external aid's name");
    if (!core::expect_map(entry.value, "an external aid: {body: BODY, z: {stiffness: ...}}",
                          diagnostics)) {
      continue;
    }
    core::check_keys(entry.value, kConstraintKeys, diagnostics);
    BodySprings& aid = list.emplace_back();
    aid.name = entry.key;
    if (const YamlNode* body = core::require_key(entry.value, "body", diagnostics)) {
      reader.read_body(*body, aid);
    }
    reader.read_axes(entry.value, aid);
    if (const YamlNode* rope = entry.value.find("rope")) reader.read_rope(*rope, aid);
    if (const YamlNode* slides = entry.value.find("slides")) reader.read_slides(*slides, aid);
    if (const YamlNode* known = entry.value.find("known")) {
      aid.known = core::read_bool(*known, diagnostics).value_or(false);
      const auto held = [](const auto& axis) { return axis.has_value(); };
      const bool both_ways =
          std::ranges::any_of(aid.axes, held) &&
          std::ranges::none_of(aid.axes, [](const auto& axis) { return axis && axis->travel; });
      if (aid.known && !both_ways) {
        diagnostics.error(known->mark, "misplaced-key",
                          "the controller can only know springs both ways: expected an axis, "
                          "without `travel`");
      }
    }
    const auto named = [&](std::string_view axis) {
      return core::has_nearly(entry.value, axis) || entry.value.find(axis) != nullptr;
    };
    if (std::ranges::none_of(kSpringAxes, named) && !named("rope") && !named("slides")) {
      diagnostics.error(entry.value.mark, "missing-key",
                        "expected at least one of x, y, z, roll, pitch, yaw, rope or slides: an "
                        "axis that is not named is free");
    }
  }
  return list;
}

BodySprings read_hold(const YamlNode& node, Diagnostics& diagnostics) {
  BodySprings hold;
  const SpringReader reader(diagnostics, true);
  if (!node.is_map()) {
    reader.read_body(node, hold);
    hold.all = true;
    return hold;
  }
  core::check_keys(node, kHoldKeys, diagnostics);
  if (const YamlNode* body = core::require_key(node, "body", diagnostics)) {
    reader.read_body(*body, hold);
  }
  reader.read_axes(node, hold);
  const YamlNode* const axes = node.find("axes");
  if (axes != nullptr) reader.read_named_axes(*axes, hold);
  hold.all = axes == nullptr &&
             std::ranges::none_of(hold.axes, [](const auto& axis) { return axis.has_value(); });
  return hold;
}

}  // namespace footfall::model
