// Short ways to load a behavior from text, run its statechart, and quote its errors.
#pragma once

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

enum class Body { none, standing };  // whether a runner has a robot that measures

// A machine on a table of its own, one tick after the other. Without a body every task measures 0;
// with one the robot stands at its nominal posture and is carried about by the test.
class Runner {
 public:
  explicit Runner(std::unique_ptr<behaviors::Behavior> loaded, Body body = Body::none)
      : behavior(std::move(loaded)),
        signals(behavior->signals),
        model(body == Body::none ? nullptr
                                 : std::make_unique<model::ControlModel>(behavior->robot)),
        machine(*behavior, signals, model.get()) {
    if (model == nullptr) return;
    state.p_WB[2] = behavior->robot.standing_height;
    for (std::size_t j = 0; j < behavior->robot.joints.size(); ++j) {
      state.q[j] = behavior->robot.joints[j].posture;
    }
    model->update(state);
  }

  void start() { machine.start(); }
  void tick() { machine.tick(now++); }
  // Carries the whole robot along one axis until its centre of mass, or a point, is there (m).
  void carry_com(std::size_t axis, double to) { carry(axis, to - model->com().position[axis]); }
  void carry_point(int point, std::size_t axis, double to) {
    carry(axis, to - model->point_position(point)[axis]);
  }
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
  std::unique_ptr<model::ControlModel> model;
  behaviors::Machine machine;
  model::State state;
  std::int64_t now = 0;

 private:
  void carry(std::size_t axis, double by) {
    state.p_WB[axis] += by;
    model->update(state);
  }
};

}  // namespace footfall::tests
