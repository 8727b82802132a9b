// Keys of a torque loop; see torque_loop.h.
#include "model/robot/torque_loop.h"

namespace footfall::model {
namespace {

using namespace core;  // constructors of the tables
using hal::TorqueLoopGains;

constexpr WordSpec kTypeRows[] = {
    {"cascade", "torque error to motor velocity, its error to motor torque"},
    {"direct", "torque error to motor torque"},
};

constexpr WordSpec kDampingRows[] = {
    {"motor", "the motor's velocity"},
    {"spring", "the rate of the spring's deflection"},
};

constexpr KeySpec kRows[] = {
    key("type", choice(kTypeRows), "the law").otherwise("cascade"),
    key("p", by_axis(any_quantity("a gain")),
        "of the torque error; cascade: motor velocity, rad/s per Nm, direct: a number"),
    key("i", by_axis(any_quantity("a gain")),
        "of its integral; cascade: rad/s^2 per Nm, direct: 1/s"),
    key("d", by_axis(quantity(kAngularMomentum, "a damping")),
        "direct: motor torque against the velocity that `damps` names, Nm s/rad"),
    key("damps", choice(kDampingRows), "direct: the velocity that `d` damps").otherwise("motor"),
    key("forward", by_axis(quantity(kNone)), "direct: part of the reference that is sent at once")
        .otherwise("1"),
    key("observer", by_axis(quantity(kRate, "a frequency in Hz")),
        "direct: bandwidth of the observer of what disturbs the rotor, such as friction")
        .otherwise("0 Hz"),
    key("velocity_p", by_axis(quantity(kAngularMomentum, "a damping")),
        "cascade: motor torque per error of the motor's velocity, Nm s/rad"),
    key("velocity_i", by_axis(quantity(kTorque, "a stiffness")), "cascade: of its integral, Nm/rad")
        .otherwise("0"),
};

constexpr Dimension kPerAction{-2, -1, 1};   // rad/s per N m
constexpr Dimension kPerInertia{-2, -1, 0};  // rad/s^2 per N m

constexpr std::string_view kDamping = "a damping (Nm s/rad)";
constexpr std::string_view kNumber = "a plain number";
constexpr std::string_view kFrequency = "a frequency (Hz)";
constexpr std::string_view kStiffness = "a stiffness (Nm/rad)";

}  // namespace

constinit const core::KeyTable kTorqueLoopKeys = {
    .id = "torque_loop",
    .doc =
        "Gains of the actuators' own torque control: one number for all joints, or a map by "
        "joint (globs such as \"*knee\"; exact names first). What a behavior's table does not "
        "name is as in the robot's `drives`.",
    .keys = kRows};
constinit const std::span<const core::WordSpec> kTorqueLoopTypes = kTypeRows;
constinit const std::span<const core::WordSpec> kTorqueLoopDampings = kDampingRows;

constinit const std::array<TorqueLoopKey, 7> kTorqueLoopGainKeys = {{
    {"p", &TorqueLoopGains::p, true, true, kPerAction, kNone,
     "a motor velocity per torque (rad/s/Nm)", "a plain number"},
    {"i", &TorqueLoopGains::i, true, true, kPerInertia, kRate,
     "a motor acceleration per torque (rad/s^2/Nm)", "a rate (1/s)"},
    {"d", &TorqueLoopGains::damping, false, true, kAngularMomentum, kAngularMomentum, kDamping,
     kDamping},
    {"forward", &TorqueLoopGains::forward, false, true, kNone, kNone, kNumber, kNumber},
    {"observer", &TorqueLoopGains::observer, false, true, kRate, kRate, kFrequency, kFrequency},
    {"velocity_p", &TorqueLoopGains::velocity_p, true, false, kAngularMomentum, kAngularMomentum,
     kDamping, kDamping},
    {"velocity_i", &TorqueLoopGains::velocity_i, true, false, kTorque, kTorque, kStiffness,
     kStiffness},
}};

}  // namespace footfall::model
