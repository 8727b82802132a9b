// The control of one configuration, merged from YAML but not yet compiled: the stack of the
// innermost active state that names one, overlaid with the keys of the active states, outer before
// inner, key by key. Load time only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// One key of a task or internal force, and the state that defined it.
struct DraftKey {
  std::string key;
  const core::YamlNode* node = nullptr;
  int owner = 0;
  core::Mark mark{};  // position of the key
};

// A layer of gains: a named table, gains by task in a state, or (`of_task`) gains written in a
// task. Layers are ordered from the stack inwards; a task's own gains override its layer's table.
struct DraftGains {
  const core::YamlNode* node = nullptr;
  int owner = 0;
  int layer = 0;
  bool of_task = false;
  bool of_stack = false;
  std::string name;  // of the stack or state, for inline gains: gains.NAME.TASK
};

struct DraftItem {
  std::string name;
  core::Mark mark;
  int owner = 0;                  // state that changed it last
  std::vector<DraftKey> keys;     // keys of the map, in order
  std::vector<DraftGains> gains;  // gains written in it, outer first
  const DraftKey* find(std::string_view key) const;
};

struct Draft {
  core::Mark mark;                           // of the stack, else of the innermost state
  const core::YamlNode* contacts = nullptr;  // a list
  int contacts_owner = 0;
  std::vector<DraftItem> tasks;
  std::vector<DraftItem> internals;
  std::vector<DraftGains> gains;  // outer first
  int layers = 0;
  std::vector<DraftItem> torque_loops;  // name: foot or group; the only key is `table`
  const core::YamlNode* transition = nullptr;
  int transition_owner = -1;
  bool misspelt = false;  // the stack's key is: what is missing is a consequence
};

// Merges the control of these active states (document order). `toward` replaces the stack if not
// nullptr.
Draft build_draft(LoadContext& context, const std::vector<int>& active,
                  const core::YamlNode* toward, int toward_state);
// The stack named in a state, with that state's arguments substituted; nullptr and an error
// otherwise.
const core::YamlNode* find_stack(LoadContext& context, const core::YamlNode& name, int state);

}  // namespace footfall::behaviors
