// Tasks, internal forces and trajectories; see language.h.
#include <array>

#include "behaviors/language/language.h"
#include "tasks/task_types.h"

namespace footfall::behaviors {
namespace {

using namespace core;  // constructors of the tables

// The catalogue of task types as words of the language.
constexpr auto kTaskTypeRows = [] {
  std::array<WordSpec, tasks::kTaskTypes.size()> words{};
  for (std::size_t k = 0; k < words.size(); ++k) {
    words[k] = {tasks::kTaskTypes[k].info.name, tasks::kTaskTypes[k].info.doc};
  }
  return words;
}();

// Names of task types with blanks between, for KeySpec::only.
class TypeNames {
 public:
  // The types that `has` holds for.
  consteval explicit TypeNames(bool (*has)(const tasks::TaskTypeInfo&)) {
    for (const tasks::TaskTypeRow& row : tasks::kTaskTypes) {
      if (!has(row.info)) continue;
      if (size_ > 0) text_[size_++] = ' ';
      for (const char c : row.info.name) text_[size_++] = c;
    }
  }
  constexpr operator std::string_view() const { return {text_.data(), size_}; }

 private:
  std::array<char, 1024> text_{};  // too small is an error of the compiler
  std::size_t size_ = 0;
};

using TypeInfo = tasks::TaskTypeInfo;
constexpr TypeNames kWithAxes([](const TypeInfo& type) { return !type.of_joints(); });
constexpr TypeNames kWithJoints([](const TypeInfo& type) { return type.of_joints(); });
constexpr TypeNames kWithPoint([](const TypeInfo& type) { return type.of_point(); });
constexpr TypeNames kWithFrame([](const TypeInfo& type) { return !type.frames.empty(); });
constexpr TypeNames kWithReference([](const TypeInfo& type) { return type.has_reference; });

// In the order of tasks::Frame after `usual`.
constexpr WordSpec kFrameRows[] = {
    {"world", "fixed"},
    {"stance", "positions: relative to the mean of the active contact points, world directions"},
    {"heading", "upright, with the yaw of the base (for frame_orientation: of the frame itself)"},
};

constexpr ValueSpec kReferenceValue =
    computed(by_axis(any_quantity("m, or rad; `entry` is the value at the task's start")));

constexpr KeySpec kTaskRows[] = {
    key("type", choice(kTaskTypeRows),
        "the controlled quantity; optional in a state if the stack has the task")
        .required(),
    key("axes", list(name_of("an axis")),
        "controlled axes, in the order of `reference` and gains; omitted ones are free")
        .otherwise("all")
        .only(kWithAxes),
    key("joints", list(name_of("a joint")), "controlled joints, by name or glob (\"*_hip\")")
        .otherwise("all")
        .only(kWithJoints),
    key("point", name_of("a contact or point"), "controlled point of the robot; required")
        .only(kWithPoint),
    key("frame", choice(kFrameRows), "frame of its axes")
        .otherwise("world; orientations heading")
        .only(kWithFrame),
    key("priority", integer(1, 1000),
        "its level: a larger number acts only in the null space of smaller ones")
        .otherwise("1"),
    key("weight", computed(by_axis(quantity(kNone))),
        "relative to other tasks of its level; 0: the axis is no part of it")
        .otherwise("1"),
    key("reference", kReferenceValue, map_of(kTrajectoryKeys),
        "desired value: one value an axis (number, expression, signal, `planner.NAME.target`), "
        "or a trajectory")
        .only(kWithReference),
    key("gains", name_of("a gain table"), map_of(kGainsKeys),
        "its gains, or another table with them")
        .otherwise("the state's or stack's table"),
    key("integral_limit", computed(by_axis(any_quantity("m s or rad s"))),
        "limit of the error integral on each axis")
        .otherwise("none"),
    key("acceleration_limit", computed(by_axis(any_quantity("m/s^2 or rad/s^2"))),
        "limit of the commanded acceleration on each axis")
        .otherwise("none"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

constexpr WordSpec kConventionRows[] = {
    {"mean", "the reference is the force at each contact"},
    {"sum", "the reference is the sum over the contacts, as in the paper"},
};

constexpr WordSpec kBetweenRows[] = {
    {"all", "every pair of active contacts without an internal force of its own"},
};

constexpr WordSpec kForceReferenceWords[] = {
    {"statics", "the force at which the contacts' forces at rest are nearest to their normals"},
};

constexpr WordSpec kForceTrajectoryRows[] = {
    {"hold", "stays where it is"},
    {"polynomial", "of order 3 or 5"},
    {"cosine", "half a cosine wave, at rest at both ends"},
    {"minimum_jerk", "the smoothest change"},
};

constexpr KeySpec kForceReferenceRows[] = {
    key("statics", computed(quantity(kNone)),
        "this part of the force by statics, and nothing else"),
    key("trajectory", choice(kForceTrajectoryRows), "alternatively: its shape"),
    key("order", integer(3, 5), "3 or 5, of a polynomial"),
    key("to", computed(quantity(kForce, "a force; `entry` is the one at the start")), "end value"),
    key("over", computed(quantity(kTime)), "duration, read at entry"),
    key("end_velocity", computed(any_quantity("N/s")), "rate at the end, kept afterwards")
        .otherwise("0"),
};

constexpr KeySpec kInternalRows[] = {
    key("between", list(name_of("a contact")), choice(kBetweenRows),
        "two contacts: the tension between them; four, around the robot: their vertical warp, "
        "which "
        "loads the first and third and unloads the others; or all pairs")
        .required(),
    key("reference", computed(quantity(kForce)), choice(kForceReferenceWords),
        map_of(kForceReferenceKeys),
        "positive pushes the contacts apart (loads the first): a value, the force by statics, or a "
        "trajectory")
        .required(),
    key("feedback", computed(quantity(kNone)), "gain on the error of the measured force")
        .otherwise("0"),
    key("integral", computed(quantity(kRate, "a rate in 1/s")),
        "gain on the integral of that error, which does not grow while a joint asks for more than "
        "its torque")
        .otherwise("0 1/s"),
    key("integral_limit", computed(quantity(kForce)), "limit of what the integral adds")
        .otherwise("none"),
    key("ramp", computed(quantity(kTime)),
        "in which the reference and what is fed back grow from nothing once its contacts hold")
        .otherwise("0 s"),
    key("bandwidth", computed(quantity(kRate, "a frequency in Hz")),
        "of the first-order low-pass of the measured force that is fed back; 0 Hz: none")
        .otherwise("20 Hz"),
    key("convention", choice(kConventionRows), "meaning of `reference`").otherwise("mean"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

constexpr WordSpec kTrajectoryRows[] = {
    {"hold", "stays where it is"},
    {"polynomial", "of order 3 or 5, from value and velocity at entry"},
    {"cosine", "half a cosine wave, at rest at both ends"},
    {"minimum_jerk", "the smoothest motion"},
    {"ellipse", "rotates about a centre, growing from zero"},
    {"waypoints", "passes points smoothly"},
    {"surface", "the world's surface below, and a height above it: axes [z] of a position"},
};
constexpr std::string_view kGoing = "polynomial cosine minimum_jerk ellipse surface";
constexpr std::string_view kLasting = "polynomial cosine minimum_jerk ellipse surface waypoints";
constexpr std::string_view kArriving = "polynomial minimum_jerk ellipse surface waypoints";
constexpr std::string_view kFollowing = "polynomial cosine minimum_jerk surface";

constexpr WordSpec kDirectionRows[] = {
    {"positive", "from the first axis towards the second"},
    {"negative", "reverse"},
};

constexpr KeySpec kWaypointRows[] = {
    key("at", computed(quantity(kTime)), quantity(kNone, "a part of `over`"),
        "time since entry, or a part of the trajectory's `over`"),
    key("over", computed(quantity(kTime)), "alternatively: time since the previous point"),
    key("to", kReferenceValue, "position; an axis omitted in a map continues to its next point")
        .required(),
};

constexpr KeySpec kTrajectoryKeyRows[] = {
    key("trajectory", choice(kTrajectoryRows), "its shape").required(),
    key("order", integer(3, 5), "3 or 5").only("polynomial"),
    key("to", kReferenceValue,
        "end value; an axis omitted in a map is constant. Ellipse: of its centre; surface: height "
        "above it")
        .only(kGoing),
    key("over", computed(quantity(kTime)), "duration, read at entry").only(kLasting),
    key("end_velocity", computed(by_axis(any_quantity("m/s or rad/s"))),
        "velocity at the end, kept afterwards; read at entry like `to`, because the whole path "
        "depends on it")
        .otherwise("0")
        .only(kArriving),
    key("retarget", boolean(), quantity(kNone, "a part of `over`, at most 95 %"),
        "whether it follows a changing `to`: true (during 80 % of `over`), or a part")
        .otherwise("false")
        .only(kFollowing),
    key("radius", computed(by_axis(any_quantity("m or rad"))), "of the ellipse along each axis")
        .only("ellipse"),
    key("period", computed(quantity(kTime)), "of a rotation").only("ellipse"),
    key("phase", computed(by_axis(quantity(kNone, "an angle"))), "of the rotation at entry")
        .otherwise("0")
        .only("ellipse"),
    key("direction", choice(kDirectionRows), "of the rotation")
        .otherwise("positive")
        .only("ellipse"),
    key("ramp", computed(quantity(kTime)), "duration of the growth from zero, read at entry")
        .otherwise("one period")
        .only("ellipse"),
    key("points", list(map_of(kWaypointKeys)), "the points, in order").only("waypoints"),
};

}  // namespace

constinit const core::KeyTable kTaskKeys = {
    .id = "task",
    .doc =
        "A controlled quantity with a priority. A task that was active before (same name, type "
        "and point) keeps its reference and integral.",
    .keys = kTaskRows,
    .part = true,
    .selector = "type",
    .variants = kTaskTypeRows};
constinit const core::KeyTable kInternalKeys = {
    .id = "internal",
    .doc = "A force between contacts that causes no motion. Those that are not named get 0 N.",
    .keys = kInternalRows,
    .part = true};
constinit const core::KeyTable kForceReferenceKeys = {
    .id = "force_reference",
    .doc = "The force by statics, or a change from the value at entry.",
    .keys = kForceReferenceRows,
    .part = true};
constinit const core::KeyTable kWaypointKeys = {
    .id = "waypoint", .doc = "A point to pass, and its time.", .keys = kWaypointRows};
constinit const core::KeyTable kTrajectoryKeys = {
    .id = "trajectory",
    .doc = "A motion from the value at entry, with feed-forward.",
    .keys = kTrajectoryKeyRows,
    .part = true,
    .selector = "trajectory",
    .variants = kTrajectoryRows};
constinit const std::span<const core::WordSpec> kFrames = kFrameRows;
constinit const std::span<const core::WordSpec> kForceReferences = kForceReferenceWords;
constinit const std::span<const core::WordSpec> kForceTrajectories = kForceTrajectoryRows;
constinit const std::span<const core::WordSpec> kConventions = kConventionRows;
constinit const std::span<const core::WordSpec> kDirections = kDirectionRows;
constinit const std::span<const core::WordSpec> kTrajectories = kTrajectoryRows;

}  // namespace footfall::behaviors
