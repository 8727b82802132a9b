// Where a start without a state comes from; see first_state.h.
#include "apps/run/first_state.h"

#include <fmt/format.h>

#include <algorithm>

namespace footfall::apps {
namespace {

std::string placed(const std::string& file, const core::Mark& mark, const char* why,
                   const char* expected) {
  return fmt::format("{}:{}:{}: error: {}: expected {}", file, mark.line, mark.column, why,
                     expected);
}

}  // namespace

std::string place_no_state(const engine::NoState& problem, const behaviors::Behavior& behavior,
                           const sim::WorldDescription& world) {
  const auto& keys = world.sensors.keys;
  // The markers that are not seen, or else whatever is wrong with motion capture.
  for (const char* const start : {"mocap.occlusion", "mocap.dropped", "mocap."}) {
    const auto key = std::ranges::find_if(
        keys, [&](const sim::SensorSettings::Key& k) { return k.name.starts_with(start); });
    if (!problem.markers() || key == keys.end()) continue;
    return placed(key->file, key->mark, problem.what(),
                  "less of it, another seed, or a longer 'limits: {mocap_age: TIME}' of the robot, "
                  "which is how long a start waits");
  }
  const core::Mark& mark = behavior.estimator.mark;
  const auto file = static_cast<std::size_t>(mark.file);
  if (mark.file < 0 || file >= behavior.files.size()) {
    return fmt::format("{}: error: {}", behavior.path, problem.what());
  }
  return placed(behavior.files[file], mark, problem.what(),
                "another 'estimator', or sensors that give it a state");
}

}  // namespace footfall::apps
