// Keys and words of a scenario file; see keys.h.
#include "lab/scenario/keys.h"

#include "lab/scenario/description.h"
#include "model/aids/springs.h"
#include "model/variation/variation.h"

namespace footfall::lab {
namespace {

using namespace core;  // constructors of the tables

constexpr KeySpec kScenarioRows[] = {
    key("scenario", integer(1, 1), "the version of scenario files; the first key").required(),
    key("base", text_of("the path of a scenario file"),
        "a file this one inherits, relative to this one: maps merge by key, everything else is "
        "replaced, "
        "`NAME: off` removes, `KEY+:` appends to a list"),
    key("name", name_of("a scenario"), "its name in reports").otherwise("the file's name"),
    key("doc", text_of("a text"), "its purpose, in one line"),
    key("labels", list(name_of("a label")),
        "words by which `footfall test` selects scenarios: `quick`"),
    key("behavior", text_of("a file beside this one, or a name in the library"), "the behavior")
        .required(),
    key("robot", text_of("a name or path"), "the robot").otherwise("the behavior's"),
    key("world", text_of("a name or path"), "the world").otherwise("flat"),
    key("variation", map_of(model::kVariationKeys),
        "what a seed draws, over what the world says; off: nothing"),
    key("seeds", list(integer(0, 1'000'000'000)),
        text_of("a number, or a range such as `100..119`"), "one run each")
        .otherwise("1"),
    key("for", quantity(kTime), "duration of a run").required(),
    key("script", list(map_of(kScriptKeys)), "external events"),
    key("scripts", one_or_list(text_of("the path of a Lua file")),
        "Lua files beside this one with functions for `call`"),
    key("expect", list(condition()), list(map_of(kExpectationKeys)),
        "expectations; a single condition is judged at the end of every run"),
    key("golden", map_of(kGoldenKeys), "a recorded trace that the first seed's run must follow"),
};

constexpr WordSpec kInjectedFaultRows[] = {
    {"mocap.dropout", "no motion capture data"},
    {"imu.dropout", "no IMU data"},
    {"sensor.dropout", "no data of any sensor"},
    {"planner.dropout", "no answers of planners"},
    {"imu.freeze", "the IMU's data stay the same, and are said to be new"},
    {"mocap.freeze", "motion capture's frames stay the same, and are said to be new"},
    {"led.loss", "motion capture sees two markers at most"},
};

constexpr WordSpec kScenarioEndRows[] = {
    {"time", "`for` has elapsed"},
    {"finished", "a final state of the root was entered"},
    {"fall", "the robot fell"},
    {"fault", "a fault ended the run"},
};

constexpr KeySpec kScriptRows[] = {
    key("at", quantity(kTime), map_of(kMomentKeys), "a time in the run, or a phase of it"),
    key("on", name_of("an event or prefix"), "each time that this event is raised"),
    key("push", map_of(kPushKeys), "a force on a body"),
    key("edit", by_name(one_or_list(any_quantity())),
        "a live edit: parameters and gains by name (`goal.x` for one value), applied whole or not "
        "at all"),
    key("over", quantity(kTime), "duration of the edit's ramp").otherwise("0 s"),
    key("set", by_name(one_or_list(any_quantity())), "parameters by name, without ramp"),
    key("raise", name_of("an event"), "an external event, together with the edit if there is one"),
    key("fault", choice(kInjectedFaultRows), "a component that fails"),
    key("hold", name_of("a body"), map_of(model::kHoldKeys),
        "a body held in place; as a map only along and about some axes, or with other springs"),
    key("call", name_of("a Lua function"),
        "a function of `scripts`: it sets values without ramp, and raises external events"),
    key("for", quantity(kTime), "duration of `fault` or `hold`").otherwise("to the end of the run"),
    key("optional", boolean(),
        "whether the run may end before this comes; otherwise a run in which it never came fails")
        .otherwise("false"),
    key("doc", text_of("a text"), "reason, in one line"),
};

constexpr KeySpec kMomentRows[] = {
    key("step", integer(1, 1'000'000'000), "number of the step, from 1"),
    key("state", name_of("a state"),
        "while this state is active: a suffix of its path, of left and right alike"),
    key("phase", quantity(kNone, "a part"),
        "fraction of the state's or the step's duration, below 100 %")
        .otherwise("0 %"),
};

constexpr KeySpec kPushRows[] = {
    key("body", name_of("a body"), "body that it acts on").otherwise("the floating base"),
    key("force", quantity(kForce), "magnitude").required(),
    key("for", quantity(kTime), "duration").required(),
    key("direction", quantity(kNone, "an angle"), "in the heading frame: 0 forward, 90 deg left")
        .otherwise("0 deg"),
    key("elevation", quantity(kNone, "an angle"),
        "above the horizontal: 90 deg upwards, -90 deg downwards")
        .otherwise("0 deg"),
    key("point", by_axis(quantity(kLength)), "where it acts, in the body's frame")
        .otherwise("its centre of mass"),
};

constexpr KeySpec kGoldenRows[] = {
    key("file", text_of("the path of a CSV file"), "the trace, relative to this file")
        .otherwise("NAME.golden.csv, with the scenario file's name"),
    key("tolerance", by_name(any_quantity()), "signals by name, with their tolerances").required(),
    key("rate", quantity(kRate), "rows of the trace per second").otherwise("50 Hz"),
    key("doc", text_of("a text"), "reason, in one line"),
};

constexpr KeySpec kExpectationRows[] = {
    key("that", condition(),
        "a condition; statistics of a signal, such as `rms`, are of the whole time"),
    key("never", condition(), "a condition that must be false in every tick"),
    key("sequence", list(name_of("a state")), "states that are entered in this order"),
    key("end", choice(kScenarioEndRows), list(choice(kScenarioEndRows)),
        "how the run ends; without it by `time` or `finished`"),
    key("after", quantity(kTime), "judged from this time in the run on"),
    key("between", pair(quantity(kTime)), "judged between these times in the run"),
    key("within", quantity(kTime),
        "maximum duration of `sequence`, or the time by which `that` holds"),
    key("in", text_of("a part such as `95 % of seeds`"), "fraction of runs in which it must hold")
        .otherwise("100 % of seeds"),
    key("doc", text_of("a text"), "reason, in one line"),
};

}  // namespace

constinit const core::KeyTable kScenarioKeys = {
    .id = "scenario", .doc = "The root of a scenario file.", .keys = kScenarioRows};
constinit const core::KeyTable kScriptKeys = {
    .id = "script",
    .doc = "An external event.",
    .keys = kScriptRows,
    .one_of = {"at on", "push edit set raise fault hold call"}};
constinit const core::KeyTable kMomentKeys = {
    .id = "moment", .doc = "A phase of the run.", .keys = kMomentRows, .one_of = {"step state"}};
constinit const core::KeyTable kPushKeys = {
    .id = "push", .doc = "A constant force on a body.", .keys = kPushRows};
constinit const core::KeyTable kExpectationKeys = {.id = "expectation",
                                                   .doc = "An expectation.",
                                                   .keys = kExpectationRows,
                                                   .one_of = {"that never sequence end"}};
constinit const core::KeyTable kGoldenKeys = {
    .id = "golden",
    .doc = "A recorded trace and the tolerances of a run relative to it.",
    .keys = kGoldenRows};
constinit const std::span<const core::WordSpec> kInjectedFaults = kInjectedFaultRows;
static_assert(std::size(kInjectedFaultRows) == kInjectedFaultCount);
constinit const std::span<const core::WordSpec> kScenarioEnds = kScenarioEndRows;

constinit const core::FileTable kScenarioFile = {
    .kind = "scenario", .newest = 1, .root = &kScenarioKeys};

}  // namespace footfall::lab
