// A statechart of 1 kHz with its door for edits.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "behaviors/loader.h"
#include "engine/edits/door.h"

namespace footfall::tests {

struct DooredChart {
  DooredChart(const char* text, std::size_t capacity) {
    core::Diagnostics diagnostics;
    behavior = behaviors::load_behavior_text(text, "chart.yaml", {}, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    signals = behavior->signals;
    machine = std::make_unique<behaviors::Machine>(*behavior, signals);
    door = std::make_unique<engine::EditDoor>(*behavior, capacity);
    machine->start();
  }
  void tick() {
    door->apply(now, *machine);
    machine->tick(now++);
  }
  int parameter(const char* name) const { return behavior->find_parameter(name); }
  int slot(const char* name) const {
    return behavior->parameters[static_cast<std::size_t>(parameter(name))].slot;
  }
  double value(const char* name, int component = 0) const {
    return machine->parameters()[static_cast<std::size_t>(slot(name) + component)];
  }
  std::string state() const {
    return behavior->states[static_cast<std::size_t>(machine->active_atomic().front())].name;
  }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  std::unique_ptr<behaviors::Machine> machine;
  std::unique_ptr<engine::EditDoor> door;
  std::int64_t now = 0;
};

inline constexpr const char* kEdited = R"(
behavior: 1
parameters:
  speed: {value: 1 m/s, range: [0 m/s, 10 m/s], live: true}
  goal: {value: [0 m, 0 m], range: [-5 m, 5 m], live: true}
  fixed: {value: 2 s, range: [1 s, 3 s]}
  counted: {value: 0, range: [0, 5]}
events: {go: "from outside", stop: "from outside"}
machine:
  on_entry: [{set: {counted: 1}}]
  states:
    idle:
      transitions:
        - {on: parameter.changed.speed, to: changed}
        - {on: go, to: gone}
    changed: {transitions: [{on: go, to: both}]}
    gone: {transitions: [{on: stop, to: idle}]}
    both: {}
)";

class EditDoor : public testing::Test, public DooredChart {
 protected:
  EditDoor() : DooredChart(kEdited, 4) {}
  engine::EditBatch edit(const char* name, const std::vector<double>& values,
                         double over = 0.0) const {
    engine::EditBatch batch;
    std::vector<std::string> reasons;
    engine::add_values(*behavior, {parameter(name), -1}, values, batch.values, reasons);
    EXPECT_TRUE(reasons.empty());
    batch.over = over;
    return batch;
  }
};

}  // namespace footfall::tests
