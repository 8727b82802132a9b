// States, transitions, actions, invokes; see language.h.
#include "behaviors/language/language.h"

namespace footfall::behaviors {
namespace {

using namespace core;  // constructors of the tables

constexpr WordSpec kStateTypeRows[] = {
    {"parallel", "all its states are active together"},
    {"final", "completes its parent; at the root it ends the run"},
    {"history", "restores the last active states of its parent"},
};
constexpr WordSpec kHistoryDepthRows[] = {
    {"shallow", "the child that was last active"},
    {"deep", "all states last active below the parent"},
};
constexpr WordSpec kDoneWords[] = {
    {"all", "when every region is in a final state"},
    {"any", "when one region is in a final state"},
};

constexpr WordSpec kReloadRows[] = {
    {"ok", "while the state is active"},
};

constexpr KeySpec kStateRows[] = {
    key("doc", text_of("a text"), "its purpose, in one line"),
    key("use", name_of("a template"), "instantiates a template; other keys here override its keys"),
    key("mirror", name_of("a template"),
        "makes two states of a template, named after its first argument: the one written and its "
        "image under the robot's symmetry; when one is done, the other is entered"),
    key("with", by_name(anything()), "arguments of `use` or `mirror`, by name"),
    key("type", choice(kStateTypeRows), "what kind of state")
        .otherwise("compound with `states`, else atomic"),
    key("initial", one_or_list(name_of("a state")), "the child to be entered")
        .otherwise("its first state"),
    key("depth", choice(kHistoryDepthRows), "how much a history state restores")
        .otherwise("shallow"),
    key("default", one_or_list(name_of("a state")),
        "state entered by a history state before its parent was ever exited")
        .otherwise("the parent's initial"),
    key("done", choice(kDoneWords), name_of("a region"),
        "when a parallel state raises `done.state.NAME`")
        .otherwise("all"),
    key("stack", name_of("a stack"),
        "the control in this state; that of the innermost active state applies"),
    key("contacts", list(name_of("a contact")), "constrained contacts, replace the stack's"),
    key("tasks", by_name(map_of(kTaskKeys)),
        "merged over the stack's tasks, key by key; `NAME: off` removes one"),
    key("internal", by_name(map_of(kInternalKeys)),
        "merged over the stack's internal forces, key by key; `NAME: off` removes one"),
    key("gains", name_of("a gain table"), by_name(map_of(kGainsKeys)),
        "another table, or gains by task; override the stack's"),
    key("torque_loop", by_name(name_of("a torque_loop table")),
        "the actuators' gains, by the foot whose leg it is or by joint group"),
    key("contact_transition", map_of(kContactTransitionKeys),
        "a torque-continuous change of contacts"),
    key("invoke", list(map_of(kInvokeKeys)), "planners asked while it is active"),
    key("on_entry", list(map_of(kActionKeys)), "actions when it is entered"),
    key("on_exit", list(map_of(kActionKeys)), "actions when it is exited"),
    key("transitions", list(map_of(kTransitionKeys)),
        "transitions from it; the first enabled one has precedence"),
    key("after", computed(quantity(kTime)), "with `to`: a last transition, this long after entry"),
    key("to", one_or_list(name_of("a state")), "with `after`: target of that transition"),
    key("reload", choice(kReloadRows),
        "a changed file may be loaded (`run --reload`) when each active innermost state, or one "
        "of its ancestors, permits it")
        .otherwise("not here"),
    key("states", by_name(map_of(kStateKeys)), "the states inside, by name"),
};

constexpr KeySpec kTemplateRows[] = {
    key("args", list(name_of("an argument")),
        "arguments given in `with`, used as `$NAME`; for `mirror` the first one is the name of a "
        "contact, group or joint"),
};

constexpr KeySpec kMachineRows[] = {
    key("safe", name_of("a state"),
        "entered on a fault whose reaction is `safe_state`, and when a run ends"),
    key("micro_steps", integer(1, 1'000'000),
        "maximum number of transitions in a tick; the rest is postponed and raises "
        "`error.execution`")
        .otherwise("64; without a robot 10000"),
};

constexpr KeySpec kTransitionRows[] = {
    key("on", one_or_list(name_of("an event")),
        "an event, a list of them, a prefix (`fault.*`), or \"*\"; without it the transition is "
        "tested in every tick"),
    key("when", condition(), "condition; an expression, `=` is implied"),
    key("after", computed(quantity(kTime)),
        "enabled once the state has been active this long; alone it is a timer"),
    key("to", one_or_list(name_of("a state")),
        "target; without it only actions are run, no state is exited or entered; `on` alone "
        "absorbs "
        "an event"),
    key("internal", boolean(),
        "whether a transition to a child of the state does not exit the state itself")
        .otherwise("false"),
    key("do", list(map_of(kActionKeys)), "actions between exit and entry"),
    key("reason", text_of("a text"), "reason, for logs and reports"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

constexpr KeySpec kActionRows[] = {
    key("raise", name_of("an event"), "raises an event, processed before the tick's external ones"),
    key("set", by_name(computed(one_or_list(any_quantity()))),
        "sets parameters to the values of expressions, effective immediately"),
    key("log", text_of("a text"), "writes a line; `{EXPR}` is the value of an expression"),
    key("mark", name_of("a mark"),
        "an event in the log; `mark: step` is counted by the signal `steps`"),
    key("call", name_of("a function"),
        "runs a function of `scripts`, or one registered by the program"),
};

constexpr WordSpec kOnLateRows[] = {
    {"keep_last", "the last plan is kept"},
    {"closed_form", "the plan in closed form, computed in the tick itself"},
};

constexpr ValueSpec kAtTime = computed(quantity(kTime));
constexpr ValueSpec kAtPart = quantity(kNone, "a part of the state's `after`, such as 70 %");

constexpr KeySpec kInvokeRows[] = {
    key("planner", name_of("a planner"), "the planner to be asked").required(),
    key("at", kAtTime, kAtPart, "a time in the state, or a part of its `after` + `to`")
        .otherwise("0 s"),
    key("every", computed(quantity(kTime)), "period from then on; without it once"),
    key("with", map_of(kInvokeWithKeys), "inputs, evaluated at each request").required(),
    key("deadline", computed(quantity(kTime)), "time after which an answer is late")
        .otherwise("none"),
    key("on_late", choice(kOnLateRows), "replacement of a late answer").otherwise("keep_last"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

constexpr KeySpec kInvokeWithRows[] = {
    key("stance", name_of("a contact"), "the stance foot").required(),
    key("swing", name_of("a contact"), "the swing foot").required(),
    key("switch_in", computed(quantity(kTime)), "time until the support changes to the swing foot")
        .required(),
};

constexpr WordSpec kTransitionFormRows[] = {
    {"continuous", "both control laws are solved in every tick and their torques blended"},
    {"frozen", "as in the paper: one end is kept as it was at entry"},
};

constexpr KeySpec kContactTransitionRows[] = {
    key("releases", one_or_list(name_of("a contact")),
        "feet that lose contact: blends from the previous control to this state's"),
    key("loads", one_or_list(name_of("a contact")),
        "feet that gain contact: blends from this state's control to that of `toward`"),
    key("over", computed(quantity(kTime)), "duration").required(),
    key("toward", name_of("a stack"), "with `loads`: the next stack, with these feet in contact"),
    key("form", choice(kTransitionFormRows), "how the two ends are blended")
        .otherwise("continuous"),
    key("doc", text_of("a text"), "its purpose, in one line"),
};

}  // namespace

constinit const core::KeyTable kStateKeys = {
    .id = "state",
    .doc =
        "A state; all keys are optional. Control keys of an inner state override those of outer "
        "states, key by key.",
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
    .doc = "The root state, always active, with two further keys.",
    .keys = kMachineRows,
    .more = &kStateKeys,
    .part = true,
    .empty = true};
constinit const core::KeyTable kTransitionKeys = {
    .id = "transition",
    .doc = "A transition to another state, or actions only.",
    .keys = kTransitionRows,
    .one_of = {"on when after", "on to do"}};
constinit const core::KeyTable kActionKeys = {
    .id = "action",
    .doc = "An action such as `{mark: step}`; actions in a list run in order.",
    .keys = kActionRows,
    .one_of = {"raise set log mark call"}};
constinit const core::KeyTable kInvokeKeys = {
    .id = "invoke",
    .doc =
        "Asks a planner while the state is active; exiting the state cancels the request. The "
        "answer is kept in the signals `planner.NAME.*`.",
    .keys = kInvokeRows};
constinit const core::KeyTable kInvokeWithKeys = {
    .id = "invoke_with", .doc = "Inputs of a planner.", .keys = kInvokeWithRows};
constinit const core::KeyTable kContactTransitionKeys = {
    .id = "contact_transition",
    .doc =
        "A torque-continuous change of contacts (Kim et al. 2016, eqs (1)-(2)); either "
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
