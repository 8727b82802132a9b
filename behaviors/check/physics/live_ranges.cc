// Ranges of live parameters within which an edit would be refused; see parts.h.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "behaviors/check/physics/parts.h"
#include "core/units/units.h"

namespace footfall::behaviors {
namespace {

class RangeCheck {
 public:
  RangeCheck(const Behavior& behavior, const PhysicsWorld& world, core::Diagnostics& diagnostics)
      : behavior_(behavior), edited_(behavior, world), diagnostics_(diagnostics) {}

  void run() {
    for (const ParameterInfo& info : behavior_.parameters) {
      // Gains and kappa are judged at their ends by their own checks.
      const bool kappa = std::ranges::any_of(behavior_.planners, [&](const PlannerInfo& planner) {
        return planner.kappa_parameter >= 0 &&
               &behavior_.parameters[static_cast<std::size_t>(planner.kappa_parameter)] == &info;
      });
      if (info.live && info.has_range() && !info.gain && !kappa) judge(info);
    }
  }

 private:
  // The errors with a part of the way from the file's values to one end of the range.
  std::vector<core::Diagnostic> errors_at(const ParameterInfo& info, double end, double part) {
    std::vector<double> values = behavior_.values;
    for (int k = info.slot; k < info.slot + info.size; ++k) {
      double& value = values[static_cast<std::size_t>(k)];
      value = part == 1.0 ? end : value + part * (end - value);
    }
    return edited_.errors(values);
  }

  // The last good value towards an end; the end itself if that is good. With several values, of the
  // first one.
  double good_towards(const ParameterInfo& info, double end,
                      std::optional<core::Diagnostic>& problem) {
    constexpr int kHalvings = 12;
    const double start = behavior_.values[static_cast<std::size_t>(info.slot)];
    auto errors = errors_at(info, end, 1.0);
    if (errors.empty()) return end;
    problem = std::move(errors.front());
    double good = 0.0, bad = 1.0;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = 0.5 * (good + bad);
      (errors_at(info, end, middle).empty() ? good : bad) = middle;
    }
    return start + good * (end - start);
  }

  void judge(const ParameterInfo& info) {
    std::optional<core::Diagnostic> problem;
    const double least = good_towards(info, info.min, problem);
    const double most = good_towards(info, info.max, problem);
    if (!problem) return;
    diagnostics_.warning(
        info.mark, problem->id,
        fmt::format("only {} to {} of the range of '{}', {} to {}, can be edited while the others "
                    "are as they are: beyond it {}",
                    text(info, least), text(info, most), info.name, text(info, info.min),
                    text(info, info.max), problem->text));
  }

  static std::string text(const ParameterInfo& info, double value) {
    if (info.dimension == core::kTime && std::abs(value) < 1.0) {
      return fmt::format("{:.4g} ms", 1e3 * value);
    }
    const std::string unit = core::unit_text(info.dimension);
    return fmt::format("{:.4g}{}{}", value, unit.empty() ? "" : " ", unit);
  }

  const Behavior& behavior_;
  EditedValues edited_;
  core::Diagnostics& diagnostics_;
};

}  // namespace

void check_live_ranges(const Behavior& behavior, const PhysicsWorld& world,
                       core::Diagnostics& diagnostics) {
  RangeCheck(behavior, world, diagnostics).run();
}

}  // namespace footfall::behaviors
