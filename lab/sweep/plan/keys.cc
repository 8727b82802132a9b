// Keys and words of a sweep file; see keys.h.
#include "lab/sweep/plan/keys.h"

namespace footfall::lab {
namespace {

using namespace core;  // constructors of the tables

constexpr WordSpec kFaultRows[] = {
    {"none", "no fault"},
    {"mocap.dropout", "no motion capture data"},
    {"imu.dropout", "no IMU data"},
    {"sensor.dropout", "no data of any sensor"},
    {"planner.dropout", "no answers of planners"},
    {"imu.freeze", "the IMU's data stay the same, and are said to be new"},
    {"mocap.freeze", "motion capture's frames stay the same, and are said to be new"},
    {"led.loss", "motion capture sees two markers at most"},
};

constexpr WordSpec kMethodRows[] = {
    {"random", "independent samples: a larger `count` keeps the previous ones"},
    {"latin_hypercube",
     "Latin hypercube: one sample in each of `count` intervals of equal probability"},
};

constexpr KeySpec kSweepRows[] = {
    key("sweep", integer(1, 1), "the version of sweep files; the first key").required(),
    key("base", text_of("the path of a sweep file"),
        "a file this one inherits, relative to this one: maps merge by key, everything else is "
        "replaced, "
        "`NAME: off` removes, `KEY+:` appends to a list"),
    key("name", name_of("a sweep"), "its name in reports").otherwise("the file's name"),
    key("doc", text_of("a text"), "its purpose, in one line"),
    key("behavior", text_of("a file beside this one, or a name in the library"), "the behavior"),
    key("scenario", text_of("a file beside this one"),
        "the scenario: a run passes if its expectations hold"),
    key("robot", text_of("a name or path"), "the robot; only with `behavior`")
        .otherwise("the behavior's"),
    key("worlds", list(text_of("a name or path")), text_of("a name or path"),
        "the worlds: one run each")
        .otherwise("the scenario's, or flat"),
    key("faults", list(choice(kFaultRows)), list(map_of(kSweepFaultKeys)),
        "injected faults: one run each; a single word lasts from 2 s to the end")
        .otherwise("[none]"),
    key("seeds", list(integer(0, 1'000'000'000)),
        text_of("a number, or a range such as `100..119`"), "one run each")
        .otherwise("the scenario's, or 1"),
    key("for", quantity(kTime), "duration of a run").otherwise("the scenario's, or 20 s"),
    key("vary", by_name(list(anything())), by_name(map_of(kSweepGridKeys)),
        "values by name, all combinations: parameters, `gains.TABLE.TASK.kp`, "
        "`torque_loop.TABLE.p`, `estimator.NAME`, `planners.NAME.KEY`, "
        "`script.N.KEY` (the scenario's N-th entry), `world.KEY`, `variation.KEY` (the "
        "scenario's)"),
    key("zip", by_name(list(anything())), "lists of equal length, combined element by element"),
    key("sample", map_of(kSweepSampleKeys), "random values"),
    key("figures", list(name_of("a figure")),
        "figures of merit in the report, as in `run --json`: `error.pitch.max`; less is better")
        .otherwise("a selection of those in all runs"),
    key("timeout", quantity(kTime), "wall time after which a run is killed")
        .otherwise("60 s, and 3 s for each second of the run"),
};

constexpr KeySpec kGridRows[] = {
    key("from", any_quantity(), "the first value").required(),
    key("to", any_quantity(), "the last value").required(),
    key("count", integer(2, 100'000), "number of values, at equal distances").required(),
    key("log", boolean(), "equal factors instead of equal distances").otherwise("false"),
};

constexpr KeySpec kSampleRows[] = {
    key("count", integer(1, 1'000'000), "number of samples").required(),
    key("seed", integer(0, 1'000'000'000), "seed of the random values").otherwise("1"),
    key("method", choice(kMethodRows), "sampling method").otherwise("random"),
    key("of", by_name(map_of(kSweepDistributionKeys)), "the distribution of each value, by name")
        .required(),
};

constexpr KeySpec kDistributionRows[] = {
    key("uniform", pair(any_quantity()), "uniform between these values"),
    key("log_uniform", pair(any_quantity()),
        "uniform in the logarithm between these values above 0"),
    key("normal", pair(any_quantity()), "mean and standard deviation"),
    key("within", pair(any_quantity()), "truncates `normal` to these values"),
};

constexpr KeySpec kSweepFaultRows[] = {
    key("fault", choice(kFaultRows), "the component that fails").required(),
    key("at", quantity(kTime), "start time in the run").otherwise("2 s"),
    key("for", quantity(kTime), "duration").otherwise("to the end of the run"),
};

}  // namespace

constinit const core::KeyTable kSweepKeys = {.id = "sweep",
                                             .doc = "The root of a sweep file.",
                                             .keys = kSweepRows,
                                             .one_of = {"behavior scenario"}};
constinit const core::KeyTable kSweepGridKeys = {
    .id = "grid", .doc = "Values at equal distances.", .keys = kGridRows};
constinit const core::KeyTable kSweepSampleKeys = {
    .id = "sample", .doc = "Random values, the same in every session.", .keys = kSampleRows};
constinit const core::KeyTable kSweepDistributionKeys = {.id = "distribution",
                                                         .doc = "Distribution of a value.",
                                                         .keys = kDistributionRows,
                                                         .one_of = {"uniform log_uniform normal"}};
constinit const core::KeyTable kSweepFaultKeys = {
    .id = "sweep_fault", .doc = "A fault injected in a run.", .keys = kSweepFaultRows};
constinit const std::span<const core::WordSpec> kSweepFaults = kFaultRows;
constinit const std::span<const core::WordSpec> kSweepMethods = kMethodRows;

constinit const core::FileTable kSweepFile = {.kind = "sweep", .newest = 1, .root = &kSweepKeys};

}  // namespace footfall::lab
