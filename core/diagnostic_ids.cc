// The list of diagnostics; see diagnostic_ids.h.
#include "core/diagnostic_ids.h"

#include <algorithm>
#include <array>

namespace footfall::core {

namespace {

constexpr Severity kError = Severity::error;
constexpr Severity kWarning = Severity::warning;

constexpr auto kIds = std::to_array<DiagnosticInfo>({
    {"ambiguous-state", kError, "several states fit the name: write more of its dotted path"},
    {"append", kError, "`KEY+:` needs a list here and a list of that name in the base"},
    {"argument-name", kError,
     "a template's argument has the name of a parameter, or is called `side`"},
    {"bad-character", kError, "a character that no expression knows"},
    {"bad-default", kError, "a history state's `default` lies outside its parent"},
    {"bad-expression", kError, "an expression that cannot be read"},
    {"bad-initial", kError, "`initial` names a state that is not inside"},
    {"bad-number", kError, "a number too large for the computer"},
    {"bad-target", kError, "targets that cannot be active together, or the root as a target"},
    {"bad-text", kError, "bytes that are not UTF-8, or a control character"},
    {"bad-toward", kError, "the stack in `toward` does not hold the foot that is being loaded"},
    {"bad-transition", kError, "a foot is released or loaded while the state's contacts hold it"},
    {"base", kError, "`base:` names no file, or one of another kind"},
    {"base-cycle", kError, "a file is its own base in the end"},
    {"built-in-event", kError, "an action raises an event that only the engine raises"},
    {"cannot-read", kError, "a file that cannot be opened"},
    {"dimension", kError, "a value of another dimension than its place needs"},
    {"duplicate", kError, "the same thing twice where once is meant"},
    {"duplicate-key", kError, "a key twice in one map"},
    {"empty", kError, "a file without content"},
    {"empty-parallel", kError, "a parallel state without `states`"},
    {"empty-value", kError, "a list or map without content where that leaves nothing to do"},
    {"event-name", kError, "a text that cannot be the name of an event"},
    {"expected", kError, "a value of another kind than its place needs"},
    {"glob-clash", kError, "two patterns match the same joint"},
    {"glob-unmatched", kError, "a pattern that matches nothing"},
    {"history-loop", kError, "a history state stands for a history state"},
    {"incomplete-gains", kWarning, "kp without kd, or ki without kp"},
    {"key-kind", kError, "a list or map where a key belongs"},
    {"kind", kError, "a file of another kind than asked for"},
    {"live-range", kError, "a parameter with `live: true` and no `range`"},
    {"live-variable", kError, "an action sets a live parameter"},
    {"log-text", kError, "a text to log whose braces do not fit, or with too many fields"},
    {"merge-key", kError, "YAML's `<<`"},
    {"mirror", kError, "a mirrored template without a first argument that has an image"},
    {"misplaced-key", kError, "a key that exists but has no meaning beside the others here"},
    {"misplaced-name", kError, "a name that exists but has no meaning here (`entry`, `t`)"},
    {"missing-argument", kError, "a template's argument that its instance does not give"},
    {"missing-blank", kError, "no blank behind a `:`"},
    {"missing-key", kError, "a key that must be there"},
    {"missing-key-name", kError, "a value without a key"},
    {"model", kError, "the robot's model file is not there or does not fit the robot file"},
    {"name", kError, "a text that cannot be a name"},
    {"near-step", kWarning, "a mark that looks like `step` in a behavior that marks no step"},
    {"needs-robot", kError, "control in a behavior without a robot"},
    {"never-done", kError, "`done.state.` of a state without states"},
    {"never-raised", kWarning, "an event that nothing raises and `events` does not list"},
    {"no-contacts", kWarning, "tasks without `contacts`"},
    {"no-effect", kWarning, "a key without effect for want of another"},
    {"no-gains", kError, "a task without gains"},
    {"no-initial", kError, "a state with history states only"},
    {"no-mirror-image", kWarning, "an argument that the robot's symmetry does not exchange"},
    {"no-priority", kWarning, "a task without priority among others that have one"},
    {"no-script", kError, "a file of `scripts` that cannot be read"},
    {"open-quote", kError, "a quote that is never closed"},
    {"out-of-range", kError, "a value outside its bounds"},
    {"parallel-conflict", kError, "two regions of a parallel state give the same task or contacts"},
    {"range", kError, "a range whose ends are in the wrong order or the same"},
    {"rate", kError, "a rate that is not a whole number of millihertz"},
    {"same-foot", kError, "one foot where two different ones are meant"},
    {"script", kError, "a Lua file with an error"},
    {"self-reference", kError, "a YAML alias inside what it stands for"},
    {"several-documents", kError, "something behind the end of the document"},
    {"size", kError, "another number of values than axes"},
    {"state-type", kError, "a type that the state cannot have"},
    {"stray-sign", kWarning, "a sign apart from what it belongs to"},
    {"tab", kError, "a tab in the indentation"},
    {"tag", kError, "a YAML tag"},
    {"task-type", kError, "one name for tasks of different types"},
    {"template-loop", kError, "states nested too deeply, as by a template that uses itself"},
    {"too-deep", kError, "nested too deeply"},
    {"too-large", kError, "more than the program reads, also by aliases"},
    {"too-many", kError, "more states, tasks, axes or planners than there may be"},
    {"unknown-argument", kError, "an argument that the template does not have"},
    {"unknown-axis", kError, "an axis that the task does not have"},
    {"unknown-contact", kError, "a contact that the robot does not have"},
    {"unknown-fault", kError, "a fault that does not exist"},
    {"unknown-function", kError,
     "a function that expressions do not have, or that no script defines"},
    {"unknown-gains", kError, "a gain table that does not exist"},
    {"unknown-group", kError, "a joint group or foot that the robot does not have"},
    {"unknown-internal", kError, "an internal force that is not in force"},
    {"unknown-key", kError, "a key that has no meaning here"},
    {"unknown-name", kError, "a joint, contact, group or point that the robot does not have"},
    {"unknown-parameter", kError, "a parameter that is not listed"},
    {"unknown-planner", kError, "a planner that is not listed"},
    {"unknown-point", kError, "a point that the robot does not have"},
    {"unknown-robot", kError, "a robot that is not found"},
    {"unknown-setting", kError, "`--set` of a value that does not exist"},
    {"unknown-signal", kError, "a signal that does not exist"},
    {"unknown-stack", kError, "a stack that is not listed"},
    {"unknown-state", kError, "a state that does not exist or is out of reach"},
    {"unknown-task", kError, "a task that is not in the stack in force and has no type"},
    {"unknown-task-type", kError, "a type of task that does not exist"},
    {"unknown-template", kError, "a template that is not listed"},
    {"unknown-torque-loop", kError, "a torque_loop table that is not listed"},
    {"unresolved", kError, "a `$name` that is neither a parameter nor an argument"},
    {"unsupported", kError, "something that the controller or the simulator cannot do yet"},
    {"unused", kWarning, "something written down that nothing uses"},
    {"version", kError, "a file of a newer version"},
    {"yaml", kError, "text that is not YAML"},
});
static_assert(std::ranges::is_sorted(kIds, {}, &DiagnosticInfo::id));

}  // namespace

std::span<const DiagnosticInfo> diagnostic_ids() { return kIds; }

const DiagnosticInfo* find_diagnostic_id(std::string_view id) {
  const auto found = std::ranges::lower_bound(kIds, id, {}, &DiagnosticInfo::id);
  return found == kIds.end() || found->id != id ? nullptr : &*found;
}

}  // namespace footfall::core
