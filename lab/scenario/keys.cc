// Keys and words of a scenario file; see keys.h.
#include "lab/scenario/keys.h"

namespace footfall::lab {
namespace {

using namespace core;  // the words in which tables are written

constexpr KeySpec kScenarioRows[] = {
    key("scenario", integer(1, 1), "the version of scenario files; the first key").required(),
    key("base", text_of("the path of a scenario file"),
        "a file this one inherits, relative to this one: maps merge by key, all else is replaced, "
        "`NAME: off` removes, `KEY+:` appends to a list"),
    key("name", name_of("a scenario"), "its name in reports").otherwise("the file's name"),
    key("doc", text_of("a text"), "what it shows, in a line"),
    key("labels", list(name_of("a label")), "words by which `footfall test` picks: `quick`"),
    key("behavior", text_of("a file beside this one, or a name in the library"), "what runs")
        .required(),
    key("robot", text_of("a name or path"), "on which robot").otherwise("the behavior's"),
    key("world", text_of("a name or path"), "in which world").otherwise("flat"),
    key("seeds", list(integer(0, 1'000'000'000)),
        text_of("a number, or a range such as `100..119`"), "one run each")
        .otherwise("1"),
    key("for", quantity(kTime), "how long a run lasts").required(),
    key("script", list(map_of(kScriptKeys)), "what happens to the robot from outside"),
    key("scripts", one_or_list(text_of("the path of a Lua file")),
        "files of Lua beside this one, whose functions `call` names"),
    key("expect", list(condition()), list(map_of(kExpectationKeys)),
        "what must hold; a lone condition is judged at the end of every run"),
    key("golden", map_of(kGoldenKeys), "a recorded trace that the first seed's run must follow"),
};

constexpr WordSpec kInjectedFaultRows[] = {
    {"mocap.dropout", "no motion capture data"},
    {"imu.dropout", "no IMU data"},
    {"sensor.dropout", "no data of any sensor"},
    {"planner.dropout", "no answers of planners"},
};

constexpr WordSpec kScenarioEndRows[] = {
    {"time", "`for` is over"},
    {"finished", "a final state of the root was entered"},
    {"fall", "the robot fell"},
    {"fault", "a fault stopped it"},
};

constexpr KeySpec kScriptRows[] = {
    key("at", quantity(kTime), map_of(kMomentKeys), "when: a time in the run, or a place in it"),
    key("on", name_of("an event or prefix"), "when: each time that this event is raised"),
    key("push", map_of(kPushKeys), "a horizontal force on a body"),
    key("edit", by_name(one_or_list(any_quantity())),
        "a live edit: parameters and gains by name (`goal.x` for one value), applied whole or not "
        "at all"),
    key("over", quantity(kTime), "time in which the edit ramps").otherwise("0 s"),
    key("set", by_name(one_or_list(any_quantity())), "parameters by name, at once"),
    key("raise", name_of("an event"), "an event from outside, with the edit if there is one"),
    key("fault", choice(kInjectedFaultRows), "something that fails"),
    key("hold", name_of("a body"), "a body that people hold where it is"),
    key("call", name_of("a Lua function"),
        "a function of `scripts`: what it sets is set at once, what it raises comes from outside"),
    key("for", quantity(kTime), "how long `fault` or `hold` lasts")
        .otherwise("to the end of the run"),
    key("doc", text_of("a text"), "why, in a line"),
};

constexpr KeySpec kMomentRows[] = {
    key("step", integer(1, 1'000'000'000), "number of the step, from 1"),
    key("state", name_of("a state"),
        "while this state is active: a suffix of its path, of left and right alike"),
    key("phase", quantity(kNone, "a part"), "of the state's or the step's duration, below 100 %")
        .otherwise("0 %"),
};

constexpr KeySpec kPushRows[] = {
    key("body", name_of("a body"), "at whose centre of mass it acts")
        .otherwise("the floating base"),
    key("force", quantity(kForce), "its size").required(),
    key("for", quantity(kTime), "how long it lasts").required(),
    key("direction", quantity(kNone, "an angle"), "in the heading frame: 0 forward, 90 deg left")
        .otherwise("0 deg"),
};

constexpr KeySpec kGoldenRows[] = {
    key("file", text_of("the path of a CSV file"), "the trace, relative to this file")
        .otherwise("NAME.golden.csv, with the scenario file's name"),
    key("tolerance", by_name(any_quantity()),
        "signals by name, and how far each may be from the trace")
        .required(),
    key("rate", quantity(kRate), "rows of the trace in a second").otherwise("50 Hz"),
    key("doc", text_of("a text"), "why, in a line"),
};

constexpr KeySpec kExpectationRows[] = {
    key("that", condition(),
        "a condition; statistics of a signal, such as `rms`, are of the whole time"),
    key("never", condition(), "a condition that may hold in no tick"),
    key("sequence", list(name_of("a state")), "states that are entered in this order"),
    key("end", choice(kScenarioEndRows), list(choice(kScenarioEndRows)),
        "how the run ends; where nothing is said: by `time` or `finished`"),
    key("after", quantity(kTime), "judged from this time in the run on"),
    key("between", pair(quantity(kTime)), "judged between these times in the run"),
    key("within", quantity(kTime), "the time that `sequence` may take, or by which `that` holds"),
    key("in", text_of("a part such as `95 % of seeds`"), "of how many runs it must hold")
        .otherwise("100 % of seeds"),
    key("doc", text_of("a text"), "why, in a line"),
};

}  // namespace

constinit const core::KeyTable kScenarioKeys = {
    .id = "scenario", .doc = "The root of a scenario file.", .keys = kScenarioRows};
constinit const core::KeyTable kScriptKeys = {
    .id = "script",
    .doc = "Something that happens to the robot from outside.",
    .keys = kScriptRows,
    .one_of = {"at on", "push edit set raise fault hold call"}};
constinit const core::KeyTable kMomentKeys = {
    .id = "moment", .doc = "A place in the run.", .keys = kMomentRows, .one_of = {"step state"}};
constinit const core::KeyTable kPushKeys = {
    .id = "push", .doc = "A constant horizontal force on a body.", .keys = kPushRows};
constinit const core::KeyTable kExpectationKeys = {.id = "expectation",
                                                   .doc = "Something that must hold.",
                                                   .keys = kExpectationRows,
                                                   .one_of = {"that never sequence end"}};
constinit const core::KeyTable kGoldenKeys = {
    .id = "golden",
    .doc = "A recorded trace and how near to it a run must stay.",
    .keys = kGoldenRows};
constinit const std::span<const core::WordSpec> kInjectedFaults = kInjectedFaultRows;
constinit const std::span<const core::WordSpec> kScenarioEnds = kScenarioEndRows;

constinit const core::FileTable kScenarioFile = {
    .kind = "scenario", .newest = 1, .root = &kScenarioKeys};

}  // namespace footfall::lab
