// What the loader's parts share while a behavior is being compiled. Load time only.
//
// Order: overrides (--set) into the YAML, robot, parameters, templates expanded into a tree of
// states, names of states, planners, signals, then everything that holds expressions: transitions,
// actions, invokes, control.
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

// Arguments of a template, in the order of its `args`.
using Arguments = std::vector<std::pair<std::string, core::YamlNode>>;

// A state after the expansion of templates; its keys hold no arguments any more.
struct StateSource {
  std::string name;
  core::Mark mark;
  core::YamlNode keys;  // a map, without `states`, `use`, `mirror` and `with`
  Arguments arguments;  // in force where it is written; a stack's `$names` are looked up here
  std::vector<StateSource> children;
  int index = -1;      // into Behavior::states
  std::string origin;  // template and arguments it was made from, for people; empty: none
};

// One named gain table entry, or the gains written in a task: slots are made at first use.
struct GainEntry {
  const core::YamlNode* node = nullptr;
  std::string name;                      // `gains.single.swing`
  std::array<int, 3> slots{-1, -1, -1};  // kp, ki, kd
  std::array<int, 3> sizes{0, 0, 0};
  std::array<bool, 3> computed{};  // is an expression: compiled where it is used, not live
  std::vector<std::string> axes;   // of the first task that used it
  bool made = false;
  bool overlaid = false;  // some task has it, if under an inner layer's
};

// What names mean inside an expression or value.
struct ValueScope {
  int state = -1;                                        // the state it is written in
  const std::vector<std::string>* entry_axes = nullptr;  // in a task's reference
  int entry_axis = -1;
  const std::vector<core::Dimension>* entry_dimensions = nullptr;
};

// An event that an action raises.
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
  core::YamlNode root;                                              // the file, overrides applied
  StateSource machine;                                              // expanded
  std::vector<const StateSource*> sources;                          // by state index
  std::map<std::string, GainEntry> gain_entries;                    // by name; node addresses stay
  std::array<std::optional<std::array<double, 2>>, 3> gain_ranges;  // kp, ki, kd
  std::deque<core::YamlNode> substituted;  // stacks with arguments put in; addresses stay
  std::map<std::pair<std::string, int>, const core::YamlNode*> stack_cache;  // (name, state)
  std::vector<std::string> used_templates, used_stacks, used_torque_loops;
  std::vector<std::pair<std::string, Arguments>> mirrored;  // templates, as written
  std::vector<RaisedEvent> raised_events;
  std::set<std::string> declared_events;
  std::vector<const core::YamlNode*> transition_nodes;  // by transition, nullptr: a state's own
  std::vector<std::vector<int>> control_states;  // by control, the states that it was merged from
  std::vector<std::string> script_functions;     // that `call:` may name
  std::vector<std::string> script_patterns;      // of footfall.on
  std::vector<std::pair<std::string, core::Mark>> marks;  // of `mark: NAME`
  std::unordered_map<std::string, int> event_ids;         // as Behavior::events
  int built_in_events = 0;  // events before this index are raised by the engine or from outside
  std::vector<std::pair<core::Mark, const char*>> incomplete_gains;  // and what to say of them
  std::map<std::pair<const void*, int>, int> reference_sources;      // ReferenceSpec::source
  std::vector<tasks::TaskType> task_type_of_name;                    // by Behavior::task_names
  int expanded_states = 0;
  mutable int state_guesses = 0;  // names of states that were looked for in vain
  bool states_missing = false;    // after an error in a template: a name unknown may be one of them

  void error(core::Mark mark, std::string_view id, std::string text);
  void warning(core::Mark mark, std::string_view id, std::string text);
  // For what is not there (nobody uses it, nothing raises it): not said once there are errors,
  // which may be the reason.
  void absence(core::Mark mark, std::string_view id, std::string text);
  // The keys of a state as its file has them, templates expanded.
  const core::YamlNode& keys_of(int state) const {
    return sources[static_cast<std::size_t>(state)]->keys;
  }
  // The value under a key of a map in the file's root, nullptr if there is none.
  const core::YamlNode* section(std::string_view key) const { return root.find(key); }

  // Expression text as an index into the pool, -1 and an error at the exact column otherwise.
  int compile(const core::YamlNode& node, std::string_view text, std::size_t offset,
              std::optional<core::Dimension> expected, const ValueScope& scope);
  // A scalar value: a quantity, `$parameter`, `= expression`, or a lone signal name; of any
  // dimension without `expected`.
  int compile_value(const core::YamlNode& node, std::optional<core::Dimension> expected,
                    const ValueScope& scope);
  // A `when:`, where the `=` is implied.
  int compile_condition(const core::YamlNode& node, const ValueScope& scope);
  // The value if the expression is constant.
  std::optional<double> constant_value(int expression) const;
  // A time that must not be negative where it is constant.
  int compile_time(const core::YamlNode& node, const ValueScope& scope);

  // A state by any suffix of its path, as rule 8 says; -1 and a reason otherwise.
  int find_target(int from, std::string_view name, std::string& why) const;
  // The same with an error at the node.
  int require_target(int from, const core::YamlNode& node);
  int add_event(std::string_view name);
  std::vector<std::string> parameter_names() const;
  std::vector<std::string> contact_names() const;
  std::vector<std::string> joint_names() const;
  // Index of a contact of the robot, -1 and an error otherwise.
  int require_contact(const core::YamlNode& node);
};

}  // namespace footfall::behaviors
