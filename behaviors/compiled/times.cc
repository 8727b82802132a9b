// Times that parameters make impossible; see times.h.
#include "behaviors/compiled/times.h"

#include <fmt/format.h>

#include <cmath>

#include "behaviors/compiled/static_values.h"

namespace footfall::behaviors {
namespace {

// The dependence on parameters alone makes a value certain before the run.
bool is_certain(const Behavior& behavior, int expression) {
  return expression >= 0 && dependence_of(behavior, expression).fixed();
}

}  // namespace

std::vector<BadTime> bad_times(const Behavior& behavior) {
  std::vector<BadTime> bad;
  if (behavior.times.empty()) return bad;
  const StaticValues values(behavior);
  for (const TimeUse& use : behavior.times) {
    if (!is_certain(behavior, use.expression)) continue;
    if (is_certain(behavior, use.guard) && values.of(use.guard).value_or(0.0) == 0.0) continue;
    const std::optional<double> value = values.of(use.expression);
    const bool good = value && periods_of(*value, behavior.rate_mhz) >= (use.positive ? 1 : 0);
    if (!good) bad.push_back({&use, value});
  }
  return bad;
}

std::string bad_time_text(const BadTime& time) {
  const char* expected = time.use->positive ? "a time above 0 s" : "a time from 0 s to 10^6 s";
  if (!time.value) return fmt::format("has no value: expected {}", expected);
  const bool short_time = std::abs(*time.value) < 1.0;
  return fmt::format("is {:.6g} {}: expected {}", short_time ? 1e3 * *time.value : *time.value,
                     short_time ? "ms" : "s", expected);
}

}  // namespace footfall::behaviors
