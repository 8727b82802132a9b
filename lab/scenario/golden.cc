// `golden` of a scenario: the trace and the tolerances of a run relative to it.
#include <fmt/format.h>

#include <filesystem>

#include "core/diagnostics/did_you_mean.h"
#include "lab/scenario/context.h"
#include "lab/scenario/keys.h"

namespace footfall::lab {
namespace {

using core::YamlNode;

void read_tolerance(ScenarioContext& context, const core::YamlEntry& entry, GoldenSpec& golden) {
  if (context.names == nullptr) return;
  const core::SignalTable& signals = context.scenario.behavior->signals;
  const int signal = signals.find(entry.key);
  if (signal < 0) {
    std::vector<std::string> names;
    for (const core::SignalInfo& info : signals.infos()) names.push_back(info.name);
    context.error(
        entry.key_mark, "unknown-signal",
        fmt::format("unknown signal '{}'{}", entry.key, core::did_you_mean(entry.key, names)));
    return;
  }
  const auto tolerance =
      core::read_quantity(entry.value, signals.info(signal).dimension, context.diagnostics);
  if (!tolerance) return;
  if (!(*tolerance > 0.0)) {
    context.error(entry.value.mark, "out-of-range",
                  "expected a tolerance above zero, got " + core::describe(entry.value));
  }
  golden.signals.push_back({signal, *tolerance});
}

}  // namespace

void load_golden(ScenarioContext& context, const YamlNode& node) {
  if (!core::expect_map(node, "a trace: {tolerance: {com.pos.z: 2 mm}}", context.diagnostics)) {
    return;
  }
  core::check_keys(node, kGoldenKeys, context.diagnostics);
  GoldenSpec golden;
  golden.mark = node.mark;
  const std::filesystem::path scenario(context.scenario.path);
  golden.path = (scenario.parent_path() / (scenario.stem().string() + ".golden.csv")).string();
  if (const YamlNode* file = node.find("file")) {
    if (core::read_text(*file, context.diagnostics, "the path of a CSV file")) {
      golden.path = beside(context, *file);
    }
  }
  if (const YamlNode* rate = node.find("rate")) {
    golden.rate = core::read_bounded(*rate, core::kRate, 0.1, 1e4, context.diagnostics, "a rate")
                      .value_or(golden.rate);
  }
  if (const YamlNode* map = core::require_key(node, "tolerance", context.diagnostics)) {
    if (core::expect_map(*map, "signals by name: {com.pos.z: 2 mm}", context.diagnostics)) {
      if (map->entries.empty()) context.error(map->mark, "empty-value", "nothing is compared");
      for (const core::YamlEntry& entry : map->entries) read_tolerance(context, entry, golden);
    }
  }
  context.scenario.golden = std::move(golden);
}

}  // namespace footfall::lab
