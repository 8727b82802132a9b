// Internal forces of the merged control, pair by pair; see tasks.h.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language/language.h"
#include "behaviors/load/control/tasks.h"

namespace footfall::behaviors {
namespace {

using Pair = std::array<int, 2>;

// The pairs in `between`; `all`: every pair of the active contacts.
std::vector<Pair> read_between(LoadContext& context, const core::YamlNode& node,
                               const std::vector<int>& contacts) {
  std::vector<Pair> pairs;
  if (node.is_scalar() && node.scalar == "all") {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t j = i + 1; j < contacts.size(); ++j) {
        pairs.push_back({contacts[i], contacts[j]});
      }
    }
    return pairs;
  }
  if (!node.is_sequence() || node.items.size() != 2) {
    core::report_expected(node, "two contacts or `all`", context.diagnostics);
    return pairs;
  }
  const Pair pair = {context.require_contact(node.items[0]),
                     context.require_contact(node.items[1])};
  if (pair[0] < 0 || pair[1] < 0) return pairs;
  if (pair[0] == pair[1]) {
    context.error(node.items[1].mark, "same-foot",
                  "an internal force acts between two feet, not one");
    return pairs;
  }
  return {pair};
}

bool same_pair(const InternalSpec& a, const Pair& b) {
  return (a.contact_a == b[0] && a.contact_b == b[1]) ||
         (a.contact_a == b[1] && a.contact_b == b[0]);
}

// Compiles an internal force except for its pair; nullopt after an error.
std::optional<InternalSpec> compile_force(LoadContext& context, const DraftItem& item) {
  core::YamlNode map;
  map.kind = core::YamlNode::Kind::map;
  for (const DraftKey& key : item.keys)
    map.entries.push_back({key.key, key.mark, false, *key.node});
  core::check_keys(map, kInternalKeys, context.diagnostics);
  const DraftKey* reference = item.find("reference");
  if (item.find("between") == nullptr || reference == nullptr) {
    context.error(item.mark, "missing-key",
                  fmt::format("internal force '{}' needs `between` and `reference`", item.name));
    return std::nullopt;
  }
  InternalSpec spec;
  ValueScope scope;
  scope.state = reference->owner;
  spec.mark = reference->node->mark;
  spec.reference = context.compile_value(*reference->node, core::kForce, scope);
  spec.feedback = compile_limit(context, item, "feedback", core::kNone);
  spec.bandwidth = compile_limit(context, item, "bandwidth", core::kRate);
  if (const DraftKey* convention = item.find("convention")) {
    const auto choice = core::read_choice(*convention->node, kConventions, context.diagnostics);
    if (choice && *choice == 1) spec.scale = 0.5;
  }
  const auto& names = context.behavior.internal_instances;
  while (names[static_cast<std::size_t>(spec.instance)] != item.name) ++spec.instance;
  return spec;
}

// Notes whether the pair takes effect here: a force needs both of its ends in contact.
void note_use(LoadContext& context, const DraftItem& item, const core::YamlNode& between,
              const std::vector<Pair>& pairs, const std::vector<int>& contacts) {
  const auto holds = [&](int contact) {
    return std::ranges::find(contacts, contact) != contacts.end();
  };
  const bool active = std::ranges::any_of(
      pairs, [&](const Pair& pair) { return holds(pair[0]) && holds(pair[1]); });
  auto& uses = context.internal_uses;
  const auto same = std::ranges::find_if(
      uses, [&](const InternalUse& use) { return use.mark.place() == between.mark.place(); });
  if (same == uses.end()) {
    uses.push_back({between.mark, item.name, active});
  } else {
    same->active |= active;
  }
}

bool is_all(const DraftItem& item) {
  const DraftKey* between = item.find("between");
  return between != nullptr && between->node->is_scalar() && between->node->scalar == "all";
}

}  // namespace

void report_idle_internals(LoadContext& context) {
  if (context.diagnostics.has_errors()) return;  // possibly their cause
  for (const InternalUse& use : context.internal_uses) {
    if (use.active) continue;
    context.error(use.mark, "idle-force",
                  fmt::format("internal force '{}' never acts: no state with it has both feet in "
                              "contact",
                              use.name));
  }
}

std::vector<InternalSpec> compile_internals(LoadContext& context, const Draft& draft,
                                            const std::vector<int>& contacts) {
  std::vector<InternalSpec> out;
  const auto named = [&](const Pair& pair) {
    return std::any_of(out.begin(), out.end(), [&](const auto& s) { return same_pair(s, pair); });
  };
  for (const bool all : {false, true}) {  // an entry for one pair overrides the entry for all pairs
    for (const DraftItem& item : draft.internals) {
      if (is_all(item) != all) continue;
      const std::optional<InternalSpec> force = compile_force(context, item);
      if (!force) continue;
      const core::YamlNode& between = *item.find("between")->node;
      const std::vector<Pair> pairs = read_between(context, between, contacts);
      note_use(context, item, between, pairs, contacts);
      for (const Pair& pair : pairs) {
        if (!named(pair)) {
          out.push_back(*force);
          out.back().contact_a = pair[0];
          out.back().contact_b = pair[1];
        } else if (!all) {
          context.error(between.mark, "duplicate",
                        "another internal force acts between these two contacts already");
        }
      }
    }
  }
  if (out.size() > static_cast<std::size_t>(core::kMaxInternal)) {
    context.error(
        draft.internals.front().mark, "too-many",
        fmt::format("{} internal forces at once; at most {}", out.size(), core::kMaxInternal));
    out.clear();
  }
  return out;
}

}  // namespace footfall::behaviors
