// The root of a behavior file and its sections except states and tasks; see language.h.
#include "behaviors/language/language.h"

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
    key("doc", text_of("a text"), "what the behavior does, in a line"),
    key("robot", text_of("the name of a robot"),
        "a folder of `robots/` or the path of a robot file; without it the behavior is a pure "
        "statechart"),
    key("parameters", by_name(map_of(kParameterKeys)), by_name(one_or_list(any_quantity())),
        "numbers under a name, used as `$NAME`, set with `--set NAME=VALUE`"),
    key("events", by_name(text_of("what it means")),
        "events that may be raised from outside, each with its meaning"),
    key("gains", map_of(kGainTablesKeys), "tables of task gains, and the ranges they may have"),
    key("torque_loop", by_name(map_of(kTorqueLoopKeys)),
        "tables of the actuators' own gains, chosen in stacks and states"),
    key("planners", by_name(map_of(kPlannerKeys)), "what states may `invoke`"),
    key("stacks", by_name(map_of(kStackKeys)), "contacts, tasks and internal forces under a name"),
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
        "of the virtual machine that one call may take")
        .otherwise("10000000"),
    key("doc", text_of("a text"), "what they are for, in a line"),
};

constexpr KeySpec kParameterRows[] = {
    key("value", one_or_list(any_quantity()),
        "a number with its unit, or a list of up to 16 of them")
        .required(),
    key("range", pair(any_quantity()),
        "`[LEAST, GREATEST]` of every value; needed where `live: true`"),
    key("live", boolean(),
        "whether it may be edited while the behavior runs; not for one that an action sets")
        .otherwise("false"),
    key("doc", text_of("a text"), "what it is for, in a line"),
};

constexpr Dimension kRateCubed{0, 0, -3};

constexpr KeySpec kGainRangesRows[] = {
    key("kp", pair(quantity(kRateSquared)), "`[LEAST, GREATEST]` of every kp"),
    key("ki", pair(quantity(kRateCubed)), "`[LEAST, GREATEST]` of every ki"),
    key("kd", pair(quantity(kRate)), "`[LEAST, GREATEST]` of every kd"),
};

constexpr KeySpec kGainsRows[] = {
    key("kp", computed(by_axis(quantity(kRateSquared))), "acceleration per error").otherwise("0"),
    key("ki", computed(by_axis(quantity(kRateCubed))), "acceleration per integral of the error")
        .otherwise("0"),
    key("kd", computed(by_axis(quantity(kRate))), "acceleration per error of velocity")
        .otherwise("0"),
};

constexpr KeySpec kGainTablesRows[] = {
    key("ranges", map_of(kGainRangesKeys),
        "bounds of all gains of the file; with them gains are live"),
};
constexpr ValueSpec kGainTable = map_of(kGainTableKeys);
constexpr ValueSpec kGains = map_of(kGainsKeys);

constexpr KeySpec kTorqueLoopRows[] = {
    key("p", by_axis(quantity(kNone)), "motor torque per error of spring torque, by joint"),
    key("i", by_axis(quantity(kRate)), "motor torque per integral of that error, by joint"),
    key("d", by_axis(quantity(kTime)), "motor torque per rate of that error, by joint"),
};

constexpr WordSpec kPlannerTypeRows[] = {
    {"velocity_reversal",
     "puts the next foot so that the CoM's velocity reverses a constant time after the switch "
     "(Kim et al. 2016, eqs (19)-(21))"},
};

constexpr WordSpec kOff[] = {{"off", "not at all"}};

constexpr KeySpec kPlannerRows[] = {
    key("type", choice(kPlannerTypeRows), "which planner").required(),
    key("kappa", by_axis(quantity(kNone)), map_of(kKappaKeys),
        "pull towards the goal, for x (forward) and y (left) of the heading frame"),
    key("reversal", by_axis(quantity(kTime)),
        "time from the switch to the reversal of the CoM's velocity, for x and y")
        .otherwise("200 ms"),
    key("goal", by_axis(quantity(kLength)), "where to stay, x and y in the world; often `$goal`")
        .otherwise("[0, 0]"),
    key("goal_speed", quantity(kVelocity), "speed with which a goal that jumps is approached")
        .otherwise("at once"),
    key("goal_error_limit", quantity(kLength),
        "bound of the distance to the goal that is used, for each axis")
        .otherwise("none"),
    key("width_offset", quantity(kLength), "added outwards, so that the steady step has a width")
        .otherwise("0 m"),
    key("reach", map_of(kReachKeys), "where feet can go; a target beyond is moved to the edge"),
    key("velocity_filter", quantity(kTime),
        "time constant of a filter of the CoM's velocity that predicts with the pendulum")
        .otherwise("0 s"),
    key("extension", map_of(kExtensionKeys), choice(kOff),
        "the paper's swing-time rule: how much longer landing should take, as the signal "
        "`planner.NAME.extension`")
        .otherwise("off"),
    key("doc", text_of("a text"), "what it is for, in a line"),
};

constexpr KeySpec kKappaRows[] = {
    key("value", by_axis(quantity(kNone)), "for x and y").required(),
    key("range", pair(quantity(kNone)), "what it may be").otherwise("[0, 1]"),
};

constexpr KeySpec kReachRows[] = {
    key("x", quantity(kLength), "farthest step forwards or backwards").otherwise("none"),
    key("y", pair(quantity(kLength)), "`[LEAST, GREATEST]` width between the feet")
        .otherwise("none"),
};

constexpr KeySpec kExtensionRows[] = {
    key("speed", quantity(kVelocity),
        "lateral CoM speed at the switch that landing waits for; 0 is off"),
    key("limit", quantity(kTime), "longest prolongation"),
};

constexpr KeySpec kStackRows[] = {
    key("contacts", list(name_of("a contact")),
        "what holds; all other contacts are free. `[]` is flight"),
    key("gains", name_of("a gain table"), "the table that has the gains of these tasks"),
    key("tasks", by_name(map_of(kTaskKeys)), "what is controlled, by priority"),
    key("internal", by_name(map_of(kInternalKeys)), "forces between contacts"),
    key("torque_loop", by_name(name_of("a torque_loop table")),
        "the actuators' gains, by the foot whose leg it is or by joint group"),
    key("doc", text_of("a text"), "what it is for, in a line"),
};

}  // namespace

constinit const core::KeyTable kBehaviorKeys = {
    .id = "behavior", .doc = "The root of a behavior file.", .keys = kBehaviorRows};
constinit const core::KeyTable kScriptsKeys = {
    .id = "scripts",
    .doc = "Scripts in Lua, run beside the control loop and never in it.",
    .keys = kScriptsRows};
constinit const core::KeyTable kParameterKeys = {
    .id = "parameter",
    .doc =
        "A parameter: a number, a list of numbers, or a map with these keys. One that an action "
        "`set`s is a variable: back at `value` in every run.",
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
        "Gains of one task: u = x''_ref + kp e + ki ∫e + kd e'. At least one of them; a number "
        "for all axes, a list in the order of the task's axes, or a map by axis or joint. Plain "
        "numbers are live gains; what holds a parameter or an expression is computed every tick.",
    .keys = kGainsRows,
    .one_of = {"kp ki kd"},
    .part = true};
constinit const core::KeyTable kTorqueLoopKeys = {
    .id = "torque_loop",
    .doc =
        "Gains of the actuators' own torque control: a number for all joints, or a map by joint "
        "(globs such as \"*knee\"; exact names first).",
    .keys = kTorqueLoopRows};
constinit const core::KeyTable kPlannerKeys = {.id = "planner",
                                               .doc = "What computes a plan beside the tick.",
                                               .keys = kPlannerRows,
                                               .selector = "type",
                                               .variants = kPlannerTypeRows};
constinit const core::KeyTable kKappaKeys = {
    .id = "kappa", .doc = "A kappa outside its usual range.", .keys = kKappaRows};
constinit const core::KeyTable kReachKeys = {
    .id = "reach", .doc = "Where the swing foot can go, from the stance foot.", .keys = kReachRows};
constinit const core::KeyTable kExtensionKeys = {
    .id = "extension", .doc = "The paper's swing-time rule.", .keys = kExtensionRows};
constinit const core::KeyTable kStackKeys = {
    .id = "stack",
    .doc =
        "Contacts, tasks and internal forces under a name. Its `$names` are looked up where a "
        "state names it.",
    .keys = kStackRows};
constinit const std::span<const core::WordSpec> kPlannerTypes = kPlannerTypeRows;

constinit const core::FileTable kBehaviorFile = {
    .kind = "behavior", .newest = 1, .root = &kBehaviorKeys};

}  // namespace footfall::behaviors
