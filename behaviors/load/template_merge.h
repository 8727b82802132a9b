// A state that uses a template overrides its keys.
#pragma once

#include "behaviors/load/context.h"

namespace footfall::behaviors {

// Merges `over` over the template's keys: maps by key, everything else is replaced (with a warning
// where a list loses actions or the like), `off` removes, `KEY+:` appends.
void merge_over_template(LoadContext& context, core::YamlNode& base, const core::YamlNode& over);

}  // namespace footfall::behaviors
