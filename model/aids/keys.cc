// Keys of external aids; see springs.h.
#include "model/aids/keys.h"

#include "model/aids/springs.h"

namespace footfall::model {
namespace {

using namespace core;  // constructors of the tables

constexpr std::string_view kDampingDoc =
    "it opposes the axis' velocity; with `travel` only beyond a bound, where the whole force never "
    "points outwards";
constexpr std::string_view kDampingDefault = "critical for the robot's mass or rotational inertia";
constexpr std::string_view kHandsDefault = "the mass times the square of the world's `hands`";
constexpr std::string_view kTurnHandsDefault =
    "the rotational inertia times the square of the world's `hands`";
constexpr std::string_view kTravelDoc =
    "free between these distances from the anchor, a one-sided spring beyond either";
constexpr std::string_view kTurnDoc =
    "free between these angles from the anchor, a one-sided spring beyond either";
constexpr std::string_view kNoTravel = "a spring both ways";

constexpr KeySpec kLineRows[] = {
    key("stiffness", quantity(kLinearStiffness, "a stiffness in N/m"), "of the spring").required(),
    key("damping", quantity(kLinearDamping, "a damping in N s/m"), kDampingDoc)
        .otherwise(kDampingDefault),
    key("travel", pair(quantity(kLength)), kTravelDoc).otherwise(kNoTravel),
    key("at", quantity(kLength), "anchor of the body's centre of mass in the world")
        .otherwise("where it starts"),
};

constexpr KeySpec kTurnRows[] = {
    key("stiffness", quantity(kTorque, "a stiffness in Nm/rad"), "of the spring").required(),
    key("damping", quantity(kAngularMomentum, "a damping in Nm s/rad"), kDampingDoc)
        .otherwise(kDampingDefault),
    key("travel", pair(quantity(kNone, "an angle")), kTurnDoc).otherwise(kNoTravel),
    key("at", quantity(kNone, "an angle"), "anchor: this angle of the body in the world")
        .otherwise("as it starts"),
};

constexpr KeySpec kHeldLineRows[] = {
    key("stiffness", quantity(kLinearStiffness, "a stiffness in N/m"), "of the spring")
        .otherwise(kHandsDefault),
    key("damping", quantity(kLinearDamping, "a damping in N s/m"), kDampingDoc)
        .otherwise(kDampingDefault),
    key("travel", pair(quantity(kLength)), kTravelDoc).otherwise(kNoTravel),
};

constexpr KeySpec kHeldTurnRows[] = {
    key("stiffness", quantity(kTorque, "a stiffness in Nm/rad"), "of the spring")
        .otherwise(kTurnHandsDefault),
    key("damping", quantity(kAngularMomentum, "a damping in Nm s/rad"), kDampingDoc)
        .otherwise(kDampingDefault),
    key("travel", pair(quantity(kNone, "an angle")), kTurnDoc).otherwise(kNoTravel),
};

constexpr KeySpec kRopeRows[] = {
    key("to", by_axis(quantity(kLength)), "the fixed end: `[x, y, z]` in the world").required(),
    key("from", by_axis(quantity(kLength)), "the other end, in the body's frame")
        .otherwise("[0 m, 0 m, 0 m]"),
    key("length", quantity(kLength), "up to which it is slack").required(),
    key("stiffness", quantity(kLinearStiffness, "a stiffness in N/m"), "while it is taut")
        .required(),
    key("damping", quantity(kLinearDamping, "a damping in N s/m"),
        "while it is taut; a rope never pushes")
        .otherwise("critical for the robot's mass"),
};

constexpr KeySpec kConstraintRows[] = {
    key("body", name_of("a body"), "the body it acts on").required(),
    key("x", map_of(kLineSpringKeys), "its centre of mass along x of the world"),
    key("y", map_of(kLineSpringKeys), "likewise along y"),
    key("z", map_of(kLineSpringKeys), "likewise along z"),
    key("roll", map_of(kTurnSpringKeys), "its rotation about x of the world"),
    key("pitch", map_of(kTurnSpringKeys), "likewise about y"),
    key("yaw", map_of(kTurnSpringKeys), "likewise about z"),
    key("rope", map_of(kRopeKeys), "a rope between a point of the body and a fixed place"),
    key("known", boolean(),
        "whether the controller takes its axes, springs both ways, as constraints of its model; "
        "tasks have to leave alone what these forbid, which `check` does not judge")
        .otherwise("false"),
    key("slides", by_axis(quantity(kMass, "a mass")),
        "mass that is moved along x, y, z of the world with the origin of the robot's floating "
        "base and has no weight, as of a slider on a rail; unknown to the controller")
        .otherwise("[0 kg, 0 kg, 0 kg]"),
};

constexpr WordSpec kAxisRows[] = {
    {"x", "along x of the world"},
    {"y", "along y of the world"},
    {"z", "along z of the world"},
    {"roll", "rotation about x of the world"},
    {"pitch", "rotation about y of the world"},
    {"yaw", "rotation about z of the world"},
};

constexpr KeySpec kHoldRows[] = {
    key("body", name_of("a body"), "the body that is held").required(),
    key("axes", list(choice(kAxisRows)), "axes held as `physics: {hands}` of the world says")
        .otherwise("those with values here; if none has, x, y, z, and of the robot's root all six"),
    key("x", map_of(kHeldLineSpringKeys), "its centre of mass along x of the world"),
    key("y", map_of(kHeldLineSpringKeys), "likewise along y"),
    key("z", map_of(kHeldLineSpringKeys), "likewise along z"),
    key("roll", map_of(kHeldTurnSpringKeys), "its rotation about x of the world"),
    key("pitch", map_of(kHeldTurnSpringKeys), "likewise about y"),
    key("yaw", map_of(kHeldTurnSpringKeys), "likewise about z"),
};

}  // namespace

constinit const core::KeyTable kLineSpringKeys = {
    .id = "line_spring", .doc = "A spring along an axis.", .keys = kLineRows};
constinit const core::KeyTable kTurnSpringKeys = {
    .id = "turn_spring", .doc = "A spring about an axis.", .keys = kTurnRows};
constinit const core::KeyTable kHeldLineSpringKeys = {
    .id = "held_line", .doc = "A spring of a hold along an axis.", .keys = kHeldLineRows};
constinit const core::KeyTable kHeldTurnSpringKeys = {
    .id = "held_turn", .doc = "A spring of a hold about an axis.", .keys = kHeldTurnRows};
constinit const core::KeyTable kConstraintKeys = {
    .id = "constraint",
    .doc =
        "An external aid: springs between a body and the world. An axis that is not named is "
        "free.",
    .keys = kConstraintRows,
    .one_of = {"x y z roll pitch yaw rope slides"}};
constinit const core::KeyTable kRopeKeys = {
    .id = "rope",
    .doc = "A rope between a point of the body and a fixed place: it pulls while it is taut.",
    .keys = kRopeRows};
constinit const core::KeyTable kHoldKeys = {
    .id = "hold",
    .doc = "A body held where it is at that moment. An axis that is not named is free.",
    .keys = kHoldRows};
constinit const std::span<const core::WordSpec> kHoldAxes = kAxisRows;

}  // namespace footfall::model
