// Gains of a task, from a table or written in it. Load time only.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "behaviors/load/control/axes.h"

namespace footfall::behaviors {

inline constexpr std::array<const char*, 3> kGainNames = {"kp", "ki", "kd"};

// A gain entry that applies to a task, and the state that defines it.
struct GainSource {
  GainEntry* entry = nullptr;
  const core::YamlNode* node = nullptr;  // its YAML, with that state's arguments substituted
  int owner = 0;
};

// Entry of a table for a task, nullptr if absent.
GainEntry* find_gains(LoadContext& context, const std::string& table, const std::string& task);
// Whether a table of this name exists; an error otherwise.
bool require_gain_table(LoadContext& context, const core::YamlNode& name);
// Gains written in a task: `gains.OWNER.TASK`.
GainEntry* inline_gains(LoadContext& context, const std::string& owner, const std::string& task,
                        const core::YamlNode& node);
// Sets one of kGainNames of the axes: to slots, created on the entry's first use, when the number
// of axes is known; or to expressions.
void use_gain(LoadContext& context, const GainSource& source, std::size_t gain,
              const AxesScope& axes, std::vector<AxisSpec>& out);
// Warns about incomplete gains of tasks, unless there are errors.
void warn_incomplete_gains(LoadContext& context);
// Checks entries that no task uses.
void make_unused_gains(LoadContext& context);

}  // namespace footfall::behaviors
