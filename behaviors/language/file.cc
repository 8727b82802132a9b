// The root of a behavior file and its sections except states and tasks; see language.h.
#include "behaviors/language/language.h"
#include "model/robot/torque_loop.h"

namespace footfall::behaviors {
namespace {

using namespace core;  // constructors of the tables

constexpr KeySpec kBehaviorRows[] = {
    key("behavior", integer(1, 1), "the version of the language; the first key of the file")
        .required(),
    key("base", text_of("the path of a behavior file, or the name of one in the library"),
        "a file this one inherits, relative to this one: maps merge by key, all else is replaced, "
        "`NAME: off` removes, `KEY+:` appends to a list"),
    key("name", text_of("a name"), "the behavior's name in logs and reports")
        .otherwise("the file's name"),
    key("doc", text_of("a text"), "purpose of the behavior, in one line"),
    key("robot", text_of("the name of a robot"),
        "a folder of `robots/` or the path of a robot file; without it the behavior is a pure "
        "statechart"),
    key("parameters", by_name(map_of(kParameterKeys)), by_name(one_or_list(any_quantity())),
        "named numbers, used as `$NAME`, set with `--set NAME=VALUE`"),
    key("events", by_name(text_of("a description")),
        "events that may be raised externally, each with a description"),
    key("gains", map_of(kGainTablesKeys), "tables of task gains, and their ranges"),
    key("torque_loop", map_of(kTorqueLoopTablesKeys),
        "tables of the actuators' own gains, chosen in stacks and states, and their ranges"),
    key("estimator", map_of(kEstimatorKeys),
        "what makes the state out of the sensors, and its parameters"),
    key("planners", by_name(map_of(kPlannerKeys)), "planners that states may `invoke`"),
    key("stacks", by_name(map_of(kStackKeys)), "named sets of contacts, tasks and internal forces"),
    key("templates", by_name(map_of(kTemplateKeys)),
        "states with arguments, for `use` and `mirror`"),
    key("scripts", one_or_list(text_of("the path of a Lua file")), map_of(kScriptsKeys),
        "Lua files beside this one: functions that `call:` runs, and handlers of events"),
    key("machine", map_of(kMachineKeys), "the root state, always active").required(),
};

constexpr KeySpec kScriptsRows[] = {
    key("files", one_or_list(text_of("the path of a Lua file")), "Lua files beside this one")
        .required(),
    key("instructions", integer(1000, 1'000'000'000'000),
        "maximum number of virtual machine instructions in one call")
        .otherwise("10000000"),
    key("deadline", quantity(core::kTime),
        "processor time after which a call that does not come back is given up, with the fault "
        "script.stuck; by the clock ten times that, at least 1 s")
        .otherwise("2 s and 200 ns for each of its instructions"),
    key("doc", text_of("a text"), "their purpose, in one line"),
};

constexpr KeySpec kParameterRows[] = {
    key("value", one_or_list(any_quantity()),
        "a number with its unit, or a list of up to 16 of them")
        .required(),
    key("range", pair(any_quantity()),
        "`[MINIMUM, MAXIMUM]` of every value; required with `live: true`"),
    key("live", boolean(),
        "whether it may be edited while the behavior runs; not if an action sets it")
        .otherwise("false"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

constexpr Dimension kRateCubed{0, 0, -3};

constexpr KeySpec kGainRangesRows[] = {
    key("kp", pair(quantity(kRateSquared)), "`[MINIMUM, MAXIMUM]` of every kp"),
    key("ki", pair(quantity(kRateCubed)), "`[MINIMUM, MAXIMUM]` of every ki"),
    key("kd", pair(quantity(kRate)), "`[MINIMUM, MAXIMUM]` of every kd"),
};

constexpr KeySpec kGainsRows[] = {
    key("kp", computed(by_axis(quantity(kRateSquared))), "acceleration per error").otherwise("0"),
    key("ki", computed(by_axis(quantity(kRateCubed))), "acceleration per integral of the error")
        .otherwise("0"),
    key("kd", computed(by_axis(quantity(kRate))), "acceleration per velocity error").otherwise("0"),
};

constexpr KeySpec kGainTablesRows[] = {
    key("ranges", map_of(kGainRangesKeys),
        "bounds of all gains of the file; with them gains are live"),
};
constexpr ValueSpec kGainTable = map_of(kGainTableKeys);
constexpr ValueSpec kGains = map_of(kGainsKeys);

constexpr KeySpec kTorqueLoopRangesRows[] = {
    key("p", pair(any_quantity("a gain")), "`[MINIMUM, MAXIMUM]` of every p"),
    key("i", pair(any_quantity("a gain")), "`[MINIMUM, MAXIMUM]` of every i"),
    key("d", pair(quantity(kAngularMomentum, "a damping")), "`[MINIMUM, MAXIMUM]` of every d"),
    key("forward", pair(quantity(kNone)), "`[MINIMUM, MAXIMUM]` of every forward"),
    key("observer", pair(quantity(kRate, "a frequency in Hz")),
        "`[MINIMUM, MAXIMUM]` of every observer"),
    key("velocity_p", pair(quantity(kAngularMomentum, "a damping")),
        "`[MINIMUM, MAXIMUM]` of every velocity_p"),
    key("velocity_i", pair(quantity(kTorque, "a stiffness")),
        "`[MINIMUM, MAXIMUM]` of every velocity_i"),
};

constexpr KeySpec kTorqueLoopTablesRows[] = {
    key("ranges", map_of(kTorqueLoopRangesKeys),
        "bounds of the gains of all tables, 0 or more; with them gains are live"),
};
constexpr ValueSpec kTorqueLoop = map_of(model::kTorqueLoopKeys);

constexpr WordSpec kPlannerTypeRows[] = {
    {"velocity_reversal",
     "places the next foot so that the CoM's velocity reverses a constant time after the switch "
     "(Kim et al. 2016, eqs (19)-(21))"},
};

constexpr WordSpec kOff[] = {{"off", "not at all"}};

constexpr KeySpec kPlannerRows[] = {
    key("type", choice(kPlannerTypeRows), "type of planner").required(),
    key("kappa", by_axis(quantity(kNone)), map_of(kKappaKeys),
        "pull towards the goal, for x (forward) and y (left) of the heading frame"),
    key("reversal", by_axis(quantity(kTime)),
        "time from the switch to the reversal of the CoM's velocity, for x and y")
        .otherwise("200 ms"),
    key("goal", by_axis(quantity(kLength)), "target position, x and y in the world; often `$goal`")
        .otherwise("[0, 0]"),
    key("goal_speed", quantity(kVelocity), "approach speed after a jump of the goal")
        .otherwise("at once"),
    key("goal_error_limit", quantity(kLength), "limit of the distance to the goal, for each axis")
        .otherwise("none"),
    key("width_offset", quantity(kLength), "lateral offset outwards: width of the steady step")
        .otherwise("0 m"),
    key("reach", map_of(kReachKeys),
        "range of the swing foot; targets beyond are moved to its edge"),
    key("velocity_filter", quantity(kTime),
        "time constant of the CoM velocity filter, which predicts with the pendulum")
        .otherwise("0 s"),
    key("extension", map_of(kExtensionKeys), choice(kOff),
        "the paper's swing-time rule: by how much landing should be delayed, as the signal "
        "`planner.NAME.extension`")
        .otherwise("off"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

constexpr KeySpec kKappaRows[] = {
    key("value", by_axis(quantity(kNone)), "for x and y").required(),
    key("range", pair(quantity(kNone)), "allowed range").otherwise("[0, 1]"),
};

constexpr KeySpec kReachRows[] = {
    key("x", quantity(kLength), "farthest step forwards or backwards").otherwise("none"),
    key("y", pair(quantity(kLength)), "`[MINIMUM, MAXIMUM]` width between the feet")
        .otherwise("none"),
};

constexpr KeySpec kExtensionRows[] = {
    key("speed", quantity(kVelocity),
        "lateral CoM speed at the switch for which landing is delayed; 0 is off"),
    key("limit", quantity(kTime), "maximum delay"),
};

constexpr KeySpec kStackRows[] = {
    key("contacts", list(name_of("a contact")),
        "constrained contacts; all others are free. `[]` is flight"),
    key("gains", name_of("a gain table"), "the table with the gains of these tasks"),
    key("tasks", by_name(map_of(kTaskKeys)), "controlled quantities, with priorities"),
    key("internal", by_name(map_of(kInternalKeys)), "internal forces between contacts"),
    key("torque_loop", by_name(name_of("a torque_loop table")),
        "the actuators' gains, by the foot whose leg it is or by joint group"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

}  // namespace

constinit const core::KeyTable kBehaviorKeys = {
    .id = "behavior", .doc = "The root of a behavior file.", .keys = kBehaviorRows};
constinit const core::KeyTable kScriptsKeys = {
    .id = "scripts", .doc = "Lua scripts, run outside of the control loop.", .keys = kScriptsRows};
constinit const core::KeyTable kParameterKeys = {
    .id = "parameter",
    .doc =
        "A parameter: a number, a list of numbers, or a map with these keys. One that an action "
        "`set`s is a variable: reset to `value` at the start of every run.",
    .keys = kParameterRows};
constinit const core::KeyTable kGainTablesKeys = {
    .id = "gain_tables",
    .doc = "All gains of the file, in tables by name.",
    .keys = kGainTablesRows,
    .others = &kGainTable,
    .others_name = "a table"};
constinit const core::KeyTable kGainRangesKeys = {
    .id = "gain_ranges", .doc = "Bounds of the gains.", .keys = kGainRangesRows};
constinit const core::KeyTable kGainTableKeys = {.id = "gain_table",
                                                 .doc = "One table: the gains of each task.",
                                                 .keys = {},
                                                 .others = &kGains,
                                                 .others_name = "a task"};
constinit const core::KeyTable kGainsKeys = {
    .id = "gains",
    .doc =
        "Gains of one task: u = x''_ref + kp e + ki ∫e + kd e'. At least one of them; one number "
        "for all axes, a list in the order of the task's axes, or a map by axis or joint. Plain "
        "numbers are live gains; parameters and expressions are evaluated in every tick.",
    .keys = kGainsRows,
    .one_of = {"kp ki kd"},
    .part = true};
constinit const core::KeyTable kTorqueLoopTablesKeys = {
    .id = "torque_loop_tables",
    .doc = "Gains of the actuators' own torque loops, in tables by name.",
    .keys = kTorqueLoopTablesRows,
    .others = &kTorqueLoop,
    .others_name = "a table"};
constinit const core::KeyTable kTorqueLoopRangesKeys = {
    .id = "torque_loop_ranges",
    .doc =
        "Bounds of the torque loops' gains. The units of p and i are those of the tables' type: "
        "with tables of both types they are written without.",
    .keys = kTorqueLoopRangesRows};
constinit const core::KeyTable kPlannerKeys = {.id = "planner",
                                               .doc = "Computes plans outside of the tick.",
                                               .keys = kPlannerRows,
                                               .selector = "type",
                                               .variants = kPlannerTypeRows};
constinit const core::KeyTable kKappaKeys = {
    .id = "kappa", .doc = "A kappa outside its default range.", .keys = kKappaRows};
constinit const core::KeyTable kReachKeys = {
    .id = "reach",
    .doc = "Range of the swing foot relative to the stance foot.",
    .keys = kReachRows};
constinit const core::KeyTable kExtensionKeys = {
    .id = "extension", .doc = "The paper's swing-time rule.", .keys = kExtensionRows};
constinit const core::KeyTable kStackKeys = {
    .id = "stack",
    .doc =
        "A named set of contacts, tasks and internal forces. Its `$names` are resolved in the "
        "state that names it.",
    .keys = kStackRows};
constinit const std::span<const core::WordSpec> kPlannerTypes = kPlannerTypeRows;

constinit const core::FileTable kBehaviorFile = {
    .kind = "behavior", .newest = 1, .root = &kBehaviorKeys};

}  // namespace footfall::behaviors
