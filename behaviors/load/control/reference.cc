// The reference of a task: one value an axis, or a trajectory (trajectory.cc).
#include <fmt/format.h>

#include "behaviors/load/control/tasks.h"

namespace footfall::behaviors {

void set_values(const core::YamlNode& node, const std::vector<int>& values,
                std::vector<AxisSpec>& out) {
  const bool listed = node.is_sequence() && node.items.size() == out.size();
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].value = values[k];
    out[k].value_mark = listed ? node.items[k].mark : node.mark;
  }
}

void compile_reference(LoadContext& context, const DraftItem& item, AxesScope axes, TaskSpec& spec,
                       std::vector<AxisSpec>& out) {
  if (!tasks::info(spec.type).has_reference) return;
  const DraftKey* key = item.find("reference");
  if (key == nullptr) {
    context.error(item.mark, "missing-key",
                  fmt::format("task '{}' needs a `reference`", item.name));
    return;
  }
  axes.owner = key->owner;
  axes.entry = true;
  spec.reference.owner = key->owner;
  const auto next = static_cast<int>(context.reference_sources.size());
  spec.reference.source =
      context.reference_sources.try_emplace({key->node, key->owner}, next).first->second;
  if (key->node->find("trajectory") != nullptr) {
    compile_trajectory(context, *key->node, axes, spec, out);
    return;
  }
  spec.reference.kind = ReferenceSpec::Kind::value;
  set_values(*key->node, compile_axes(context, *key->node, axes, false), out);
}

}  // namespace footfall::behaviors
