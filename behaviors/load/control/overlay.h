// The control of one configuration, merged from YAML but not yet compiled: the stack of the
// innermost active state that names one, and over it what the active states say, outer before
// inner, key by key. Load time only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// One key of a task or internal force, and the state that brought it.
struct DraftKey {
  std::string key;
  const core::YamlNode* node = nullptr;
  int owner = 0;
  core::Mark mark{};  // of the key itself
};

// A layer of gains: a table by name, gains by task that a state gives, or (`of_task`) those written
// in a task. Layers grow from the stack inwards; a task's own go over its layer's table.
struct DraftGains {
  const core::YamlNode* node = nullptr;
  int owner = 0;
  int layer = 0;
  bool of_task = false;
  bool of_stack = false;
  std::string name;  // of the stack or state, for gains written in place: gains.NAME.TASK
};

struct DraftItem {
  std::string name;
  core::Mark mark;
  int owner = 0;                  // state whose word is the last
  std::vector<DraftKey> keys;     // of the map, in order
  std::vector<DraftGains> gains;  // written in it, outer first
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
  std::vector<DraftItem> torque_loops;  // name: foot or group; one key `table`
  const core::YamlNode* transition = nullptr;
  int transition_owner = -1;
};

// Merges for these active states (document order). `toward` replaces the stack if not nullptr.
Draft build_draft(LoadContext& context, const std::vector<int>& active,
                  const core::YamlNode* toward, int toward_state);
// The stack named at a state with that state's arguments put in; nullptr and an error otherwise.
const core::YamlNode* find_stack(LoadContext& context, const core::YamlNode& name, int state);

}  // namespace footfall::behaviors
