// State shared by the parts of the loader while a behavior is compiled. Load time only.
//
// Order: overrides (--set) into the YAML, robot, parameters, templates expanded into a tree of
// states, names of states, planners, signals, then everything that contains expressions:
// transitions, actions, invokes, control.
#pragma once

#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "behaviors/compiled/behavior.h"
#include "behaviors/load/options.h"
#include "core/diagnostics/diagnostics.h"
#include "core/yaml/value_reader.h"
#include "core/yaml/yaml.h"

namespace footfall::behaviors {

// Template arguments, in the order of `args`.
using Arguments = std::vector<std::pair<std::string, core::YamlNode>>;

// A state after template expansion; its keys contain no arguments any more.
struct StateSource {
  std::string name;
  core::Mark mark;
  core::YamlNode keys;  // a map, without `states`, `use`, `mirror` and `with`
  Arguments arguments;  // arguments in scope, used to resolve `$names` in stacks
  std::vector<StateSource> children;
  int index = -1;      // into Behavior::states
  std::string origin;  // its template and arguments, for messages; empty: none
};

// One gain table entry, or gains written in a task; slots are created on first use.
struct GainEntry {
  const core::YamlNode* node = nullptr;
  std::string name;                      // `gains.single.swing`
  std::array<int, 3> slots{-1, -1, -1};  // kp, ki, kd
  std::array<int, 3> sizes{0, 0, 0};
  std::array<bool, 3> computed{};  // is an expression: compiled where used, not live
  std::array<bool, 3> by_axis{};   // has values by axis: not for tasks with other axes
  std::vector<std::string> axes;   // axes of the first task that uses it
  bool made = false;
  bool overlaid = false;               // used by some task, possibly below an inner layer's
  bool in_table = false;               // else written in a task or state
  std::array<bool, 3> used{};          // by some task
  std::array<core::Mark, 3> shadow{};  // of the value that a task used instead
};

// `--set gains.TABLE.TASK.kp.AXIS=VALUE`, or of gains written in a task: waits until the task and
// its axes are known; `--set torque_loop.TABLE.p.JOINT=VALUE` until the robot is.
struct GainSetting {
  std::string name;  // as given
  std::string gain;  // `gains.TABLE.TASK.kp`, `torque_loop.TABLE.p`
  std::string axis;  // its name, or its number; empty: all
  core::YamlNode value;
};

// Name scope of an expression or value.
struct ValueScope {
  int state = -1;                                        // the state that contains it
  const std::vector<std::string>* entry_axes = nullptr;  // inside a task's reference
  int entry_axis = -1;
  const std::vector<core::Dimension>* entry_dimensions = nullptr;
};

// Further limits of a time.
struct TimeRule {
  bool positive = false;  // 0 s is not allowed
  int guard = -1;         // used only where this condition holds
};

// The contacts of an internal force, where the file names them.
struct InternalUse {
  core::Mark mark;
  std::string name;     // of the force
  bool active = false;  // in some state both ends hold
};

// An event raised by an action.
struct RaisedEvent {
  std::string name;
  core::Mark mark;
};

struct LoadContext {
  LoadContext(Behavior& out, const LoadOptions& given, core::Diagnostics& problems)
      : behavior(out), options(given), diagnostics(problems) {}

  Behavior& behavior;
  const LoadOptions& options;
  core::Diagnostics& diagnostics;
  core::YamlNode root;                                              // the file after overrides
  StateSource machine;                                              // expanded
  std::vector<const StateSource*> sources;                          // by state index
  std::map<std::string, GainEntry> gain_entries;                    // by name; stable addresses
  std::array<std::optional<std::array<double, 2>>, 3> gain_ranges;  // kp, ki, kd
  std::vector<GainSetting> gain_settings;                           // of --set, in order
  std::deque<core::YamlNode> substituted;  // stacks with arguments put in; stable addresses
  std::map<std::pair<std::string, int>, const core::YamlNode*> stack_cache;  // (name, state)
  std::vector<std::string> used_templates, used_stacks, used_torque_loops;
  std::vector<std::pair<std::string, Arguments>> mirrored;  // instantiated templates, as written
  std::vector<RaisedEvent> raised_events;
  std::set<std::string> declared_events;
  std::vector<const core::YamlNode*> transition_nodes;  // by transition, nullptr: a state's own
  std::vector<std::vector<int>> control_states;  // by control: the states that it is merged from
  std::vector<std::string> script_functions;     // functions available to `call:`
  std::map<int, core::Mark> set_marks;           // by action: the value of a `set`
  bool scripts_failed = false;                   // told; more functions may be missing for it
  std::vector<std::string> script_patterns;      // patterns of footfall.on
  std::vector<std::pair<std::string, core::Mark>> marks;  // of `mark: NAME`
  std::unordered_map<std::string, int> event_ids;         // index in Behavior::events
  int built_in_events = 0;  // events below this index are raised by the engine or from outside
  std::vector<std::pair<core::Mark, const char*>> incomplete_gains;  // and the warning
  std::vector<InternalUse> internal_uses;
  std::map<std::pair<const void*, int>, int> reference_sources;  // ReferenceSpec::source
  std::vector<tasks::TaskType> task_type_of_name;                // by Behavior::task_names
  int expanded_states = 0;
  mutable int state_guesses = 0;  // unknown state names for which a similar name was searched
  bool states_missing = false;    // after an error in a template: a name may belong to it

  void error(core::Mark mark, std::string_view id, std::string text);
  void warning(core::Mark mark, std::string_view id, std::string text);
  // Warns about a missing use (of a name, an event). Suppressed after errors, which may be the
  // cause.
  void absence(core::Mark mark, std::string_view id, std::string text);
  // The keys of a state from the file, after template expansion.
  const core::YamlNode& keys_of(int state) const {
    return sources[static_cast<std::size_t>(state)]->keys;
  }
  // The value under a top-level key of the file, nullptr if absent.
  const core::YamlNode* section(std::string_view key) const { return root.find(key); }

  // Compiles expression text; returns its index in the pool, or -1 after an error at the exact
  // column.
  int compile(const core::YamlNode& node, std::string_view text, std::size_t offset,
              std::optional<core::Dimension> expected, const ValueScope& scope);
  // Stores where an expression stands, for messages at run time; returns it.
  int remember_place(int expression, core::Mark mark);
  // Compiles a scalar value: a quantity, `$parameter`, `= expression`, or a single signal name; of
  // any dimension without `expected`.
  int compile_value(const core::YamlNode& node, std::optional<core::Dimension> expected,
                    const ValueScope& scope);
  // Compiles a `when:`, where the `=` is implied.
  int compile_condition(const core::YamlNode& node, const ValueScope& scope);
  // The value if the expression is constant.
  std::optional<double> constant_value(int expression) const;
  // Compiles a time; a constant out of limits is an error, others are noted in Behavior::times.
  int compile_time(const core::YamlNode& node, const ValueScope& scope, const TimeRule& rule = {});

  // A state by any suffix of its path, see docs/behaviors.md 8.8; -1 and a reason otherwise.
  int find_target(int from, std::string_view name, std::string& why) const;
  // Same, with an error at the node.
  int require_target(int from, const core::YamlNode& node);
  int add_event(std::string_view name);
  std::vector<std::string> parameter_names() const;
  std::vector<std::string> contact_names() const;
  std::vector<std::string> joint_names() const;
  // Index of a contact of the robot, -1 and an error otherwise.
  int require_contact(const core::YamlNode& node);
};

}  // namespace footfall::behaviors
