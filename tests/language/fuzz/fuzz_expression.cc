// Any bytes as an expression: what compiles is evaluated with ordinary values and with values that
// are not finite. What is constant must not depend on them.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string_view>

#include "behaviors/expression/expression.h"

namespace footfall::tests {
namespace {

struct World {
  core::SignalTable signals;
  std::vector<behaviors::ParameterInfo> parameters;
  std::vector<std::string> axes = {"x", "y", "z"};
  behaviors::ExpressionScope scope;

  World() {
    for (const char* name : {"com.pos.z", "base.pos.x"}) signals.add(name, core::kLength, "");
    for (const char* name : {"contact.left", "steps", "fz"}) signals.add(name, core::kNone, "");
    signals.add("com.vel.x", core::kVelocity, "");
    for (const char* name : {"lift", "goal"}) {
      behaviors::ParameterInfo info;
      info.name = name;
      info.slot = static_cast<int>(parameters.size());
      info.size = info.slot == 0 ? 1 : 2;
      info.dimension = info.slot == 0 ? core::kTime : core::kNone;
      info.bare = info.slot != 0;
      parameters.push_back(info);
    }
    scope.signals = &signals;
    scope.parameters = &parameters;
    scope.state = 1;
    scope.find_state = [](std::string_view name, std::string& why) {
      why = "unknown state";
      return name == "lift" ? 1 : -1;
    };
    scope.entry_axes = &axes;
    scope.entry_axis = 0;
    scope.entry_dimension = core::kLength;
  }
};

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

void compile_and_evaluate(std::string_view text) {
  static const World world;
  behaviors::ExpressionPool pool;
  behaviors::ExpressionError error;
  const int index = compile_expression(text, world.scope, std::nullopt, pool, error);
  if (index < 0) {
    if (error.text.empty() || error.offset < 0 ||
        static_cast<std::size_t>(error.offset) > text.size()) {
      std::abort();  // an error without words or outside of the text
    }
    return;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double first = 0.0;
  for (const double value : {0.5, 0.0, -3.0, kInfinity, std::nan("")}) {
    const double signals[6] = {value, value, 1.0, value, 2.0, value};
    const double parameters[3] = {value, 1.0, value};
    const double entry[3] = {value, value, 1.0};
    const std::int64_t ticks[2] = {0, 5};
    const std::uint8_t active[2] = {1, 0};
    behaviors::EvaluationContext context{signals, parameters, ticks, active, entry, 12, 1e-3};
    const double result = evaluate(pool, index, context);
    if (value == 0.5) first = result;
    if (pool[index].constant && !same(result, first)) std::abort();
  }
}

}  // namespace
}  // namespace footfall::tests

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  footfall::tests::compile_and_evaluate(text);
  return 0;
}
