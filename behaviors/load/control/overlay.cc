// Merging of stacks and overlays; see overlay.h.
#include "behaviors/load/control/overlay.h"

#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language/language.h"
#include "behaviors/load/steps.h"
#include "core/diagnostics/did_you_mean.h"

namespace footfall::behaviors {
namespace {

// Whether two states are in different regions: neither contains the other.
bool parallel(const LoadContext& context, int a, int b) {
  return a != b && !context.behavior.is_descendant(a, b) && !context.behavior.is_descendant(b, a);
}

// Whether a state has an unknown key that is nearly `stack`.
bool misspells_stack(const core::YamlNode& keys) {
  return std::ranges::any_of(keys.entries, [](const core::YamlEntry& entry) {
    return core::find_key(kStateKeys, entry.key) == nullptr &&
           !core::nearest_name(entry.key, {"stack"}).empty();
  });
}

void report_clash(LoadContext& context, core::Mark mark, const std::string& what, int a, int b) {
  const auto& states = context.behavior.states;
  context.error(mark, "parallel-conflict",
                fmt::format("{} is given by '{}' and by '{}' at once", what,
                            states[static_cast<std::size_t>(a)].path,
                            states[static_cast<std::size_t>(b)].path));
}

bool same_names(const core::YamlNode& a, const core::YamlNode& b) {
  return std::is_permutation(a.items.begin(), a.items.end(), b.items.begin(), b.items.end(),
                             [](const auto& x, const auto& y) { return x.scalar == y.scalar; });
}

// Source of an overlay: a state, or a stack (`stack` is not empty) that the state names.
struct Layer {
  int owner = 0;
  std::string stack;
  int index = 0;
};

std::string layer_name(const LoadContext& context, const Layer& layer) {
  return layer.stack.empty() ? context.behavior.states[static_cast<std::size_t>(layer.owner)].path
                             : layer.stack;
}

// Overlays the keys of one task or internal force.
void lay_item(const LoadContext& context, DraftItem& item, const core::YamlNode& map,
              const Layer& layer) {
  item.owner = layer.owner;
  for (const core::YamlEntry& key : map.entries) {
    const auto same = [&](const DraftKey& other) { return other.key == key.key; };
    auto found = std::find_if(item.keys.begin(), item.keys.end(), same);
    if (found == item.keys.end())
      found = item.keys.insert(found, DraftKey{key.key, nullptr, 0, {}});
    found->node = &key.value;
    found->owner = layer.owner;
    found->mark = key.key_mark;
    if (key.key == "gains") {
      item.gains.push_back(
          {&key.value, layer.owner, layer.index, true, false, layer_name(context, layer)});
    }
  }
}

// Overlays the entries of a map by name.
void lay_over(LoadContext& context, std::vector<DraftItem>& items, const core::YamlNode& map,
              const Layer& layer, const char* what) {
  const int owner = layer.owner;
  const std::string& stack = layer.stack;
  if (!core::expect_map(map, fmt::format("{}s by name", what), context.diagnostics)) return;
  for (const core::YamlEntry& entry : map.entries) {
    auto item = std::find_if(items.begin(), items.end(),
                             [&](const DraftItem& other) { return other.name == entry.key; });
    if (item != items.end() && stack.empty() && parallel(context, item->owner, owner)) {
      report_clash(context, entry.key_mark, fmt::format("{} '{}'", what, entry.key), item->owner,
                   owner);
    }
    if (core::is_off(entry.value)) {
      if (item == items.end()) {
        std::vector<std::string> names;
        for (const DraftItem& other : items) names.push_back(other.name);
        const bool task = std::string_view(what) == "task";
        context.error(entry.key_mark, task ? "unknown-task" : "unknown-internal",
                      fmt::format("there is no {} '{}' to switch off{}", what, entry.key,
                                  core::did_you_mean_or_list(entry.key, names)));
      } else {
        items.erase(item);
      }
      continue;
    }
    if (!core::expect_map(entry.value, fmt::format("the keys of a {}", what),
                          context.diagnostics)) {
      continue;
    }
    if (item == items.end()) {
      core::check_name(entry, context.diagnostics, fmt::format("the name of a {}", what));
      items.push_back({entry.key, entry.key_mark, owner, {}, {}});
      item = items.end() - 1;
    }
    lay_item(context, *item, entry.value, layer);
  }
}

// Overlays tables by foot or group; `off` leaves the group's actuators unchanged. Items of a stack
// have no owner: states override them.
void lay_torque_loops(LoadContext& context, Draft& draft, const core::YamlNode& map, int owner) {
  for (const core::YamlEntry& entry : map.entries) {
    auto item = std::find_if(draft.torque_loops.begin(), draft.torque_loops.end(),
                             [&](const DraftItem& other) { return other.name == entry.key; });
    if (item != draft.torque_loops.end() && item->owner >= 0 &&
        parallel(context, item->owner, owner)) {
      report_clash(context, entry.key_mark, fmt::format("torque_loop '{}'", entry.key), item->owner,
                   owner);
    }
    if (item == draft.torque_loops.end()) {
      draft.torque_loops.push_back({entry.key, entry.key_mark, owner, {}, {}});
      item = draft.torque_loops.end() - 1;
    }
    item->owner = owner;
    item->keys = {{"table", &entry.value, owner, entry.key_mark}};
  }
}

// The map of gains by task in a table of gains, or in a state's own.
const core::YamlNode* gains_by_task(const LoadContext& context, const core::YamlNode& gains) {
  if (!gains.is_scalar()) return &gains;
  const core::YamlNode* section = context.section("gains");
  return section == nullptr ? nullptr : section->find(gains.scalar);
}

// Error if two regions both define gains of a task.
void lay_gains(LoadContext& context, Draft& draft, const core::YamlNode& gains,
               const Layer& layer) {
  const core::YamlNode* mine = gains_by_task(context, gains);
  for (const DraftGains& other : draft.gains) {
    if (other.of_stack || mine == nullptr || !parallel(context, other.owner, layer.owner)) continue;
    const core::YamlNode* theirs = gains_by_task(context, *other.node);
    for (const core::YamlEntry& entry : mine->entries) {
      if (theirs == nullptr || theirs->find(entry.key) == nullptr) continue;
      report_clash(context, gains.is_scalar() ? gains.mark : entry.key_mark,
                   fmt::format("gains of '{}'", entry.key), other.owner, layer.owner);
      break;
    }
  }
  draft.gains.push_back(
      {&gains, layer.owner, layer.index, false, !layer.stack.empty(), layer_name(context, layer)});
}

// Overlays the keys that stacks and states have in common.
void lay_keys(LoadContext& context, Draft& draft, const core::YamlNode& keys, int owner,
              const std::string& stack) {
  const Layer layer = {owner, stack, draft.layers++};
  if (const auto* contacts = keys.find("contacts")) {
    if (draft.contacts != nullptr && stack.empty() && !same_names(*draft.contacts, *contacts) &&
        parallel(context, draft.contacts_owner, owner)) {
      report_clash(context, contacts->mark, "`contacts`", draft.contacts_owner, owner);
    }
    draft.contacts = contacts;
    draft.contacts_owner = owner;
  }
  if (const auto* tasks = keys.find("tasks")) {
    lay_over(context, draft.tasks, *tasks, layer, "task");
  }
  if (const auto* internal = keys.find("internal")) {
    lay_over(context, draft.internals, *internal, layer, "internal force");
  }
  if (const auto* gains = keys.find("gains")) lay_gains(context, draft, *gains, layer);
  if (const auto* loops = keys.find("torque_loop")) {
    if (core::expect_map(*loops, "tables by foot or group", context.diagnostics)) {
      lay_torque_loops(context, draft, *loops, owner);
    }
  }
}

// The innermost active state that names a stack, -1 if none does.
int stack_state(LoadContext& context, const std::vector<int>& active) {
  int best = -1;
  for (const int s : active) {
    const core::YamlNode* stack = context.keys_of(s).find("stack");
    if (stack == nullptr) continue;
    if (best >= 0 && parallel(context, best, s)) {
      report_clash(context, stack->mark, "`stack`", best, s);
    }
    best = s;
  }
  return best;
}

}  // namespace

const DraftKey* DraftItem::find(std::string_view key) const {
  for (const DraftKey& candidate : keys) {
    if (candidate.key == key) return &candidate;
  }
  return nullptr;
}

const core::YamlNode* find_stack(LoadContext& context, const core::YamlNode& name, int state) {
  const auto cached = context.stack_cache.find({name.scalar, state});
  if (cached != context.stack_cache.end()) return cached->second;
  if (!core::expect_scalar(name, "the name of a stack", context.diagnostics)) return nullptr;
  const core::YamlNode* stacks = context.section("stacks");
  const core::YamlNode* stack = stacks == nullptr ? nullptr : stacks->find(name.scalar);
  if (stack == nullptr) {
    std::vector<std::string> names;
    if (stacks != nullptr) {
      for (const auto& entry : stacks->entries) names.push_back(entry.key);
    }
    context.error(name.mark, "unknown-stack",
                  fmt::format("unknown stack '{}'{}", name.scalar,
                              core::did_you_mean_or_list(name.scalar, names)));
    return context.stack_cache[{name.scalar, state}] = nullptr;
  }
  if (!core::expect_map(*stack, "a stack", context.diagnostics)) return nullptr;
  context.used_stacks.push_back(name.scalar);
  context.substituted.push_back(substitute(
      *stack, context.sources[static_cast<std::size_t>(state)]->arguments, context.behavior.robot));
  const core::YamlNode& own = context.substituted.back();
  core::check_keys(own, kStackKeys, context.diagnostics);
  check_resolved(context, own);
  return context.stack_cache[{name.scalar, state}] = &own;
}

Draft build_draft(LoadContext& context, const std::vector<int>& active,
                  const core::YamlNode* toward, int toward_state) {
  Draft draft;
  if (!active.empty()) {
    draft.mark = context.sources[static_cast<std::size_t>(active.back())]->mark;
  }
  const int owner = toward != nullptr ? toward_state : stack_state(context, active);
  if (owner >= 0) {
    const core::YamlNode& name =
        toward != nullptr ? *toward : *context.keys_of(owner).find("stack");
    if (const core::YamlNode* stack = find_stack(context, name, owner)) {
      lay_keys(context, draft, *stack, owner, name.scalar);
      draft.mark = stack->mark;
      for (DraftItem& item : draft.tasks) item.owner = 0;  // no state has defined it yet
      for (DraftItem& item : draft.internals) item.owner = 0;
      for (DraftItem& item : draft.torque_loops) item.owner = -1;
      draft.contacts_owner = 0;
    }
  }
  for (const int s : active) {
    const core::YamlNode& keys = context.keys_of(s);
    lay_keys(context, draft, keys, s, "");
    draft.misspelt = draft.misspelt || misspells_stack(keys);
    if (const auto* transition = keys.find("contact_transition"); transition && toward == nullptr) {
      if (draft.transition != nullptr && parallel(context, draft.transition_owner, s)) {
        report_clash(context, transition->mark, "`contact_transition`", draft.transition_owner, s);
      }
      draft.transition = transition;
      draft.transition_owner = s;
    }
  }
  return draft;
}

}  // namespace footfall::behaviors
