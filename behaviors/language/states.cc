// States, transitions, actions, invokes; see language.h.
#include "behaviors/language/language.h"

namespace footfall::behaviors {
namespace {

using namespace core;  // constructors of the tables

constexpr WordSpec kStateTypeRows[] = {
    {"parallel", "all its states are active together"},
    {"final", "its parent is done when it is entered; at the root it ends the run"},
    {"history", "stands for what was last active in its parent"},
};
constexpr WordSpec kHistoryDepthRows[] = {
    {"shallow", "the child that was last active"},
    {"deep", "all that was last active below the parent"},
};
constexpr WordSpec kDoneWords[] = {
    {"all", "when every region is in a final state"},
    {"any", "when one region is in a final state"},
};

constexpr WordSpec kReloadRows[] = {
    {"ok", "while the state is active"},
};

constexpr KeySpec kStateRows[] = {
    key("doc", text_of("a text"), "what it is for, in a line"),
    key("use", name_of("a template"), "instantiates a template; other keys here override its keys"),
    key("mirror", name_of("a template"),
        "makes two states of a template, named after its first argument: the one written and its "
        "image under the robot's symmetry; when one is done the other is entered"),
    key("with", by_name(anything()), "arguments of `use` or `mirror`, by name"),
    key("type", choice(kStateTypeRows), "what kind of state")
        .otherwise("compound with `states`, else atomic"),
    key("initial", one_or_list(name_of("a state")), "what is entered with it")
        .otherwise("its first state"),
    key("depth", choice(kHistoryDepthRows), "how much a history state restores")
        .otherwise("shallow"),
    key("default", one_or_list(name_of("a state")),
        "what a history state stands for before its parent was ever left")
        .otherwise("the parent's initial"),
    key("done", choice(kDoneWords), name_of("a region"),
        "when a parallel state raises `done.state.NAME`")
        .otherwise("all"),
    key("stack", name_of("a stack"),
        "the control in force here; the innermost active state that names one decides"),
    key("contacts", list(name_of("a contact")), "what holds, over the stack's contacts"),
    key("tasks", by_name(map_of(kTaskKeys)),
        "laid over the stack's tasks, key by key; `NAME: off` removes one"),
    key("internal", by_name(map_of(kInternalKeys)),
        "laid over the stack's internal forces, key by key; `NAME: off` removes one"),
    key("gains", name_of("a gain table"), by_name(map_of(kGainsKeys)),
        "another table, or gains by task, over the stack's"),
    key("torque_loop", by_name(name_of("a torque_loop table")),
        "the actuators' gains, by the foot whose leg it is or by joint group"),
    key("contact_transition", map_of(kContactTransitionKeys),
        "a change of contacts without a jump in torque"),
    key("invoke", list(map_of(kInvokeKeys)), "planners asked while it is active"),
    key("on_entry", list(map_of(kActionKeys)), "actions when it is entered"),
    key("on_exit", list(map_of(kActionKeys)), "actions when it is left"),
    key("transitions", list(map_of(kTransitionKeys)), "what may end it; the first enabled wins"),
    key("after", computed(quantity(kTime)), "with `to`: a last transition, this long after entry"),
    key("to", one_or_list(name_of("a state")), "with `after`: where it goes"),
    key("reload", choice(kReloadRows),
        "a changed file may take over the run (`run --reload`) when each active innermost state, "
        "or "
        "one around it, says so")
        .otherwise("not here"),
    key("states", by_name(map_of(kStateKeys)), "the states inside, by name"),
};

constexpr KeySpec kTemplateRows[] = {
    key("args", list(name_of("an argument")),
        "what `with` must give, used as `$NAME`; a mirrored one's first is the name of a contact, "
        "group or joint"),
};

constexpr KeySpec kMachineRows[] = {
    key("safe", name_of("a state"),
        "entered on a fault whose reaction is `safe_state`, and when a run ends"),
    key("micro_steps", integer(1, 1'000'000),
        "most transitions in a tick; the rest waits for the next and raises `error.execution`")
        .otherwise("64; without a robot 10000"),
};

constexpr KeySpec kTransitionRows[] = {
    key("on", one_or_list(name_of("an event")),
        "an event, a list of them, a prefix (`fault.*`), or \"*\"; without it the transition is "
        "tried at every tick"),
    key("when", condition(), "must be true; an expression, `=` is implied"),
    key("after", computed(quantity(kTime)),
        "holds once the state has been active this long; alone it is a timer"),
    key("to", one_or_list(name_of("a state")),
        "where it goes; without it only the actions are done, nothing is left or entered"),
    key("internal", boolean(),
        "whether a transition to one's own child leaves the state itself alone")
        .otherwise("false"),
    key("do", list(map_of(kActionKeys)), "actions between exit and entry"),
    key("reason", text_of("a text"), "why, for logs and reports"),
    key("doc", text_of("a text"), "what it is for, in a line"),
};

constexpr KeySpec kActionRows[] = {
    key("raise", name_of("an event"), "raises an event, taken before the tick's outside ones"),
    key("set", by_name(computed(one_or_list(any_quantity()))),
        "sets parameters to the values of expressions, seen at once by what follows"),
    key("log", text_of("a text"), "writes a line; `{EXPR}` is the value of an expression"),
    key("mark", name_of("a mark"), "a row in the log; `mark: step` counts in the signal `steps`"),
    key("call", name_of("a function"),
        "runs a function of `scripts`, or one that the program registers"),
};

constexpr WordSpec kOnLateRows[] = {
    {"keep_last", "the last plan stays in force"},
    {"closed_form", "the plan in closed form, computed in the tick itself"},
};

constexpr ValueSpec kAtTime = computed(quantity(kTime));
constexpr ValueSpec kAtPart = quantity(kNone, "a part of the state's `after`, such as 70 %");

constexpr KeySpec kInvokeRows[] = {
    key("planner", name_of("a planner"), "which one is asked").required(),
    key("at", kAtTime, kAtPart, "when: a time in the state, or a part of its `after` + `to`")
        .otherwise("0 s"),
    key("every", computed(quantity(kTime)), "how often from then on; without it once"),
    key("with", map_of(kInvokeWithKeys), "what it is told, read at each asking").required(),
    key("deadline", computed(quantity(kTime)), "after which an answer is late").otherwise("none"),
    key("on_late", choice(kOnLateRows), "what stands in for a late answer").otherwise("keep_last"),
    key("doc", text_of("a text"), "what it is for, in a line"),
};

constexpr KeySpec kInvokeWithRows[] = {
    key("stance", name_of("a contact"), "the foot that stands").required(),
    key("swing", name_of("a contact"), "the foot that is placed").required(),
    key("switch_in", computed(quantity(kTime)), "time until the support changes to it").required(),
};

constexpr WordSpec kTransitionFormRows[] = {
    {"continuous", "both control laws are solved in every tick and their torques blended"},
    {"frozen", "the paper's way: one end is kept as it was at entry"},
};

constexpr KeySpec kContactTransitionRows[] = {
    key("releases", one_or_list(name_of("a contact")),
        "the feet that stop to hold: goes from the control just left to this state's"),
    key("loads", one_or_list(name_of("a contact")),
        "the feet that begin to hold: goes from this state's control to that of `toward`"),
    key("over", computed(quantity(kTime)), "how long it takes").required(),
    key("toward", name_of("a stack"),
        "with `loads`: the stack to come, with these feet in contact"),
    key("form", choice(kTransitionFormRows), "how the two ends are blended")
        .otherwise("continuous"),
    key("doc", text_of("a text"), "what it is for, in a line"),
};

}  // namespace

constinit const core::KeyTable kStateKeys = {
    .id = "state",
    .doc =
        "A state; all keys are optional. What an inner state says about control goes over what "
        "outer ones say, key by key.",
    .keys = kStateRows,
    .part = true,
    .empty = true};
constinit const core::KeyTable kTemplateKeys = {
    .id = "template",
    .doc = "A state with arguments. `$side` is 1 as written and -1 in a mirror image.",
    .keys = kTemplateRows,
    .more = &kStateKeys,
    .part = true,
    .empty = true};
constinit const core::KeyTable kMachineKeys = {
    .id = "machine",
    .doc = "The root state, always active, with two keys more.",
    .keys = kMachineRows,
    .more = &kStateKeys,
    .part = true,
    .empty = true};
constinit const core::KeyTable kTransitionKeys = {.id = "transition",
                                                  .doc = "What may end a state, or only act.",
                                                  .keys = kTransitionRows,
                                                  .one_of = {"on when after", "to do"}};
constinit const core::KeyTable kActionKeys = {
    .id = "action",
    .doc = "An action such as `{mark: step}`; of a list, one after the other.",
    .keys = kActionRows,
    .one_of = {"raise set log mark call"}};
constinit const core::KeyTable kInvokeKeys = {
    .id = "invoke",
    .doc =
        "Asks a planner while the state is active; leaving the state cancels it. The answer "
        "stays in the signals `planner.NAME.*`.",
    .keys = kInvokeRows};
constinit const core::KeyTable kInvokeWithKeys = {
    .id = "invoke_with", .doc = "What a planner is told.", .keys = kInvokeWithRows};
constinit const core::KeyTable kContactTransitionKeys = {
    .id = "contact_transition",
    .doc =
        "A change of contacts without a jump in torque (Kim et al. 2016, eqs (1)-(2)); either "
        "`releases` or `loads`.",
    .keys = kContactTransitionRows,
    .one_of = {"releases loads"},
    .part = true};
constinit const std::span<const core::WordSpec> kStateTypes = kStateTypeRows;
constinit const std::span<const core::WordSpec> kHistoryDepths = kHistoryDepthRows;
constinit const std::span<const core::WordSpec> kReloadWords = kReloadRows;
constinit const std::span<const core::WordSpec> kOnLate = kOnLateRows;
constinit const std::span<const core::WordSpec> kTransitionForms = kTransitionFormRows;

}  // namespace footfall::behaviors
