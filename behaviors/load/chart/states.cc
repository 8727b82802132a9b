// The state tree as flat arrays: kinds, initial states, history, names.
#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

StateInfo& info_of(LoadContext& context, int s) {
  return context.behavior.states[static_cast<std::size_t>(s)];
}

void read_kind(LoadContext& context, StateSource& source, StateInfo& info) {
  const bool parent = !source.children.empty();
  info.kind = parent ? StateKind::compound : StateKind::atomic;
  const core::YamlNode* type = source.keys.find("type");
  if (type == nullptr) return;
  const auto choice = core::read_choice(*type, kStateTypes, context.diagnostics, "a type of state");
  if (!choice) return;
  if (*choice == 0) {
    info.kind = StateKind::parallel;
    if (!parent) context.error(type->mark, "empty-parallel", "a parallel state needs `states`");
    if (!parent) info.kind = StateKind::atomic;
    return;
  }
  if (parent) {
    context.error(type->mark, "state-type",
                  fmt::format("a {} state has no states of its own", type->scalar));
    return;
  }
  if (info.parent < 0) {
    context.error(type->mark, "state-type", "the root is compound or parallel");
    return;
  }
  info.kind = *choice == 1 ? StateKind::final : StateKind::history_shallow;
  if (*choice == 2) info.history = context.behavior.history_count++;
}

void check_state_keys(LoadContext& context, const StateSource& source, const StateInfo& info) {
  core::check_keys(source.keys, info.parent < 0 ? kMachineKeys : kStateKeys, context.diagnostics);
  const auto refuse = [&](const char* key, bool wrong, const char* text) {
    const core::YamlNode* node = source.keys.find(key);
    if (node != nullptr && wrong) context.error(node->mark, "misplaced-key", text);
  };
  const bool history = info.history >= 0;
  refuse("initial", info.kind != StateKind::compound, "only a compound state has `initial`");
  refuse("depth", !history, "only a history state has `depth`");
  refuse("default", !history, "only a history state has `default`");
  refuse("done", info.kind != StateKind::parallel, "only a parallel state has `done`");
  refuse("transitions", info.kind == StateKind::final || history,
         "a final or history state has no transitions");
  refuse("after", info.kind == StateKind::final || history,
         "a final or history state has no transitions");
  for (const char* key : {"on_entry", "on_exit", "invoke", "stack", "tasks", "contacts", "internal",
                          "gains", "torque_loop", "contact_transition", "reload"}) {
    refuse(key, history, "a history state only remembers: it has no actions and no control");
  }
}

void add_state(LoadContext& context, StateSource& source, int parent) {
  auto& states = context.behavior.states;
  source.index = static_cast<int>(states.size());
  states.emplace_back();
  context.sources.push_back(&source);
  StateInfo info;
  info.name = source.name;
  info.mark = source.mark;
  info.parent = parent;
  info.path = source.name;
  if (parent >= 0) info.depth = info_of(context, parent).depth + 1;
  if (parent > 0) info.path = info_of(context, parent).path + "." + source.name;
  if (const auto* doc = source.keys.find("doc")) info.doc = doc->scalar;
  if (const auto* reload = source.keys.find("reload")) {
    info.reload = core::read_choice(*reload, kReloadWords, context.diagnostics).has_value();
  }
  read_kind(context, source, info);
  const bool region = parent >= 0 && info_of(context, parent).kind == StateKind::parallel;
  if (region && info.kind == StateKind::final) {
    context.error(source.mark, "state-type", "a region of a parallel state cannot be final");
  }
  check_state_keys(context, source, info);
  states[static_cast<std::size_t>(source.index)] = info;
  std::set<std::string_view> names;
  for (std::size_t k = 0; k < source.children.size(); ++k) {
    if (!names.insert(source.children[k].name).second) {
      context.error(source.children[k].mark, "duplicate",
                    fmt::format("state '{}' is there already", source.children[k].name));
    }
    add_state(context, source.children[k], source.index);
  }
  info_of(context, source.index).end = static_cast<int>(states.size());
}

int first_child(LoadContext& context, int s) {
  const int end = info_of(context, s).end;
  for (int c = s + 1; c < end; c = info_of(context, c).end) {
    if (info_of(context, c).history < 0) return c;
  }
  return -1;
}

void load_initial(LoadContext& context, int s) {
  StateInfo& info = info_of(context, s);
  const core::YamlNode* node = context.sources[static_cast<std::size_t>(s)]->keys.find("initial");
  if (node == nullptr) {
    const int child = first_child(context, s);
    if (child < 0) {
      context.error(info.mark, "no-initial", "a state cannot have history states only");
      return;
    }
    info.initial = {static_cast<int>(context.behavior.targets.size()), 1};
    context.behavior.targets.push_back(child);
    return;
  }
  info.initial = load_targets(context, s, *node);
  for (int k = info.initial.first; k < info.initial.end(); ++k) {
    const int target = context.behavior.targets[static_cast<std::size_t>(k)];
    if (context.behavior.is_descendant(target, s)) continue;
    context.error(node->mark, "bad-initial",
                  fmt::format("'{}' is not inside '{}'", info_of(context, target).path, info.path));
  }
}

void load_history(LoadContext& context, int s) {
  StateInfo& info = info_of(context, s);
  const core::YamlNode& keys = context.sources[static_cast<std::size_t>(s)]->keys;
  const StateInfo& parent = info_of(context, info.parent);
  if (const auto* depth = keys.find("depth")) {
    const auto deep = core::read_choice(*depth, kHistoryDepths, context.diagnostics);
    if (deep && *deep == 1) info.kind = StateKind::history_deep;
  }
  const core::YamlNode* node = keys.find("default");
  if (node != nullptr) {
    info.initial = load_targets(context, s, *node);
  } else if (parent.kind == StateKind::compound) {
    info.initial = parent.initial;
  } else {  // parallel state: enter all its regions
    info.initial.first = static_cast<int>(context.behavior.targets.size());
    for (int c = info.parent + 1; c < parent.end; c = info_of(context, c).end) {
      if (info_of(context, c).history < 0) context.behavior.targets.push_back(c);
    }
    info.initial.count = static_cast<int>(context.behavior.targets.size()) - info.initial.first;
  }
  for (int k = info.initial.first; k < info.initial.end(); ++k) {
    const int target = context.behavior.targets[static_cast<std::size_t>(k)];
    if (info_of(context, target).history >= 0) {
      context.error(node != nullptr ? node->mark : info.mark, "history-loop",
                    fmt::format("history state '{}' stands for a history state: give it a "
                                "`default` that is none",
                                info.path));
    } else if (!context.behavior.is_descendant(target, info.parent)) {
      context.error(
          node->mark, "bad-default",
          fmt::format("'{}' is not inside '{}'", info_of(context, target).path, parent.path));
    }
  }
}

void load_done(LoadContext& context, int s) {
  StateInfo& info = info_of(context, s);
  const core::YamlNode* node = context.sources[static_cast<std::size_t>(s)]->keys.find("done");
  if (node == nullptr || !core::expect_scalar(*node, "all, any or a region", context.diagnostics) ||
      node->scalar == "all") {
    return;
  }
  if (node->scalar == "any") {
    info.done = DoneRule::any;
    return;
  }
  std::vector<std::string> names = {"all", "any"};
  for (int c = s + 1; c < info.end; c = info_of(context, c).end) {
    names.push_back(info_of(context, c).name);
    if (info_of(context, c).name != node->scalar) continue;
    info.done = DoneRule::region;
    info.done_region = c;
    if (info_of(context, c).kind == StateKind::parallel) {
      context.warning(node->mark, "done-of-parallel",
                      fmt::format("'{}' is parallel itself: `done` waits for a final child of a "
                                  "region, and is never raised for it; listen to done.state.{}",
                                  node->scalar, node->scalar));
    }
    return;
  }
  context.error(node->mark, "unknown-state",
                fmt::format("expected all, any or a region, got '{}'{}", node->scalar,
                            core::did_you_mean(node->scalar, names)));
}

void load_root(LoadContext& context) {
  const core::YamlNode& keys = context.machine.keys;
  Behavior& behavior = context.behavior;
  if (const auto* steps = keys.find("micro_steps")) {
    const auto value = core::read_integer(*steps, 1, 1'000'000, context.diagnostics);
    behavior.micro_steps = static_cast<int>(value.value_or(64));
  } else if (!behavior.has_robot) {
    behavior.micro_steps = 10000;
  }
}

}  // namespace

// Targets of a transition, `initial` or `default`: states that can be active at the same time.
Range load_targets(LoadContext& context, int from, const core::YamlNode& node) {
  Range range{static_cast<int>(context.behavior.targets.size()), 0};
  std::vector<const core::YamlNode*> items;
  if (node.is_sequence()) {
    for (const core::YamlNode& item : node.items) items.push_back(&item);
    if (items.empty()) context.error(node.mark, "expected", "expected the name of a state, got []");
  } else {
    items.push_back(&node);
  }
  for (const core::YamlNode* item : items) {
    const int target = context.require_target(from, *item);
    if (target == 0) context.error(item->mark, "bad-target", "the root is always active");
    if (target <= 0) continue;
    for (int k = range.first; k < range.end(); ++k) {
      int common = context.behavior.targets[static_cast<std::size_t>(k)];
      const int other = common;
      while (common > 0 && common != target && !context.behavior.is_descendant(target, common)) {
        common = info_of(context, common).parent;
      }
      const bool nested = common == other || common == target;
      if (nested || info_of(context, common).kind != StateKind::parallel) {
        context.error(item->mark, "bad-target",
                      fmt::format("'{}' and '{}' cannot be active together as targets",
                                  info_of(context, other).path, info_of(context, target).path));
      }
    }
    context.behavior.targets.push_back(target);
    ++range.count;
  }
  return range;
}

void load_states(LoadContext& context) {
  add_state(context, context.machine, -1);
  load_root(context);
  auto& behavior = context.behavior;
  const int count = static_cast<int>(behavior.states.size());
  for (int s = 0; s < count; ++s) {
    if (info_of(context, s).kind == StateKind::compound) load_initial(context, s);
  }
  for (int s = 0; s < count; ++s) {
    if (info_of(context, s).history >= 0) load_history(context, s);
    if (info_of(context, s).kind == StateKind::parallel) load_done(context, s);
  }
}

}  // namespace footfall::behaviors
