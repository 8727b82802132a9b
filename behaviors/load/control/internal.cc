// Internal forces of the merged control, pair by pair; see tasks.h.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/language/language.h"
#include "behaviors/load/control/tasks.h"

namespace footfall::behaviors {
namespace {

// The contacts of one force: two, or four.
using Contacts = std::vector<int>;

bool read_distinct(LoadContext& context, const core::YamlNode& node, Contacts& out) {
  for (const core::YamlNode& item : node.items) {
    const int contact = context.require_contact(item);
    if (contact < 0) return false;
    if (std::ranges::find(out, contact) != out.end()) {
      context.error(item.mark, "same-foot",
                    node.items.size() == 2 ? "an internal force acts between two feet, not one"
                                           : "a warp acts on four different feet");
      return false;
    }
    out.push_back(contact);
  }
  return true;
}

// The forces in `between`; `all`: every pair of the active contacts.
std::vector<Contacts> read_between(LoadContext& context, const core::YamlNode& node,
                                   const std::vector<int>& contacts) {
  std::vector<Contacts> forces;
  if (node.is_scalar() && node.scalar == "all") {
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      for (std::size_t j = i + 1; j < contacts.size(); ++j) {
        forces.push_back({contacts[i], contacts[j]});
      }
    }
    return forces;
  }
  if (!node.is_sequence() || (node.items.size() != 2 && node.items.size() != 4)) {
    core::report_expected(node, "two contacts (a tension), four (a warp), or `all`",
                          context.diagnostics);
    return forces;
  }
  Contacts force;
  if (read_distinct(context, node, force)) forces.push_back(force);
  return forces;
}

bool same_contacts(const InternalSpec& a, const Contacts& b) {
  return a.contact_count == static_cast<int>(b.size()) &&
         std::is_permutation(b.begin(), b.end(), a.contacts.begin());
}

// `{trajectory: ...}` or `{statics: ...}`.
void compile_force_map(LoadContext& context, const DraftKey& key, ValueScope scope,
                       InternalSpec& spec) {
  const core::YamlNode& map = *key.node;
  core::check_keys(map, kForceReferenceKeys, context.diagnostics);
  const core::YamlNode* statics = map.find("statics");
  const core::YamlNode* trajectory = map.find("trajectory");
  if ((statics == nullptr) == (trajectory == nullptr) || (statics && map.entries.size() > 1)) {
    context.error(map.mark, "expected",
                  "expected `{statics: PART}` alone or `{trajectory: SHAPE, ...}`");
    return;
  }
  if (statics != nullptr) {
    spec.statics = context.compile_value(*statics, core::kNone, scope);
    return;
  }
  if (!core::read_choice(*trajectory, kForceTrajectories, context.diagnostics,
                         "a trajectory of a force")) {
    return;
  }
  const std::vector<std::string> names = {"force"};
  const std::vector<core::Dimension> dimensions = {core::kForce};
  TaskSpec task;
  std::vector<AxisSpec> axis(1);
  task.reference = spec.reference;
  compile_trajectory(context, map, {names, dimensions, dimensions, key.owner, false, true}, task,
                     axis);
  spec.reference = task.reference;
  spec.value = axis[0].value;
  spec.end_velocity = axis[0].end_velocity;
}

void compile_force_reference(LoadContext& context, const DraftKey& key, InternalSpec& spec) {
  ValueScope scope;
  scope.state = key.owner;
  spec.mark = key.node->mark;
  spec.reference.kind = ReferenceSpec::Kind::value;
  spec.reference.owner = key.owner;
  const auto next = static_cast<int>(context.reference_sources.size());
  spec.reference.source =
      context.reference_sources.try_emplace({key.node, key.owner}, next).first->second;
  if (key.node->is_map()) {
    compile_force_map(context, key, scope, spec);
  } else if (key.node->is_scalar() && key.node->scalar == kForceReferences[0].word) {
    core::YamlNode whole = *key.node;
    whole.scalar = "1";
    spec.statics = context.compile_value(whole, core::kNone, scope);
  } else {
    spec.value = context.compile_value(*key.node, core::kForce, scope);
  }
}

// What the integral does without a gain.
void warn_idle_integral_limit(LoadContext& context, const DraftItem& item,
                              const InternalSpec& spec) {
  const DraftKey* limit = item.find("integral_limit");
  if (limit == nullptr || spec.integral >= 0) return;
  context.warning(limit->node->mark, "no-effect",
                  "`integral_limit` without `integral` has no effect");
}

// An internal force except for its contacts.
struct Force {
  InternalSpec spec;
  bool sum = false;  // its convention
};

// nullopt after an error.
std::optional<Force> compile_force(LoadContext& context, const DraftItem& item) {
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
  Force force;
  InternalSpec& spec = force.spec;
  compile_force_reference(context, *reference, spec);
  spec.feedback = compile_limit(context, item, "feedback", core::kNone);
  spec.integral = compile_limit(context, item, "integral", core::kRate);
  spec.integral_limit = compile_limit(context, item, "integral_limit", core::kForce);
  spec.bandwidth = compile_limit(context, item, "bandwidth", core::kRate);
  spec.ramp = compile_limit(context, item, "ramp", core::kTime);
  warn_idle_integral_limit(context, item, spec);
  const auto& names = context.behavior.internal_instances;
  while (names[static_cast<std::size_t>(spec.instance)] != item.name) ++spec.instance;
  if (const DraftKey* convention = item.find("convention")) {
    const auto choice = core::read_choice(*convention->node, kConventions, context.diagnostics);
    force.sum = choice && *choice == 1;
  }
  return force;
}

// Notes whether a force takes effect here: it needs all of its feet in contact.
void note_use(LoadContext& context, const DraftItem& item, const core::YamlNode& between,
              const std::vector<Contacts>& forces, const std::vector<int>& contacts) {
  const auto holds = [&](int contact) {
    return std::ranges::find(contacts, contact) != contacts.end();
  };
  const bool active = std::ranges::any_of(
      forces, [&](const Contacts& force) { return std::ranges::all_of(force, holds); });
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
                  fmt::format("internal force '{}' never acts: no state with it has all of its "
                              "feet in contact",
                              use.name));
  }
}

std::vector<InternalSpec> compile_internals(LoadContext& context, const Draft& draft,
                                            const std::vector<int>& contacts) {
  std::vector<InternalSpec> out;
  const auto named = [&](const Contacts& force) {
    return std::ranges::any_of(out, [&](const auto& s) { return same_contacts(s, force); });
  };
  for (const bool all : {false, true}) {  // an entry for one pair overrides the entry for all pairs
    for (const DraftItem& item : draft.internals) {
      if (is_all(item) != all) continue;
      const std::optional<Force> compiled = compile_force(context, item);
      if (!compiled) continue;
      const core::YamlNode& between = *item.find("between")->node;
      const std::vector<Contacts> forces = read_between(context, between, contacts);
      note_use(context, item, between, forces, contacts);
      for (const Contacts& force : forces) {
        if (!named(force)) {
          InternalSpec& spec = out.emplace_back(compiled->spec);
          spec.contact_count = static_cast<int>(force.size());
          std::ranges::copy(force, spec.contacts.begin());
          spec.scale = compiled->sum ? 1.0 / spec.contact_count : 1.0;  // of a mean force
        } else if (!all) {
          context.error(between.mark, "duplicate",
                        "another internal force acts between these contacts already");
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
