// A chart of realistic size for cost and allocation: 200 states, 4 parallel regions, 400
// transitions on Hume, the first region controlling; and a driver that in time takes every one.
//
// A region has 6 groups, a group 7 or 8 phases that follow each other in a ring: by event, after a
// time, or on a touchdown, as gaits do.
#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "behaviors/loader.h"
#include "behaviors/machine/machine.h"

namespace footfall::tests {

inline constexpr int kBigStates = 200;
inline constexpr int kBigRegions = 4;
inline constexpr int kBigTransitions = 400;

inline std::string big_chart() {
  constexpr int kGroups = 6;
  std::string text = R"(behavior: 1
robot: hume
parameters:
  pace: {value: 30 ms}
  alarm0: {value: 0}
  alarm1: {value: 0}
  alarm2: {value: 0}
  alarm3: {value: 0}
stacks:
  dual:
    contacts: [right_foot, left_foot]
    tasks:
      height: {type: com_position, axes: [z], priority: 1, reference: 0.91 m, gains: {kp: 270, ki: 20, kd: 10}}
      attitude: {type: body_orientation, axes: [yaw, pitch, roll], priority: 1, reference: 0, gains: {kp: [100, 200, 210], ki: [0, 20, 35], kd: [0, 15, 10]}}
      rest: {type: joint_damping, priority: 2, gains: {kd: 2}}
machine:
  type: parallel
  stack: dual
  transitions:
    - {on: restart, to: r0.g0}
    - {on: panic, do: [{mark: panic}]}
  states:
)";
  for (int r = 0; r < kBigRegions; ++r) {
    const std::string R = std::to_string(r);
    text += "    r" + R + ":\n      transitions:\n        - {on: home" + R +
            ", to: g0, internal: true}\n        - {when: $alarm" + R +
            " > 0.5, to: g1, internal: true, do: [{set: {alarm" + R + ": 0}}]}\n      states:\n";
    for (int g = 0; g < kGroups; ++g) {
      const std::string next_group = "g" + std::to_string((g + 1) % kGroups);
      const int phases = g == 0 && r < 3 ? 8 : 7;
      text += "        g" + std::to_string(g) +
              ":\n          transitions:\n            - {on: skip" + R + ", to: " + next_group +
              "}\n            - {when: com.pos.z > 1.5 m and t > 2 ms, to: " + next_group +
              "}\n          states:\n";
      for (int p = 0; p < phases; ++p) {
        const std::string next =
            p + 1 < phases ? "p" + std::to_string(p + 1) : "r" + R + "." + next_group;
        const char* ends = p % 2 == 0 ? "after: $pace" : "when: contact.right_foot and t > 10 ms";
        const std::string control =
            r == 0 ? ", tasks: {height: {gains: {kp: " + std::to_string(200 + p) +
                         ", ki: 20, kd: 10}}}"
                   : "";
        text += "            p" + std::to_string(p) + ": {transitions: [{on: [next" + R +
                ", next], when: abs(base.rpy.pitch) < 0.5, to: " + next + "}, {" + ends +
                ", to: " + next + "}]" + control + "}\n";
      }
    }
  }
  return text;
}

// The chart on a machine, with what makes it move.
class BigChart {
 public:
  BigChart() : behavior(load()), signals(behavior->signals), machine(*behavior, signals) {
    for (int r = 0; r < kBigRegions; ++r) {
      const std::string R = std::to_string(r);
      next_region.push_back(event("next" + R));
      skip_.push_back(event("skip" + R));
      home_.push_back(event("home" + R));
      alarm_.push_back(
          behavior->parameters[static_cast<std::size_t>(behavior->find_parameter("alarm" + R))]
              .slot);
    }
    next_all = event("next");
    restart_ = event("restart");
    panic_ = event("panic");
    contact_ = signals.find("contact.right_foot");
    height_ = signals.find("com.pos.z");
    machine.start();
  }

  void tick() { machine.tick(++now); }
  // One tick of a lively run: events here and there, feet that touch, quiet stretches for timers.
  void drive() {
    const bool lively = now / 64 % 2 == 0;
    for (std::size_t r = 0; r < kBigRegions; ++r) {
      if (lively && one_in(12)) machine.raise(next_region[r]);
      if (one_in(300)) machine.raise(skip_[r]);
      if (one_in(2000)) machine.raise(home_[r]);
      if (one_in(2000)) machine.parameters()[static_cast<std::size_t>(alarm_[r])] = 1.0;
    }
    if (one_in(5000)) machine.raise(restart_);
    if (one_in(5000)) machine.raise(panic_);
    if (one_in(20)) signals[contact_] = 1.0 - signals[contact_];
    signals[height_] = one_in(100) ? 1.6 : 0.9;
    tick();
  }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  behaviors::Machine machine;
  std::int64_t now = 0;
  std::vector<int> next_region;
  int next_all = -1;

 private:
  static std::unique_ptr<behaviors::Behavior> load() {
    core::Diagnostics diagnostics;
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    auto behavior =
        behaviors::load_behavior_text(big_chart(), "big_chart.yaml", options, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    return behavior;
  }
  int event(const std::string& name) const { return behavior->find_event(name); }
  // Park and Miller's generator: the run is the same everywhere.
  bool one_in(int n) {
    random_ = random_ * 48271 % 2147483647;
    return random_ % n == 0;
  }

  std::vector<int> skip_, home_, alarm_;
  int restart_ = -1, panic_ = -1, contact_ = -1, height_ = -1;
  std::int64_t random_ = 20150901;
};

}  // namespace footfall::tests
