// Feedback of internal forces that the loop cannot bear; see parts.h.
//
// The torque measured at a tick is what acted in the physics step before it. With a delay of d of
// the S steps of a period it is the command n = ceil((d + 1) / S) = 1 + floor(d / S) periods ago.
// With F = F_ref + K_F (F_ref - F_measured) ([Kim16] eqs. (4)-(5) with E7) a
// deviation is multiplied by -K_F every n periods: it dies out exactly if |K_F| < 1, whatever n is.
// An actuator with a bandwidth of its own would bear more; none is simulated.
#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "behaviors/check/physics/parts.h"
#include "core/index.h"

namespace footfall::behaviors {
namespace {

using core::Severity;

class FeedbackCheck {
 public:
  explicit FeedbackCheck(PhysicsContext& context) : context_(context), values_(context.behavior) {}

  void run() {
    for (const InternalSpec& spec : b().internals) judge(spec);
    context_.findings.settle(1);
  }

 private:
  const Behavior& b() const { return context_.behavior; }

  void judge(const InternalSpec& spec) {
    if (spec.feedback < 0) return;
    const Dependence needs = dependence_of(b(), spec.feedback);
    if (!needs.fixed()) return;
    if (report(spec, values_.of(spec.feedback), Severity::error, {})) return;
    for (const int parameter : needs.parameters) {
      const ParameterInfo& info = b().parameters[at(parameter)];
      if (!info.live || !info.has_range()) continue;
      for (const double end : {info.min, info.max}) {
        StaticValues edited(b());
        for (int i = 0; i < info.size; ++i) edited.parameters()[at(info.slot + i)] = end;
        if (report(spec, edited.of(spec.feedback), Severity::warning,
                   fmt::format(" at the end of the range of '{}'", info.name))) {
          break;
        }
      }
    }
  }

  bool report(const InternalSpec& spec, std::optional<double> feedback, Severity severity,
              const std::string& where) {
    if (!feedback || std::abs(*feedback) < 1.0) return false;
    const int steps = context_.world.steps_per_tick;
    const auto late_steps = std::lround(context_.world.command_delay * steps / b().period());
    const double periods = static_cast<double>(1 + late_steps / steps);
    const double late = 1e3 * periods * b().period();
    context_.findings.add(
        severity, spec.mark, "unstable-feedback", where,
        fmt::format("internal force '{}' is unstable with feedback {:g}{}: the measured torque is "
                    "that of a command {:.3g} ms before, so that a deviation is multiplied by {:g} "
                    "every {:.3g} ms; below 1 it dies out",
                    b().internal_instances[at(spec.instance)], *feedback, where, late, -*feedback,
                    late));
    return true;
  }

  PhysicsContext& context_;
  StaticValues values_;
};

}  // namespace

void check_force_feedback(PhysicsContext& context) { FeedbackCheck(context).run(); }

}  // namespace footfall::behaviors
