// Traces many charts in one process: a line of stdin is {"behavior": TEXT, "script": [EVENT or
// milliseconds, ...]}, a line of stdout the trace as [[event, [active, ...]], ...], or the text of
// the errors.
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "behaviors/loader.h"
#include "behaviors/statechart/trace.h"

namespace {

using nlohmann::json;

json traced(const json& request) {
  using namespace footfall;
  core::Diagnostics diagnostics;
  const auto behavior = behaviors::load_behavior_text(request["behavior"].get<std::string>(),
                                                      "chart", {}, diagnostics);
  if (behavior == nullptr) return diagnostics.to_string();
  std::vector<behaviors::TraceStep> steps;
  for (const json& step : request["script"]) {
    if (step.is_string()) {
      steps.push_back({-1.0, step.get<std::string>()});
    } else {
      steps.push_back({1e-3 * step.get<double>(), {}});
    }
  }
  std::stringstream text;
  behaviors::trace(*behavior, steps, text);
  json lines = json::array();
  for (std::string line; std::getline(text, line);) {
    const json row = json::parse(line);
    lines.push_back({row["event"], row["active"]});
  }
  return lines;
}

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  for (std::string line; std::getline(std::cin, line);) {
    std::cout << traced(json::parse(line)).dump() << '\n';
  }
  return 0;
}
