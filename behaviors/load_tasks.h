// Compiling the tasks, references and internal forces of a draft. Load time only.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "behaviors/load_context.h"
#include "behaviors/load_draft.h"
#include "behaviors/load_task_types.h"

namespace footfall::behaviors {

// A task as compiled; nothing and errors if it cannot be.
std::optional<TaskSpec> compile_task(LoadContext& context, const DraftItem& item,
                                     const Draft& draft);
// The reference into `spec` and its axes (load_reference.cc).
void compile_reference(LoadContext& context, const DraftItem& item, const TaskTypeInfo& type,
                       const std::vector<std::string>& axes, TaskSpec& spec,
                       std::vector<AxisSpec>& out);
std::optional<InternalSpec> compile_internal(LoadContext& context, const DraftItem& item);

}  // namespace footfall::behaviors
