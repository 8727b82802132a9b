// `torque_loop:` tables: gains of the actuators' own torque loops, by joint. Parsed, checked and
// stored; a backend with ideal actuators does not use them.
#include "model/robot/torque_loop.h"

#include <fmt/format.h>

#include <limits>

#include "behaviors/language/language.h"
#include "behaviors/load/context.h"
#include "behaviors/load/control/steps.h"
#include "core/yaml/glob.h"

namespace footfall::behaviors {
namespace {

std::vector<double> read_joints(LoadContext& context, const core::YamlNode* node,
                                core::Dimension dimension) {
  const std::vector<std::string> joints = context.joint_names();
  std::vector<double> values(joints.size(), std::numeric_limits<double>::quiet_NaN());
  if (node == nullptr) return values;
  if (node->is_scalar()) {
    values.assign(joints.size(),
                  core::read_bounded(*node, dimension, 0.0, 1e9, context.diagnostics).value_or(0));
    return values;
  }
  const auto entries = core::match_names(*node, joints, "joint", context.diagnostics);
  for (std::size_t j = 0; j < entries.size(); ++j) {
    if (entries[j] == nullptr) continue;
    values[j] = core::read_bounded(entries[j]->value, dimension, 0.0, 1e9, context.diagnostics)
                    .value_or(0.0);
  }
  return values;
}

}  // namespace

void load_torque_loops(LoadContext& context) {
  const core::YamlNode* section = context.section("torque_loop");
  if (section == nullptr || !core::expect_map(*section, "tables by name", context.diagnostics)) {
    return;
  }
  if (!context.behavior.has_robot) {
    context.error(section->mark, "needs-robot",
                  "torque_loop needs a robot: this behavior names none");
    return;
  }
  for (const core::YamlEntry& entry : section->entries) {
    if (!core::check_name(entry, context.diagnostics, "the name of a torque loop")) continue;
    if (!core::expect_map(entry.value, "a map with p, i, d", context.diagnostics)) continue;
    core::check_keys(entry.value, model::kTorqueLoopKeys, context.diagnostics);
    if (entry.value.entries.empty()) {
      context.error(entry.value.mark, "missing-key", "expected at least one of p, i, d");
    }
    context.behavior.torque_loops.push_back(
        {entry.key, read_joints(context, entry.value.find("p"), core::kNone),
         read_joints(context, entry.value.find("i"), core::kRate),
         read_joints(context, entry.value.find("d"), core::kTime)});
  }
}

}  // namespace footfall::behaviors
