// Gains of a task, from a table or written in it. Load time only.
#pragma once

#include <string>
#include <vector>

#include "behaviors/load_context.h"

namespace footfall::behaviors {

// Who uses a gain table's entry.
struct GainUse {
  std::vector<std::string> axes;  // names, in the task's order
  bool joints = false;
};

// Entry of a table for a task, nullptr if there is none.
GainEntry* find_gains(LoadContext& context, const std::string& table, const std::string& task);
// Whether a table of this name exists; an error otherwise.
bool require_gain_table(LoadContext& context, const core::YamlNode& name);
// Gains written in a task: `gains.OWNER.TASK`.
GainEntry* inline_gains(LoadContext& context, const std::string& owner, const std::string& task,
                        const core::YamlNode& node);
// Slots of the entry into the axes; made at the first use, when the number of axes is known.
void use_gains(LoadContext& context, GainEntry& entry, const GainUse& use,
               std::vector<AxisSpec>& axes);
// Warns about kp without kd, and ki without kp.
void warn_incomplete_gains(LoadContext& context);
// Checks what no task uses.
void make_unused_gains(LoadContext& context);

}  // namespace footfall::behaviors
