// Keys and words of a robot file; see keys.h.
#include "model/robot/keys.h"

#include "model/robot/torque_loop.h"

namespace footfall::model {
namespace {

using namespace core;  // constructors of the tables

constexpr WordSpec kReactionRows[] = {
    {"continue", "the fault is counted and logged"},
    {"safe_state", "the behavior's `safe` state is entered; without one as safe_stop"},
    {"safe_stop", "the run ends at once"},
};

constexpr KeySpec kRobotRows[] = {
    key("robot", integer(1, 1), "the version of robot files; the first key").required(),
    key("base", text_of("the path of a robot file"),
        "a file this one inherits, relative to this one: maps merge by key, everything else is "
        "replaced, "
        "`NAME: off` removes, `KEY+:` appends to a list"),
    key("name", name_of("a robot"), "its name in logs and reports").otherwise("the folder's name"),
    key("doc", text_of("a text"), "the robot, in one line"),
    key("model", text_of("the path of an MJCF file"),
        "bodies, joints and sites, relative to this file")
        .required(),
    key("floating_base", text_of("the name of a body"), "the free-floating body").required(),
    key("rate", quantity(kRate, "a rate in Hz"), "of the control tick; whole millihertz")
        .otherwise("1000 Hz"),
    key("standing_height", quantity(kLength),
        "of the floating base's origin above the ground, in `posture`"),
    key("posture", by_axis(quantity(kNone, "an angle")),
        "nominal joint angles by joint (globs; exact names first), for checks and starts")
        .otherwise("0"),
    key("joints", by_name(map_of(kJointKeys)), "actuated joints, in the order of commands and logs")
        .required(),
    key("drives", map_of(kDrivesKeys), "torque loops of series-elastic actuators"),
    key("groups", by_name(list(name_of("a joint"))), "lists of joints by name, with globs"),
    key("contacts", by_name(map_of(kContactKeys)), "points that can touch the world"),
    key("points", by_name(map_of(kPointKeys)), "points that tasks can control"),
    key("sensors", map_of(kSensorsKeys), "the sensors"),
    key("symmetry", map_of(kSymmetryKeys), "items exchanged in a mirror image"),
    key("limits", map_of(kLimitsKeys), "limits beyond which a fault is raised"),
    key("faults", by_name(choice(kReactionRows)), "reactions by [fault](#faults)"),
};

constexpr KeySpec kJointRows[] = {
    key("position", pair(quantity(kNone, "an angle")), "`[MINIMUM, MAXIMUM]`").required(),
    key("torque", quantity(kTorque), "limit in both directions").required(),
    key("sea", map_of(kSeaKeys), "the series-elastic actuator"),
};

constexpr KeySpec kSeaRows[] = {
    key("spring", quantity(kTorque, "a stiffness"), "its stiffness, Nm/rad"),
    key("rotor", quantity(kInertia), "inertia of the motor, seen from the joint"),
    key("torque", quantity(kTorque), "largest of the motor, seen from the joint").otherwise("none"),
    key("speed", quantity(kRate, "an angular velocity"),
        "of the motor, from which no torque drives it any faster; from 80 % on the torque fades")
        .otherwise("none"),
};

constexpr KeySpec kDrivesRows[] = {
    key("rate", quantity(kRate, "a rate in Hz"), "of the torque loops; a multiple of the physics'")
        .otherwise("12 kHz"),
    key("motor_filter", quantity(kRate, "a frequency in Hz"),
        "cutoff of the motor's velocity from its encoder, first order")
        .otherwise("none"),
    key("spring_filter", quantity(kRate, "a frequency in Hz"),
        "the same of the rate of the spring's deflection")
        .otherwise("none"),
    key("torque_loop", map_of(kTorqueLoopKeys),
        "gains at the start; keys of the other type are what a behavior's table of that type does "
        "not name")
        .required(),
};

constexpr WordSpec kContactTypeRows[] = {
    {"point", "three forces"},
    {"surface", "three forces and three moments, in limits"},
    {"fixed", "three forces and three moments, in both directions"},
};

constexpr KeySpec kContactRows[] = {
    key("site", text_of("a site's name"), "its position in the model").required(),
    key("type", choice(kContactTypeRows), "forces and moments that it can transmit")
        .otherwise("point"),
    key("group", name_of("a joint group"), "the joints of its leg"),
    key("radius", quantity(kLength),
        "of a ball about the site: distance of the contact point along the ground's normal")
        .otherwise("0 m"),
    key("friction", quantity(kNone),
        "coefficient assumed by `footfall check`; the simulated world has its own")
        .otherwise("0.9"),
};

constexpr KeySpec kPointRows[] = {
    key("site", text_of("a site's name"),
        "its position in the model, and the orientation of its frame"),
    key("body", text_of("a body's name"), "instead of a site: the body's own frame"),
};

constexpr KeySpec kSensorsRows[] = {
    key("imu", map_of(kImuKeys), "accelerometer and gyroscope"),
    key("mocap", map_of(kMocapKeys), "markers of a motion capture system"),
    key("switches", list(name_of("a contact")), "contacts with a switch"),
};

constexpr KeySpec kImuRows[] = {
    key("site", text_of("a site's name"), "its position").required(),
};

constexpr KeySpec kMocapRows[] = {
    key("sites", one_or_list(text_of("a site's name")), "the markers, with globs").required(),
};

constexpr KeySpec kSymmetryRows[] = {
    key("swap", pairs(name_of("a contact, group, point or joint")),
        "pairs to be exchanged: `[[right_foot, left_foot], ...]`")
        .required(),
};

constexpr KeySpec kLimitsRows[] = {
    key("tilt", quantity(kNone, "an angle"), "of the base, beyond which the robot has fallen")
        .otherwise("0.8 rad"),
    key("height", quantity(kNone, "a part"),
        "fraction of `standing_height`, below which the robot has fallen")
        .otherwise("60 %"),
    key("torque_step", quantity(kTorque), "change of a joint's torque between two ticks")
        .otherwise("none"),
    key("swing", quantity(kTime), "of a foot in the air while the behavior steps").otherwise("1 s"),
    key("slip", quantity(kLength),
        "by which a foot slides along the ground in about 0.2 s, above which the fault `slip` is "
        "raised")
        .otherwise("1 cm"),
    key("condition", quantity(kNone, "a ratio"),
        "of a level's largest to its smallest pivot (`task.TASK.condition`), above which the fault "
        "`condition` is raised; at 100 an error of the model of 1 % is a whole one of the task")
        .otherwise("100"),
    key("imu_age", quantity(kTime),
        "time without new data of the IMU, after which `imu.stale` is raised")
        .otherwise("20 ms"),
    key("mocap_age", quantity(kTime),
        "time without a new frame of motion capture, after which `mocap.stale` is raised")
        .otherwise("200 ms"),
    key("edit_ramp", quantity(kTime),
        "minimum ramp duration of values changed by a user during a run")
        .otherwise("100 ms"),
    key("overruns", integer(1, 1'000'000),
        "late ticks in a row, after which `tick.overrun` has its reaction; single ones are counted "
        "and logged")
        .otherwise("15"),
    key("reload_watch", quantity(kTime),
        "trial time after a reload, in which a fault with a reaction restores the former behavior")
        .otherwise("2 s"),
};

}  // namespace

constinit const core::KeyTable kRobotKeys = {
    .id = "robot", .doc = "The root of a robot file.", .keys = kRobotRows};
constinit const core::KeyTable kJointKeys = {
    .id = "joint", .doc = "An actuated joint.", .keys = kJointRows};
constinit const core::KeyTable kSeaKeys = {
    .id = "sea", .doc = "A series-elastic actuator.", .keys = kSeaRows};
constinit const core::KeyTable kDrivesKeys = {
    .id = "drives", .doc = "The drives of series-elastic actuators.", .keys = kDrivesRows};
constinit const core::KeyTable kContactKeys = {
    .id = "contact", .doc = "A point that can touch the world.", .keys = kContactRows};
constinit const core::KeyTable kPointKeys = {
    .id = "point",
    .doc = "A point that tasks can control, with a frame. Contacts are points, too.",
    .keys = kPointRows,
    .one_of = {"site body"}};
constinit const core::KeyTable kSensorsKeys = {
    .id = "sensors", .doc = "The sensors.", .keys = kSensorsRows};
constinit const core::KeyTable kImuKeys = {
    .id = "imu", .doc = "Accelerometer and gyroscope.", .keys = kImuRows};
constinit const core::KeyTable kMocapKeys = {
    .id = "mocap", .doc = "Motion capture.", .keys = kMocapRows};
constinit const core::KeyTable kSymmetryKeys = {
    .id = "symmetry", .doc = "Items exchanged in a mirror image.", .keys = kSymmetryRows};
constinit const core::KeyTable kLimitsKeys = {
    .id = "limits", .doc = "Limits beyond which a fault is raised.", .keys = kLimitsRows};
constinit const std::span<const core::WordSpec> kContactTypes = kContactTypeRows;
constinit const std::span<const core::WordSpec> kReactions = kReactionRows;

constinit const core::FileTable kRobotFile = {.kind = "robot", .newest = 1, .root = &kRobotKeys};

}  // namespace footfall::model
