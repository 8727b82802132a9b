// Any bytes as a behavior file: loaded beside the robots of this tree, and once more without its
// robot; what loads is run for some ticks and events.
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>

#include "behaviors/loader.h"
#include "behaviors/machine/machine.h"
#include "behaviors/statechart/trace.h"

namespace footfall::tests {
namespace {

constexpr int kTicks = 8;
constexpr int kEvents = 4;
constexpr int kMostStates = 300;  // a run of more takes its time, and finds nothing new

void run_chart(const behaviors::Behavior& behavior) {
  std::vector<behaviors::TraceStep> steps;
  for (const std::string& event : behavior.events) {
    if (steps.size() < kEvents) steps.push_back({-1.0, event});
  }
  steps.push_back({3e-3, ""});
  std::ostringstream out;
  behaviors::trace(behavior, steps, out);
}

void run_machine(const behaviors::Behavior& behavior) {
  core::SignalTable signals = behavior.signals;
  behaviors::Machine machine(behavior, signals);
  machine.start();
  for (int tick = 0; tick < kTicks; ++tick) machine.tick(tick);
}

void load_and_run(const std::string& text) {
  behaviors::LoadOptions options;
  options.search = {FOOTFALL_SOURCE_DIR};
  core::Diagnostics diagnostics;
  const auto behavior = behaviors::load_behavior_text(text, "fuzz.yaml", options, diagnostics);
  static_cast<void>(diagnostics.to_string());
  if (behavior == nullptr || behavior->states.size() > kMostStates) return;
  if (behavior->has_robot) {
    run_machine(*behavior);
  } else {
    run_chart(*behavior);
  }
}

// The text without the line that names the robot; empty if there is none.
std::string without_robot(const std::string& text) {
  const std::size_t line = text.find("\nrobot:");
  if (line == std::string::npos) return {};
  const std::size_t end = text.find('\n', line + 1);
  return text.substr(0, line) + (end == std::string::npos ? "" : text.substr(end));
}

}  // namespace
}  // namespace footfall::tests

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(data, data + size);
  footfall::tests::load_and_run(text);
  const std::string chart = footfall::tests::without_robot(text);
  if (!chart.empty()) footfall::tests::load_and_run(chart);
  return 0;
}
