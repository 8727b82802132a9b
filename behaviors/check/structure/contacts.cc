// Contact transitions of feet in an impossible condition: released without having been in contact,
// or loaded while in contact.
#include <fmt/format.h>

#include <algorithm>

#include "behaviors/check/structure/structure.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

// Number of possible preceding controls with and without contact of a foot.
struct Before {
  int with = 0;
  int without = 0;
};

class ContactCheck {
 public:
  ContactCheck(LoadContext& context, const Reach& reach)
      : context_(context), behavior_(context.behavior), reach_(reach), entry_(behavior_) {}

  void report() {
    for (const TransitionSpec& spec : behavior_.contact_transitions) {
      if (reach_.with_safe[at(spec.owner)] == 0) continue;
      const core::YamlNode* node =
          context_.sources[at(spec.owner)]->keys.find("contact_transition");
      const core::YamlNode* feet =
          node == nullptr ? nullptr : node->find(spec.loads ? "loads" : "releases");
      if (feet == nullptr) continue;
      const std::vector<int> before = configurations_before(spec.owner);
      for (std::size_t k = 0; k < spec.contacts.size(); ++k) {
        const core::YamlNode& foot =
            feet->is_sequence() && k < feet->items.size() ? feet->items[k] : *feet;
        look(spec, foot, spec.contacts[k], before);
      }
    }
    for (const auto& finding : findings_.found()) {
      context_.warning(finding.mark, "contact-before", finding.text);
    }
  }

 private:
  // Whether `s` can be active together with the states of a control configuration.
  bool fits(const std::vector<int>& active, int s) const {
    return std::all_of(active.begin(), active.end(), [&](int a) {
      return a == s || behavior_.is_descendant(a, s) || behavior_.is_descendant(s, a) ||
             active_together(behavior_, a, s);
    });
  }

  // Indices of the controls that may precede the entry of the state.
  std::vector<int> configurations_before(int owner) {
    std::vector<char> before(context_.control_states.size(), 0);
    for (int t = 0; t < static_cast<int>(behavior_.transitions.size()); ++t) {
      const TransitionInfo& transition = behavior_.transitions[at(t)];
      if (transition.targets.count == 0 || never_true(context_, t)) continue;
      if (reach_.with_safe[at(transition.source)] == 0) continue;
      const std::vector<int>& entered = entry_.of(transition);
      if (std::find(entered.begin(), entered.end(), owner) == entered.end()) continue;
      for (std::size_t c = 0; c < before.size(); ++c) {
        if (before[c] == 0 && fits(context_.control_states[c], transition.source)) before[c] = 1;
      }
    }
    std::vector<int> out;
    for (std::size_t c = 0; c < before.size(); ++c) {
      if (before[c] != 0) out.push_back(static_cast<int>(c));
    }
    return out;
  }

  void look(const TransitionSpec& spec, const core::YamlNode& foot, int contact,
            const std::vector<int>& before) {
    Before found;
    for (const int c : before) {
      const auto& contacts = behavior_.controls[at(c)].contacts;
      const bool holds = std::find(contacts.begin(), contacts.end(), contact) != contacts.end();
      ++(holds ? found.with : found.without);
    }
    const std::string& name = behavior_.robot.contacts[at(contact)].name;
    if (!spec.loads) {
      findings_.look(
          foot.mark, found.with == 0,
          fmt::format("'{}' is released here, but no state before has it in contact", name));
    } else {
      findings_.look(
          foot.mark, found.with > 0 && found.without == 0,
          fmt::format("'{}' is loaded here, but every state before has it in contact", name));
    }
  }

  LoadContext& context_;
  const Behavior& behavior_;
  const Reach& reach_;
  EntrySet entry_;
  Findings findings_;
};

}  // namespace

void check_contacts(LoadContext& context, const Reach& reach) {
  ContactCheck(context, reach).report();
}

}  // namespace footfall::behaviors
