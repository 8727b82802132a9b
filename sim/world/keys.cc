// Keys and words of a world file; see keys.h.
#include "sim/world/keys.h"

#include "model/aids/springs.h"
#include "model/robot/torque_loop.h"
#include "model/variation/variation.h"

namespace footfall::sim {
namespace {

using namespace core;  // constructors of the tables

constexpr WordSpec kTerrainBeliefRows[] = {
    {"exact", "as it is"},
    {"flat", "level ground, the plane z = 0"},
};

constexpr KeySpec kWorldRows[] = {
    key("world", integer(1, 1), "the version of world files; the first key").required(),
    key("base", text_of("the path of a world file"),
        "a file this one inherits, relative to this one: maps merge by key, everything else is "
        "replaced, "
        "`NAME: off` removes, `KEY+:` appends to a list"),
    key("name", name_of("a world"), "its name in logs and reports").otherwise("the file's name"),
    key("doc", text_of("a text"), "its purpose, in one line"),
    key("ground", map_of(kGroundKeys), "the ground"),
    key("terrain_belief", choice(kTerrainBeliefRows), map_of(kBeliefKeys),
        "what control model, estimator and checks take the terrain for: contact points and normals "
        "are those of the believed one")
        .otherwise("exact"),
    key("surface", map_of(kSurfaceKeys), "the ground height that the CoM follows"),
    key("actuators", map_of(kActuatorsKeys), "dynamics between command and joint torque"),
    key("sensors", map_of(kWorldSensorsKeys), "sensor imperfections"),
    key("control_model", map_of(kControlModelKeys),
        "model errors of the controller, relative to the simulation"),
    key("constraints", by_name(map_of(model::kConstraintKeys)),
        "external aids by name, such as a planarizer, a hoist or a harness; none by default"),
    key("axis_tilts", by_axis(quantity(kNone, "an angle")),
        "of joints about the z axis of their frame, in the simulation and not in the controller's "
        "model; what hangs on the joint turns, too")
        .otherwise("0 rad"),
    key("start", map_of(kStartKeys), "how the robot begins, before anything is drawn"),
    key("planner_latency", quantity(kTime), "time from a planner request to its answer")
        .otherwise("2 ms"),
    key("variation", map_of(model::kVariationKeys), "what a seed draws"),
    key("physics", map_of(kPhysicsKeys), "MuJoCo's settings"),
    key("stand", map_of(kStandKeys), "what holds the robot where there is no physics"),
};

constexpr KeySpec kGroundRows[] = {
    key("friction", quantity(kNone),
        "coefficient of sliding friction; instead of one that the base draws")
        .otherwise("0.9"),
    key("height_error", quantity(kLength),
        "largest error of its height, terrain's too: drawn uniformly below each foot for every "
        "step")
        .otherwise("0 m"),
    key("terrain", list(map_of(kTerrainKeys)), "pieces on the flat ground"),
};

constexpr KeySpec kTerrainRows[] = {
    key("box", map_of(kBoxKeys), "a box on the ground").required(),
};

constexpr KeySpec kBoxRows[] = {
    key("at", by_axis(quantity(kLength)), "centre of its top face, x and y in the world")
        .required(),
    key("size", by_axis(quantity(kLength)), "its edges along x, y, z, before it is turned")
        .required(),
    key("z", quantity(kLength, "a height"), "height of the centre of its top face")
        .otherwise("its edge along z: it stands on the plane"),
    key("roll", quantity(kNone, "an angle"),
        "turns it about the centre of its top face: first roll about x, then `pitch` about y, then "
        "`yaw` about z of the world")
        .otherwise("0 rad"),
    key("pitch", quantity(kNone, "an angle"), "likewise: positive, the top face falls along x")
        .otherwise("0 rad"),
    key("yaw", quantity(kNone, "an angle"), "likewise").otherwise("0 rad"),
};

constexpr KeySpec kBeliefRows[] = {
    key("error", map_of(kBeliefErrorKeys), "as it is, but for an error of each box").required(),
};

constexpr KeySpec kBeliefErrorRows[] = {
    key("tilt", quantity(kNone, "an angle"),
        "by which each box is turned about the centre of its top face, about a horizontal axis "
        "whose direction a seed draws")
        .otherwise("0 rad"),
    key("height", quantity(kLength), "by which each box is higher or lower; a seed draws the sign")
        .otherwise("0 m"),
};

constexpr KeySpec kSurfaceRows[] = {
    key("ramps", list(map_of(kRampKeys)), "ramps whose sum is the surface").required(),
};

constexpr KeySpec kRampRows[] = {
    key("from", quantity(kLength), "x in the world where it begins").required(),
    key("to", quantity(kLength), "x in the world where it ends").required(),
    key("rise", quantity(kLength), "rise; negative: fall").required(),
};

constexpr WordSpec kActuatorModelRows[] = {
    {"ideal", "the joint torque equals the command"},
    {"series_elastic", "motor, spring and torque loop"},
};

constexpr KeySpec kActuatorsRows[] = {
    key("model", choice(kActuatorModelRows), "actuator model").otherwise("ideal"),
    key("command_delay", quantity(kTime), "from the tick's command to the motor").otherwise("0 s"),
    key("measurement_delay", quantity(kTime),
        "series_elastic: from the drives' measurement to the tick")
        .otherwise("0 s"),
    key("viscous", quantity(kAngularMomentum, "a damping"),
        "series_elastic: viscous friction of every rotor, seen from the joint")
        .otherwise("0 Nm s/rad"),
    key("coulomb", quantity(kTorque),
        "series_elastic: Coulomb friction of every rotor, seen from the joint")
        .otherwise("0 Nm"),
    key("motor_resolution", quantity(kNone, "an angle"),
        "series_elastic: of the motors' encoders, seen from the joint")
        .otherwise("0 rad"),
    key("deflection_resolution", quantity(kNone, "an angle"),
        "series_elastic: of the springs' encoders, from which the torque is measured")
        .otherwise("0 rad"),
    key("spring", by_axis(quantity(kNone, "a change such as \"+3 %\"")),
        "series_elastic: relative change of the true springs, for all joints or by joint; the "
        "drives count on those of the robot's file")
        .otherwise("0 %"),
    key("stiffness", by_axis(quantity(kTorque, "a stiffness")),
        "series_elastic: springs in the place of those of the robot's file, known to the drives; "
        "for all joints or by joint")
        .otherwise("the robot's"),
    key("torque_loop", map_of(model::kTorqueLoopKeys),
        "series_elastic: the drives' gains in the place of those of the robot's file, all of them")
        .otherwise("the robot's"),
    key("command_limit", quantity(kNone, "a part"),
        "series_elastic: of commanded torques, as a part of the joints' limits; above 100 % these "
        "limit the measured torques: for torque loops that deliver less than they are told")
        .otherwise("100 %"),
    key("flexible", by_axis(quantity(kTorque, "a stiffness")),
        "series_elastic: links that bend about their joint's axis, behind its encoder: stiffness, "
        "for all joints or by joint")
        .otherwise("rigid"),
};

constexpr KeySpec kWorldSensorsRows[] = {
    key("joint", map_of(kJointSensorKeys), "joint encoders"),
    key("gyro", map_of(kGyroKeys), "the gyroscope"),
    key("accelerometer", map_of(kAccelerometerKeys), "the accelerometer"),
    key("imu", map_of(kImuSensorKeys), "gyroscope and accelerometer as one"),
    key("mocap", map_of(kMocapSensorKeys), "motion capture"),
    key("switch", map_of(kSwitchKeys), "foot switches"),
};

constexpr KeySpec kJointSensorRows[] = {
    key("resolution", quantity(kNone, "an angle"),
        "resolution of the encoder: positions are whole counts, velocities their change in a tick")
        .otherwise("0 rad"),
};

constexpr KeySpec kGyroRows[] = {
    key("noise", quantity(kRate, "an angular velocity"),
        "standard deviation of a tick's sample, white")
        .otherwise("0 rad/s"),
    key("bias", quantity(kRate, "an angular velocity"),
        "magnitude of each axis' constant offset; a seed draws the sign")
        .otherwise("0 rad/s"),
    key("walk", quantity(kRate, "an angular velocity"),
        "standard deviation of the offset's change in 1 s; grows with the root of time")
        .otherwise("0 rad/s"),
};

constexpr KeySpec kAccelerometerRows[] = {
    key("noise", quantity(kAcceleration), "standard deviation of a tick's sample, white")
        .otherwise("0 m/s^2"),
    key("bias", quantity(kAcceleration),
        "magnitude of each axis' constant offset; a seed draws the sign")
        .otherwise("0 m/s^2"),
    key("walk", quantity(kAcceleration),
        "standard deviation of the offset's change in 1 s; grows with the root of time")
        .otherwise("0 m/s^2"),
};

constexpr KeySpec kImuSensorRows[] = {
    key("mount", quantity(kNone, "an angle"),
        "standard deviation of its orientation on the base about each axis; a seed draws it")
        .otherwise("0 rad"),
};

constexpr KeySpec kMocapSensorRows[] = {
    key("rate", quantity(kRate, "a rate in Hz"), "frames a second").otherwise("every tick"),
    key("delay", quantity(kTime), "time from exposure to arrival").otherwise("0 s"),
    key("noise", quantity(kLength), "standard deviation of a marker's coordinate, white")
        .otherwise("0 m"),
    key("occlusion", quantity(kNone, "a part"), "part of the time in which a marker is hidden")
        .otherwise("0 %"),
    key("spell", quantity(kTime), "mean duration of such a time").otherwise("100 ms"),
    key("dropped", quantity(kNone, "a part"), "probability that a frame never arrives")
        .otherwise("0 %"),
    key("placement", quantity(kLength),
        "standard deviation of each marker's place on the base, x, y, z; a seed draws it")
        .otherwise("0 m"),
};

constexpr KeySpec kSwitchRows[] = {
    key("delay", quantity(kTime), "time from contact to report, and from its end").otherwise("0 s"),
    key("jitter", quantity(kTime), "added to it: uniform from 0 s, drawn for every change")
        .otherwise("0 s"),
    key("threshold", quantity(kForce), "normal force that closes the switch").otherwise("0 N"),
    key("bounce", quantity(kTime),
        "after a reported touchdown: open or closed at random in each tick")
        .otherwise("0 s"),
};

constexpr KeySpec kControlModelRows[] = {
    key("mass", quantity(kNone, "a change such as \"+5 %\""),
        "relative change of all masses, with sign")
        .otherwise("0 %"),
    key("com", by_name(by_axis(quantity(kLength))), "shift of the centre of mass, by body"),
};

constexpr WordSpec kIntegratorRows[] = {
    {"euler", "semi-implicit"},
    {"rk4", "Runge-Kutta of order 4"},
    {"implicit", "implicit in velocity"},
};
constexpr WordSpec kSolverRows[] = {
    {"newton", "exact second order"},
    {"cg", "conjugate gradient"},
    {"pgs", "projected Gauss-Seidel"},
};
constexpr WordSpec kConeRows[] = {
    {"elliptic", "the friction cone itself"},
    {"pyramidal", "four planes"},
};

constexpr KeySpec kPhysicsRows[] = {
    key("timestep_divisor", integer(1, 1000), "physics steps in a control tick").otherwise("2"),
    key("integrator", choice(kIntegratorRows), "of the equations of motion").otherwise("euler"),
    key("solver", choice(kSolverRows), "of the contact forces").otherwise("newton"),
    key("cone", choice(kConeRows), "of friction").otherwise("elliptic"),
    key("impratio", quantity(kNone), "stiffness of friction against that of the normal")
        .otherwise("10"),
    key("iterations", integer(1, 100'000), "maximum number of solver iterations").otherwise("100"),
    key("tolerance", quantity(kNone), "of the solver").otherwise("1e-8"),
    key("solref", list(any_quantity()), "`[TIME CONSTANT, DAMPING RATIO]` of contacts")
        .otherwise("[1 ms, 1]"),
    key("solimp", list(any_quantity()), "`[IMPEDANCE AT 0, IMPEDANCE AT WIDTH, WIDTH]` of contacts")
        .otherwise("[0.95, 0.99, 1 mm]"),
    key("hands", quantity(kRate),
        "frequency of people's hands that hold the robot: its weight moves them by g over its "
        "square")
        .otherwise("50 rad/s"),
};

constexpr KeySpec kStartRows[] = {
    key("joints", by_axis(quantity(kNone, "an angle")),
        "beside the robot's `posture`: for all joints or by joint")
        .otherwise("0 rad"),
    key("height", quantity(kLength), "of the lowest foot above the ground").otherwise("0 m"),
};

constexpr KeySpec kStandRows[] = {
    key("inertia", quantity(kInertia), "of every joint").otherwise("0.1 kg m^2"),
    key("stiffness", quantity(kTorque, "a stiffness"), "of every joint's spring; 0: free joints")
        .otherwise("2000 Nm/rad"),
    key("damping", quantity(kAngularMomentum, "a damping"), "beside the spring")
        .otherwise("20 Nm s/rad"),
    key("swing", quantity(kTime),
        "from the tick in which the control law lets go of a foot to its touchdown; 0: feet never "
        "leave")
        .otherwise("280 ms"),
};

}  // namespace

constinit const core::KeyTable kWorldKeys = {
    .id = "world", .doc = "The root of a world file.", .keys = kWorldRows};
constinit const core::KeyTable kGroundKeys = {
    .id = "ground", .doc = "The ground.", .keys = kGroundRows};
constinit const core::KeyTable kTerrainKeys = {
    .id = "terrain", .doc = "A piece of terrain.", .keys = kTerrainRows};
constinit const core::KeyTable kBoxKeys = {
    .id = "box", .doc = "A box on the ground.", .keys = kBoxRows};
constinit const core::KeyTable kBeliefKeys = {
    .id = "terrain_belief", .doc = "The terrain as it is believed.", .keys = kBeliefRows};
constinit const core::KeyTable kBeliefErrorKeys = {
    .id = "terrain_error", .doc = "How wrong the belief is.", .keys = kBeliefErrorRows};
constinit const core::KeyTable kSurfaceKeys = {
    .id = "surface", .doc = "The ground height that the CoM follows.", .keys = kSurfaceRows};
constinit const core::KeyTable kRampKeys = {
    .id = "ramp", .doc = "A range of x in which the surface rises.", .keys = kRampRows};
constinit const core::KeyTable kActuatorsKeys = {
    .id = "actuators", .doc = "Dynamics between command and joint torque.", .keys = kActuatorsRows};
constinit const core::KeyTable kWorldSensorsKeys = {
    .id = "world_sensors", .doc = "Sensor imperfections.", .keys = kWorldSensorsRows};
constinit const core::KeyTable kJointSensorKeys = {
    .id = "joint_sensor", .doc = "Joint encoders.", .keys = kJointSensorRows};
constinit const core::KeyTable kGyroKeys = {
    .id = "gyro", .doc = "The gyroscope.", .keys = kGyroRows};
constinit const core::KeyTable kAccelerometerKeys = {
    .id = "accelerometer", .doc = "The accelerometer.", .keys = kAccelerometerRows};
constinit const core::KeyTable kImuSensorKeys = {
    .id = "imu_sensor", .doc = "Gyroscope and accelerometer as one.", .keys = kImuSensorRows};
constinit const core::KeyTable kMocapSensorKeys = {
    .id = "mocap_sensor", .doc = "Motion capture.", .keys = kMocapSensorRows};
constinit const core::KeyTable kSwitchKeys = {
    .id = "switch", .doc = "Foot switches.", .keys = kSwitchRows};
constinit const core::KeyTable kControlModelKeys = {
    .id = "control_model",
    .doc = "Model errors of the controller, relative to the simulation.",
    .keys = kControlModelRows};
constinit const core::KeyTable kPhysicsKeys = {
    .id = "physics", .doc = "MuJoCo's settings.", .keys = kPhysicsRows};
constinit const core::KeyTable kStartKeys = {
    .id = "world_start", .doc = "How the robot begins.", .keys = kStartRows};
constinit const core::KeyTable kStandKeys = {
    .id = "stand",
    .doc =
        "What holds the robot on the backend `stub`, which has no physics: each joint is an "
        "inertia on a spring to its start.",
    .keys = kStandRows};
constinit const std::span<const core::WordSpec> kTerrainBeliefs = kTerrainBeliefRows;
constinit const std::span<const core::WordSpec> kActuatorModels = kActuatorModelRows;
constinit const std::span<const core::WordSpec> kIntegrators = kIntegratorRows;
constinit const std::span<const core::WordSpec> kSolvers = kSolverRows;
constinit const std::span<const core::WordSpec> kCones = kConeRows;

constinit const core::FileTable kWorldFile = {.kind = "world", .newest = 1, .root = &kWorldKeys};

}  // namespace footfall::sim
