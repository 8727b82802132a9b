// References against the robot's limits; see parts.h.
//
// Heights: the height of the CoM or a point above the ground is at most its distance from a contact
// point on the ground; that distance depends only on the joints, not on the base orientation, and
// is maximised over the joint limits. No false alarm on level ground: tilt, other tasks and other
// feet only reduce the reachable height.
// The height of a foot that is in the air, from a start on the ground: its rise above a contact
// point is maximised in the same way, with the base upright where a task keeps it so. A foot is not
// sent below the place from which it was lifted.
// Likewise the base can be above the CoM or a point by no more than a distance that depends on the
// joints, at a tilt within the robot's limit: a height from which it is still below `limits.height`
// is a fall.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <tuple>

#include "behaviors/check/physics/configurations.h"
#include "behaviors/check/physics/parts.h"

namespace footfall::behaviors {
namespace {

using core::Severity;
using tasks::Subject;

constexpr double kDegree = std::numbers::pi / 180.0;
// The maximum is found numerically: coordinate ascent from several postures ends within a fraction
// of a millimetre of it for legs of a few joints. One percent is added as tolerance.
constexpr double kSlack = 1.01;
constexpr int kSweeps = 20;
constexpr double kPress = 0.02;  // m, into the ground: less presses the foot, and the robot stands
constexpr double kKeptTilt = 0.1;  // rad, of a base whose roll and pitch are controlled

class ReachCheck {
 public:
  explicit ReachCheck(PhysicsContext& context) : context_(context), values_(context.behavior) {}

  void run() {
    for (const ControlSpec& control : context_.behavior.controls) {
      for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
        const TaskSpec& task = context_.behavior.tasks[static_cast<std::size_t>(k)];
        for (int a = task.axes.first; a < task.axes.end(); ++a) {
          judge(control, task, context_.behavior.axes[static_cast<std::size_t>(a)]);
          judge_waypoints(control, task, a - task.axes.first);
        }
      }
    }
    context_.findings.settle(1);
  }

 private:
  // Each point that names the axis, as its reference.
  void judge_waypoints(const ControlSpec& control, const TaskSpec& task, int k) {
    AxisSpec axis = context_.behavior.axes[static_cast<std::size_t>(task.axes.first + k)];
    const Range& points = task.reference.waypoints;
    for (int p = points.first; p < points.end(); ++p) {
      axis.value =
          context_.behavior.waypoints[static_cast<std::size_t>(p)].to[static_cast<std::size_t>(k)];
      axis.value_mark = axis.mark;
      judge(control, task, axis);
    }
  }

  void judge(const ControlSpec& control, const TaskSpec& task, const AxisSpec& axis) {
    if (axis.value < 0) return;
    const tasks::TaskTypeInfo& type = tasks::info(task.type);
    if (type.of_joints()) {
      judge_joint(task, axis);
    } else if (type.subject == Subject::base_rotation && type.is_angle(axis.axis) &&
               axis.axis < 2) {
      judge_tilt(task, axis);
    } else if (type.is_length(axis.axis) && axis.axis == 2) {
      judge_height(control, task, axis);
    }
  }

  // The value if it is independent of measurements; `entry` is the reference's start value.
  std::optional<double> value(const AxisSpec& axis, double entry) const {
    const Dependence needs = dependence_of(context_.behavior, axis.value);
    if (needs.measured || needs.variable) return std::nullopt;
    return values_.of(axis.value, entry);
  }
  // Whether the value is below `low` or above `high` from every start value between them: which of
  // the two, and by what.
  std::optional<double> outside(const AxisSpec& axis, double low, double high) const {
    const auto from_low = value(axis, low);
    const auto from_high = value(axis, high);
    if (!from_low || !from_high) return std::nullopt;
    if (*from_low > high && *from_high > high) return std::min(*from_low, *from_high);
    if (*from_low < low && *from_high < low) return std::max(*from_low, *from_high);
    return std::nullopt;
  }

  const std::string& name(const TaskSpec& task) const {
    return context_.behavior.task_instances[static_cast<std::size_t>(task.instance)].name;
  }
  void add(const AxisSpec& axis, const std::string& subject, std::string text) {
    context_.findings.add(Severity::error, axis.value_mark, "out-of-reach", subject,
                          std::move(text));
  }

  void judge_joint(const TaskSpec& task, const AxisSpec& axis) {
    const auto& joint = context_.behavior.robot.joints[static_cast<std::size_t>(axis.axis)];
    const auto found = outside(axis, joint.position_min, joint.position_max);
    if (!found) return;
    add(axis, joint.name,
        fmt::format("task '{}' asks for {:.4g} deg of '{}', whose limits are {:.4g} to {:.4g} deg",
                    name(task), *found / kDegree, joint.name, joint.position_min / kDegree,
                    joint.position_max / kDegree));
  }

  void judge_tilt(const TaskSpec& task, const AxisSpec& axis) {
    const double limit = context_.behavior.robot.tilt_limit;
    const auto found = outside(axis, -limit, limit);
    if (!found) return;
    const char* what = axis.axis == 0 ? "roll" : "pitch";
    add(axis, what,
        fmt::format(
            "task '{}' asks for {} {:.4g} deg: above {:.4g} deg (the robot's limit of tilt) "
            "it counts as fallen",
            name(task), what, *found / kDegree, limit / kDegree));
  }

  void judge_height(const ControlSpec& control, const TaskSpec& task, const AxisSpec& axis) {
    if (control.contacts.empty()) return;
    const int point = task.point;  // -1: the CoM
    double highest = farthest(control.contacts.front(), point);
    for (const int contact : control.contacts) {
      highest = std::min(highest, farthest(contact, point));
    }
    const bool com = point < 0;
    const bool swings = in_the_air(control, point);
    if (swings) highest = std::min(highest, highest_rise(control, point));
    // Another point may be below the ground, in a ditch.
    const double lowest = com || swings ? 0.0 : -highest;
    const auto found = outside(axis, lowest, highest);
    if (!found) {
      if (swings) judge_sink(control, task, axis);
      judge_fall(task, axis, highest);
      return;
    }
    add(axis, "z",
        fmt::format("task '{}' asks for {} of {:.3g} m: {}", name(task),
                    com      ? "a centre of mass at a height"
                    : swings ? "a foot at a height"
                             : "a point at a height",
                    *found,
                    *found < 0.0 ? "that is in the ground"
                                 : fmt::format("on {} it can be {:.3g} m at most",
                                               contacts_text(context_.behavior, control.contacts),
                                               highest)));
  }

  // A foot that stood when the trajectory began, and is sent below the place where it stood. A foot
  // that is being loaded may press.
  void judge_sink(const ControlSpec& control, const TaskSpec& task, const AxisSpec& axis) {
    const ReferenceSpec& reference = task.reference;
    if (reference.kind != ReferenceSpec::Kind::trajectory || control.transition >= 0) return;
    if (!dependence_of(context_.behavior, axis.value).entry) return;
    const auto end = value(axis, 0.0);
    if (!end || *end >= 0.0 || !begins_on_ground(reference.owner, task.point)) return;
    context_.findings.add(
        *end < -kPress ? Severity::error : Severity::warning, axis.value_mark, "out-of-reach", "z",
        fmt::format("task '{}' asks for a foot at a height of {:.3g} m from where it stood: that "
                    "is in the ground",
                    name(task), *end));
  }

  // Whether the state is entered from a control in which the foot holds or is released.
  bool begins_on_ground(int state, int foot) {
    if (!changes_) changes_ = control_changes(context_.behavior);
    return std::ranges::any_of(*changes_, [&](const ControlChange& change) {
      if (std::ranges::find(change.entered, state) == change.entered.end()) return false;
      const ControlSpec& before = context_.behavior.controls[static_cast<std::size_t>(change.from)];
      if (std::ranges::find(before.contacts, foot) != before.contacts.end()) return true;
      if (before.transition < 0) return false;
      const TransitionSpec& spec =
          context_.behavior.contact_transitions[static_cast<std::size_t>(before.transition)];
      return !spec.loads && std::ranges::find(spec.contacts, foot) != spec.contacts.end();
    });
  }

  // Whether the point is that of a contact which does not hold.
  bool in_the_air(const ControlSpec& control, int point) const {
    return point >= 0 && point < static_cast<int>(context_.behavior.robot.contacts.size()) &&
           std::ranges::find(control.contacts, point) == control.contacts.end();
  }

  // Whether tasks control both roll and pitch of the base.
  bool keeps_upright(const ControlSpec& control) const {
    std::array<bool, 2> kept{};
    for (int k = control.tasks.first; k < control.tasks.end(); ++k) {
      const TaskSpec& task = context_.behavior.tasks[static_cast<std::size_t>(k)];
      if (tasks::info(task.type).subject != Subject::base_rotation) continue;
      for (int a = task.axes.first; a < task.axes.end(); ++a) {
        const int axis = context_.behavior.axes[static_cast<std::size_t>(a)].axis;
        if (axis < 2) kept[static_cast<std::size_t>(axis)] = true;
      }
    }
    return kept[0] && kept[1];
  }

  // How far a foot can be above the feet that hold, over the joints' limits and the base's tilt, m.
  double highest_rise(const ControlSpec& control, int foot) {
    const double tilt = keeps_upright(control) ? kKeptTilt : context_.behavior.robot.tilt_limit;
    double highest = std::numeric_limits<double>::infinity();
    for (const int contact : control.contacts) {
      const auto key = std::make_tuple(contact, foot, tilt);
      auto known = rises_.find(key);
      if (known == rises_.end()) {
        const double best = maximum([&](const model::State& state) {
          context_.model.update(state);
          return rise(context_.model.point_position(contact), context_.model.point_position(foot),
                      tilt);
        });
        known = rises_.emplace(key, best + (kSlack - 1.0) * std::abs(best)).first;
      }
      highest = std::min(highest, known->second);
    }
    return highest;
  }

  void judge_fall(const TaskSpec& task, const AxisSpec& axis, double highest) {
    const model::RobotDescription& robot = context_.behavior.robot;
    const double limit = robot.height_limit * robot.standing_height;
    const double above = base_above(task.point);
    const auto found = outside(axis, limit - above, highest);
    if (!found) return;
    add(axis, "z",
        fmt::format("task '{}' asks for {} of {:.3g} m: the base is then {:.3g} m above the ground "
                    "at most, and below {:.3g} m (limits.height of the robot) it counts as fallen",
                    name(task),
                    task.point < 0 ? "a centre of mass at a height" : "a point at a height", *found,
                    *found + above, limit));
  }

  // How far the base can be above the CoM (-1) or a point, over the joints' limits and tilts
  // within the robot's, m.
  double base_above(int point) {
    if (const auto known = base_above_.find(point); known != base_above_.end()) {
      return known->second;
    }
    const double tilt = context_.behavior.robot.tilt_limit;
    const double best = maximum([&](const model::State& state) {
      context_.model.update(state);
      return rise(point < 0 ? context_.model.com().position : context_.model.point_position(point),
                  context_.model.state().p_WB, tilt);
    });
    return base_above_[point] = best + (kSlack - 1.0) * std::abs(best);
  }

  // How far `upper` is above `lower`, with the base turned in the best way from upright by `tilt`
  // at most.
  template <class Point>
  double rise(const Point& lower, const Point& upper, double tilt) const {
    const auto& R = context_.model.R_WB();
    std::array<double, 3> d{};  // world
    for (std::size_t i = 0; i < 3; ++i) d[i] = upper[i] - lower[i];
    const double up = R[2] * d[0] + R[5] * d[1] + R[8] * d[2];  // along the base's own z
    const double length = std::hypot(d[0], d[1], d[2]);
    if (!(length > 0.0)) return 0.0;
    const double angle = std::acos(std::clamp(up / length, -1.0, 1.0));
    return length * std::cos(std::max(0.0, angle - tilt));
  }

  // The largest value over the joints' limits, from several postures.
  double maximum(const std::function<double(const model::State&)>& size) {
    double best = -std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < context_.postures.size(); k += 4) {
      best = std::max(best, climb(context_.postures[k], size));
    }
    return best;
  }

  // Largest distance of the CoM (-1) or a point from a contact point over the joints' limits, m.
  double farthest(int contact, int point) {
    const auto key = std::make_pair(contact, point);
    if (const auto known = farthest_.find(key); known != farthest_.end()) return known->second;
    const double best =
        maximum([&](const model::State& state) { return distance(state, contact, point); });
    return farthest_[key] = kSlack * best;
  }

  double distance(const model::State& state, int contact, int point) {
    context_.model.update(state);
    const auto& a = context_.model.point_position(contact);
    const auto& b =
        point < 0 ? context_.model.com().position : context_.model.point_position(point);
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
  }

  // Coordinate ascent: moves each joint in turn by a step that is halved when it no longer helps.
  double climb(model::State state, const std::function<double(const model::State&)>& size) {
    double best = size(state);
    double step = 0.5;
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      bool better = false;
      for (std::size_t j = 0; j < context_.behavior.robot.joints.size(); ++j) {
        const auto& joint = context_.behavior.robot.joints[j];
        for (const double move : {step, -step}) {
          const double before = state.q[j];
          state.q[j] = std::clamp(before + move, joint.position_min, joint.position_max);
          const double now = size(state);
          if (now > best) {
            best = now;
            better = true;
          } else {
            state.q[j] = before;
          }
        }
      }
      if (!better) step *= 0.5;
    }
    return best;
  }

  PhysicsContext& context_;
  StaticValues values_;
  std::map<std::pair<int, int>, double> farthest_;
  std::optional<std::vector<ControlChange>> changes_;     // found when first needed
  std::map<int, double> base_above_;                      // by point
  std::map<std::tuple<int, int, double>, double> rises_;  // by contact, foot and tilt
};

}  // namespace

void check_references(PhysicsContext& context) { ReachCheck(context).run(); }

}  // namespace footfall::behaviors
