// Short ways to load a behavior from text, run its statechart, and quote its errors.
#pragma once

#include <map>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "behaviors/loader.h"
#include "behaviors/machine/machine.h"
#include "behaviors/statechart/trace.h"

namespace footfall::tests {

inline behaviors::LoadOptions options_for_tests() {
  behaviors::LoadOptions options;
  options.search = {FOOTFALL_SOURCE_DIR};
  return options;
}

inline std::string balance_path() {
  return std::string(FOOTFALL_SOURCE_DIR) + "/tests/unit/behaviors/load/kim2016_printed.yaml";
}

// Everything that loading reports, one line each.
inline std::string problems(const std::string& text,
                            const behaviors::LoadOptions& options = options_for_tests()) {
  core::Diagnostics diagnostics;
  behaviors::load_behavior_text(text, "b.yaml", options, diagnostics);
  return diagnostics.to_string();
}

inline std::unique_ptr<behaviors::Behavior> load(
    const std::string& text, const behaviors::LoadOptions& options = options_for_tests()) {
  core::Diagnostics diagnostics;
  auto behavior = behaviors::load_behavior_text(text, "b.yaml", options, diagnostics);
  if (behavior == nullptr) throw std::runtime_error(diagnostics.to_string());
  return behavior;
}

// A pure statechart: `behavior: 1` and the machine's own lines.
inline std::string chart(const std::string& machine) { return "behavior: 1\nmachine:\n" + machine; }

// Its trace: one line of active atomic states for the start and for each event.
inline std::vector<std::string> trace_of(const behaviors::Behavior& behavior,
                                         const std::vector<behaviors::TraceStep>& steps) {
  std::ostringstream out;
  behaviors::trace(behavior, steps, out);
  std::vector<std::string> lines;
  std::istringstream in(out.str());
  for (std::string line; std::getline(in, line);) {
    line = line.substr(line.find("\"active\":[") + 10);
    std::string names;
    for (const char c : line.substr(0, line.find(']'))) {
      if (c != '"') names += c == ',' ? ' ' : c;
    }
    lines.push_back(names);
  }
  return lines;
}

inline std::vector<std::string> trace_of(const std::string& text, const std::string& events) {
  return trace_of(*load(text), behaviors::trace_events(events));
}

using Lines = std::vector<std::string>;

// A robot that measures what the test says: 0 elsewhere.
class FixedMeasure final : public behaviors::Measure {
 public:
  double position(tasks::TaskType type, int point, int axis) const noexcept override {
    const auto found = values.find({static_cast<int>(type), point, axis});
    return found == values.end() ? 0.0 : found->second;
  }
  void set(tasks::TaskType type, int point, int axis, double value) {
    values[{static_cast<int>(type), point, axis}] = value;
  }
  std::map<std::array<int, 3>, double> values;
};

// A machine on a table of its own, one tick after the other.
class Runner {
 public:
  explicit Runner(std::unique_ptr<behaviors::Behavior> loaded)
      : behavior(std::move(loaded)), signals(behavior->signals), machine(*behavior, signals) {}

  void start() { machine.start(measure); }
  void tick() { machine.tick(now++, measure); }
  void run_to(std::int64_t end) {
    while (now <= end) tick();
  }
  std::string active() const {
    std::string names;
    for (const int s : machine.active_atomic()) {
      names += (names.empty() ? "" : " ") + behavior->states[static_cast<std::size_t>(s)].path;
    }
    return names;
  }
  double& signal(const std::string& name) { return signals[signals.find(name)]; }
  double& parameter(const std::string& name) {
    const int index = behavior->find_parameter(name);
    const int slot = behavior->parameters[static_cast<std::size_t>(index)].slot;
    return machine.parameters()[static_cast<std::size_t>(slot)];
  }
  // The task of this name in a control set, nullptr if it is not in force.
  const tasks::TaskCommand* task(const std::string& name, const tasks::ControlSet& set) const {
    for (int k = 0; k < set.task_count; ++k) {
      const tasks::TaskCommand& command = set.tasks[static_cast<std::size_t>(k)];
      const auto instance = static_cast<std::size_t>(command.instance);
      if (behavior->task_instances[instance].name == name) return &command;
    }
    return nullptr;
  }
  const tasks::TaskCommand* task(const std::string& name) const {
    return task(name, machine.control().primary);
  }
  // One axis of a task, by its place in the task.
  const tasks::AxisCommand& axis(const std::string& name, int k) const {
    const tasks::TaskCommand* command = task(name);
    if (command == nullptr) throw std::runtime_error("no task " + name);
    return machine.control().primary.axes[static_cast<std::size_t>(command->first_axis + k)];
  }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  behaviors::Machine machine;
  FixedMeasure measure;
  std::int64_t now = 0;
};

}  // namespace footfall::tests
