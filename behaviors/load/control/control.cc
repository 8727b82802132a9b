// One ControlSpec for each combination of active states that differ in control. They are numbered
// such that the sum of the active states' weights is the index: the tick needs no search.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "behaviors/language/language.h"
#include "behaviors/load/control/gains.h"
#include "behaviors/load/control/steps.h"
#include "behaviors/load/control/tasks.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

constexpr int kMaxConfigurations = 20000;
constexpr std::array<const char*, 7> kControlKeys = {
    "stack", "tasks", "internal", "contacts", "gains", "torque_loop", "contact_transition"};

bool has_control_keys(const core::YamlNode& keys) {
  return std::any_of(kControlKeys.begin(), kControlKeys.end(),
                     [&](const char* key) { return keys.find(key) != nullptr; });
}

class ControlLoader {
 public:
  explicit ControlLoader(LoadContext& context) : context_(context), behavior_(context.behavior) {}

  void load() {
    const std::size_t count = behavior_.states.size();
    counts_.assign(count, 1);
    controls_.assign(count, false);
    for (std::size_t s = count; s-- > 0;) count_configurations(static_cast<int>(s));
    if (counts_[0] > kMaxConfigurations) {
      context_.error(context_.machine.mark, "too-many",
                     fmt::format("more than {} combinations of parallel states that control",
                                 kMaxConfigurations));
      return;
    }
    weigh(0, 1);
    behavior_.controls.resize(static_cast<std::size_t>(counts_[0]));
    std::vector<int> active;
    for (int id = 0; id < counts_[0]; ++id) {
      active.clear();
      collect(0, id, active);
      std::sort(active.begin(), active.end());
      context_.control_states.push_back(active);
      const Draft draft = build_draft(context_, active, nullptr, -1);
      ControlSpec control = compile(draft);
      if (draft.transition != nullptr) {
        control.transition = compile_transition(draft, active);
        check_moving(control);
      }
      behavior_.controls[static_cast<std::size_t>(id)] = std::move(control);
    }
    report_idle_internals(context_);
    warn_incomplete_gains(context_);
    make_unused_gains(context_);
  }

 private:
  const StateInfo& state(int s) const { return behavior_.states[static_cast<std::size_t>(s)]; }
  int& count_of(int s) { return counts_[static_cast<std::size_t>(s)]; }

  bool controls(int c) const { return controls_[static_cast<std::size_t>(c)]; }

  // Counts combinations below a state: 1 if no state below it defines control. All children of a
  // compound state that define no control, nor any state below them, share the first combination.
  void count_configurations(int s) {
    const bool parallel = state(s).kind == StateKind::parallel;
    bool below = false;
    bool silent = false;
    std::int64_t count = parallel ? 1 : 0;
    for (int c = s + 1; c < state(s).end; c = state(c).end) {
      if (state(c).history >= 0) continue;
      below = below || controls(c);
      silent = silent || !controls(c);
      count = parallel ? count * count_of(c) : count + (controls(c) ? count_of(c) : 0);
      count = std::min<std::int64_t>(count, kMaxConfigurations + 1);
    }
    if (!parallel && silent) ++count;
    if (below) count_of(s) = static_cast<int>(count);
    controls_[static_cast<std::size_t>(s)] =
        below || has_control_keys(context_.sources[static_cast<std::size_t>(s)]->keys);
  }

  bool collapsed(int s) const {
    for (int c = s + 1; c < state(s).end; c = state(c).end) {
      if (controls(c)) return false;
    }
    return true;
  }

  // Whether a child of a compound state defines no control.
  bool has_silent(int s) const {
    for (int c = s + 1; c < state(s).end; c = state(c).end) {
      if (state(c).history < 0 && !controls(c)) return true;
    }
    return false;
  }

  void weigh(int s, int unit) {
    if (collapsed(s)) return;
    const bool parallel = state(s).kind == StateKind::parallel;
    int offset = !parallel && has_silent(s) ? 1 : 0;
    for (int c = s + 1; c < state(s).end; c = state(c).end) {
      if (state(c).history >= 0) continue;
      if (parallel) {
        weigh(c, unit);
        unit *= count_of(c);
      } else if (controls(c)) {
        behavior_.states[static_cast<std::size_t>(c)].control_weight = offset * unit;
        weigh(c, unit);
        offset += count_of(c);
      }
    }
  }

  // Collects the states of combination `id` below s that define control.
  void collect(int s, int id, std::vector<int>& active) const {
    active.push_back(s);
    if (collapsed(s)) return;
    const bool parallel = state(s).kind == StateKind::parallel;
    if (!parallel && has_silent(s) && id-- == 0) return;
    for (int c = s + 1; c < state(s).end; c = state(c).end) {
      if (state(c).history >= 0) continue;
      const int count = counts_[static_cast<std::size_t>(c)];
      if (parallel) {
        collect(c, id % count, active);
        id /= count;
      } else if (!controls(c)) {
        continue;
      } else if (id < count) {
        collect(c, id, active);
        return;
      } else {
        id -= count;
      }
    }
  }

  ControlSpec compile(const Draft& draft) {
    ControlSpec control;
    compile_contacts(draft, control);
    compile_tasks(draft, control);
    const auto internals = compile_internals(context_, draft, control.contacts);
    control.internals = {static_cast<int>(behavior_.internals.size()),
                         static_cast<int>(internals.size())};
    behavior_.internals.insert(behavior_.internals.end(), internals.begin(), internals.end());
    compile_torque_loops(draft, control);
    return control;
  }

  void compile_contacts(const Draft& draft, ControlSpec& control) {
    if (draft.contacts == nullptr && !draft.tasks.empty() && !draft.misspelt) {
      context_.warning(
          draft.mark, "no-contacts",
          "tasks without `contacts`: name the feet that hold, or write `contacts: []`");
    }
    if (draft.contacts == nullptr ||
        !core::expect_sequence(*draft.contacts, "a list of contacts", context_.diagnostics)) {
      return;
    }
    for (const core::YamlNode& item : draft.contacts->items) {
      const int contact = context_.require_contact(item);
      if (contact < 0) continue;
      if (std::find(control.contacts.begin(), control.contacts.end(), contact) !=
          control.contacts.end()) {
        context_.error(item.mark, "duplicate", fmt::format("contact '{}' twice", item.scalar));
        continue;
      }
      control.contacts.push_back(contact);
    }
  }

  void compile_tasks(const Draft& draft, ControlSpec& control) {
    std::vector<TaskSpec> specs;
    int axes = 0;
    const auto has_priority = [](const DraftItem& item) {
      return item.find("priority") != nullptr;
    };
    const bool some = std::any_of(draft.tasks.begin(), draft.tasks.end(), has_priority);
    for (const DraftItem& item : draft.tasks) {
      if (some && !has_priority(item) && item.find("type") != nullptr) {
        context_.warning(item.mark, "no-priority",
                         fmt::format("task '{}' has no priority, others here have: write "
                                     "`priority: 1` if it belongs to the first level",
                                     item.name));
      }
      const std::optional<TaskSpec> spec = cached_task(item, draft);
      if (!spec) continue;
      specs.push_back(*spec);
      axes += spec->axes.count;
      if (spec->frame == tasks::Frame::stance && control.contacts.empty()) {
        const DraftKey* frame = item.find("frame");
        context_.error(frame->node->mark, "misplaced-name",
                       fmt::format("task '{}' is measured from the stance contacts: none is in "
                                   "force",
                                   item.name));
      }
    }
    if (static_cast<int>(specs.size()) > core::kMaxTasks || axes > core::kMaxAxes) {
      context_.error(draft.tasks.front().mark, "too-many",
                     fmt::format("{} tasks with {} axes at once; at most {} and {}", specs.size(),
                                 axes, core::kMaxTasks, core::kMaxAxes));
      return;
    }
    std::stable_sort(specs.begin(), specs.end(),
                     [](const TaskSpec& a, const TaskSpec& b) { return a.priority < b.priority; });
    control.tasks = {static_cast<int>(behavior_.tasks.size()), static_cast<int>(specs.size())};
    behavior_.tasks.insert(behavior_.tasks.end(), specs.begin(), specs.end());
  }

  // The same source in the same states is compiled only once.
  std::optional<TaskSpec> cached_task(const DraftItem& item, const Draft& draft) {
    std::vector<std::pair<const void*, int>> identity;
    for (const DraftKey& key : item.keys) identity.emplace_back(key.node, key.owner);
    for (const DraftGains& gains : item.gains) identity.emplace_back(gains.node, gains.owner);
    for (const DraftGains& gains : draft.gains) identity.emplace_back(gains.node, gains.owner);
    const auto found = task_cache_.find(identity);
    if (found != task_cache_.end()) return found->second;
    return task_cache_[identity] = compile_task(context_, item, draft);
  }

  void compile_torque_loops(const Draft& draft, ControlSpec& control) {
    const auto& robot = behavior_.robot;
    if (draft.torque_loops.empty()) return;
    control.torque_loops.assign(robot.joints.size(), -1);
    std::vector<const DraftItem*> by_joint(robot.joints.size(), nullptr);
    for (const DraftItem& item : draft.torque_loops) {
      const core::YamlNode& name = *item.keys.front().node;
      const int table = core::is_off(name) ? -1 : find_torque_loop(name);
      const int contact = robot.find_contact(item.name);
      const int group = robot.find_group(
          contact >= 0 ? robot.contacts[static_cast<std::size_t>(contact)].group : item.name);
      if (group < 0) {
        std::vector<std::string> names = context_.contact_names();
        for (const auto& other : robot.groups) names.push_back(other.name);
        context_.error(item.mark, "unknown-group",
                       fmt::format("'{}' is neither a foot with a leg nor a joint group{}",
                                   item.name, core::did_you_mean_or_list(item.name, names)));
        continue;
      }
      for (const int joint : robot.groups[static_cast<std::size_t>(group)].joints) {
        control.torque_loops[static_cast<std::size_t>(joint)] = table;
        const DraftItem* other = std::exchange(by_joint[static_cast<std::size_t>(joint)], &item);
        if (other == nullptr || other->name == item.name || nested(*other, item)) continue;
        context_.error(item.mark, "parallel-conflict",
                       fmt::format("'{}' and '{}' both give joint '{}' a torque_loop", other->name,
                                   item.name, robot.joints[static_cast<std::size_t>(joint)].name));
        break;
      }
    }
  }

  // Whether one of the states contains the other, or one is a stack and the other a state over it.
  bool nested(const DraftItem& a, const DraftItem& b) const {
    if (a.owner < 0 || b.owner < 0) return a.owner != b.owner;
    return behavior_.is_descendant(a.owner, b.owner) || behavior_.is_descendant(b.owner, a.owner);
  }

  int find_torque_loop(const core::YamlNode& name) {
    if (!core::expect_scalar(name, "the name of a torque_loop table", context_.diagnostics)) {
      return -1;
    }
    context_.used_torque_loops.push_back(name.scalar);
    std::vector<std::string> names;
    for (const TorqueLoopTable& table : behavior_.torque_loops) {
      if (table.name == name.scalar) return static_cast<int>(names.size());
      names.push_back(table.name);
    }
    context_.error(name.mark, "unknown-torque-loop",
                   fmt::format("unknown torque_loop table '{}'{}", name.scalar,
                               core::did_you_mean_or_list(name.scalar, names)));
    return -1;
  }

  int compile_transition(const Draft& draft, const std::vector<int>& active) {
    const core::YamlNode& node = *draft.transition;
    if (!core::expect_map(node, "a map with releases or loads", context_.diagnostics)) return -1;
    core::check_keys(node, kContactTransitionKeys, context_.diagnostics);
    const core::YamlNode* releases = node.find("releases");
    const core::YamlNode* loads = node.find("loads");
    if ((releases == nullptr) == (loads == nullptr)) {
      context_.error(node.mark, "missing-key", "expected either `releases` or `loads`");
      return -1;
    }
    TransitionSpec spec;
    spec.owner = draft.transition_owner;
    spec.loads = loads != nullptr;
    read_moving(spec.loads ? *loads : *releases, spec);
    if (const auto* over = core::require_key(node, "over", context_.diagnostics)) {
      ValueScope scope;
      scope.state = spec.owner;
      spec.over = context_.compile_time(*over, scope);
    }
    if (const auto* form = node.find("form")) {
      const auto choice = core::read_choice(*form, kTransitionForms, context_.diagnostics);
      if (choice && *choice == 1) spec.form = tasks::TransitionForm::frozen;
    }
    compile_toward(node, active, spec);
    behavior_.contact_transitions.push_back(std::move(spec));
    return static_cast<int>(behavior_.contact_transitions.size()) - 1;
  }

  void read_moving(const core::YamlNode& feet, TransitionSpec& spec) {
    std::vector<const core::YamlNode*> items;
    for (const core::YamlNode& item : feet.items) items.push_back(&item);
    if (!feet.is_sequence() || feet.items.empty()) items.push_back(&feet);
    for (const core::YamlNode* item : items) {
      const int contact = context_.require_contact(*item);
      if (contact < 0) continue;
      if (std::find(spec.contacts.begin(), spec.contacts.end(), contact) != spec.contacts.end()) {
        context_.error(item->mark, "duplicate", fmt::format("contact '{}' twice", item->scalar));
      }
      spec.contacts.push_back(contact);
    }
  }

  // Compiles the stack in `toward`, overlaid with the keys of the surrounding states.
  void compile_toward(const core::YamlNode& node, const std::vector<int>& active,
                      TransitionSpec& spec) {
    const core::YamlNode* toward = node.find("toward");
    if (!spec.loads) {
      if (toward != nullptr) {
        context_.error(toward->mark, "misplaced-key", "`toward` goes with `loads`");
      }
      return;
    }
    if (toward == nullptr) {
      context_.error(node.mark, "missing-key", "`loads` needs `toward`: the stack to come");
      return;
    }
    if (find_stack(context_, *toward, spec.owner) == nullptr) return;
    std::vector<int> around;
    for (const int s : active) {
      if (behavior_.is_descendant(spec.owner, s)) around.push_back(s);
    }
    ControlSpec control = compile(build_draft(context_, around, toward, spec.owner));
    for (const int contact : spec.contacts) {
      if (std::find(control.contacts.begin(), control.contacts.end(), contact) !=
          control.contacts.end()) {
        continue;
      }
      context_.error(toward->mark, "bad-toward",
                     fmt::format("stack '{}' does not have '{}' in contact", toward->scalar,
                                 behavior_.robot.contacts[static_cast<std::size_t>(contact)].name));
    }
    spec.toward = static_cast<int>(behavior_.controls.size());
    behavior_.controls.push_back(std::move(control));
  }

  // A foot that is being released or loaded must not be among the state's contacts.
  void check_moving(const ControlSpec& control) {
    if (control.transition < 0) return;
    const TransitionSpec& spec =
        behavior_.contact_transitions[static_cast<std::size_t>(control.transition)];
    for (const int contact : spec.contacts) {
      if (std::find(control.contacts.begin(), control.contacts.end(), contact) ==
          control.contacts.end()) {
        continue;
      }
      context_.error(state(spec.owner).mark, "bad-transition",
                     fmt::format("'{}' is {} here, but the state's contacts hold it",
                                 behavior_.robot.contacts[static_cast<std::size_t>(contact)].name,
                                 spec.loads ? "loaded" : "released"));
    }
  }

  LoadContext& context_;
  Behavior& behavior_;
  std::vector<int> counts_;     // number of combinations, by state
  std::vector<bool> controls_;  // by state: it or a descendant defines control
  std::map<std::vector<std::pair<const void*, int>>, std::optional<TaskSpec>> task_cache_;
};

}  // namespace

void load_control(LoadContext& context) {
  if (context.behavior.has_robot) {
    ControlLoader(context).load();
    return;
  }
  for (const StateSource* source : context.sources) {
    for (const char* key : kControlKeys) {
      if (const auto* node = source->keys.find(key)) {
        context.error(node->mark, "needs-robot",
                      fmt::format("`{}` needs a robot: this behavior names none", key));
      }
    }
  }
}

}  // namespace footfall::behaviors
