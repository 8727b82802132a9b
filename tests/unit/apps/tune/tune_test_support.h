// A small engine's messages, by hand.
#pragma once

#include <string>

#include "apps/tune/model/model.h"

namespace footfall::apps {

inline footfall_lcm::parameter_t told_parameter(const std::string& name, int first, int size,
                                                const std::string& unit, double min, double max,
                                                bool gain) {
  footfall_lcm::parameter_t told{};
  told.name = name;
  told.first = first;
  told.size = size;
  told.unit = unit;
  told.has_range = min < max ? 1 : 0;
  told.min = min;
  told.max = max;
  told.gain = gain ? 1 : 0;
  told.doc = "doc of " + name;
  return told;
}

// lift_time 145 ms (80 to 400 ms), goal (0, 0) m (-10 to 10 m), a kp (220, 237, 400) (0 to 800).
inline footfall_lcm::catalogue_t small_catalogue() {
  footfall_lcm::catalogue_t told{};
  told.session = 7;
  told.behavior = "balance";
  told.path = "/nowhere/balance.yaml";
  told.robot = "hume";
  told.rate = 1000.0;
  told.parameters = {told_parameter("gains.single.swing.kp", 3, 3, "1/s^2", 0.0, 800.0, true),
                     told_parameter("lift_time", 0, 1, "s", 0.08, 0.4, false),
                     told_parameter("goal", 1, 2, "m", -10.0, 10.0, false)};
  told.parameters[0].axes = {"pitch", "roll", "yaw"};
  told.fixed = {"clearance"};
  told.fixed_reasons = {"the file says so"};
  told.values = {0.145, 0.0, 0.0, 220.0, 237.0, 400.0};
  told.events = {"start"};
  told.event_docs = {"the people let go"};
  told.states = {"rise", "step.right_foot.lift"};
  told.tasks = {"height", "swing"};
  told.feet = {"right_foot", "left_foot"};
  told.signals = {"com.pos.z", "task.height.error", "steps"};
  told.signal_units = {"m", "m", ""};
  told.faults = {"torque.limit"};
  return told;
}

inline footfall_lcm::values_t values_with(const TuneModel& model, int slot, double value,
                                          std::int64_t revision) {
  footfall_lcm::values_t told = model.values;
  told.session = model.catalogue.session;
  told.generation = model.catalogue.generation;
  told.revision = revision;
  told.now[static_cast<std::size_t>(slot)] = value;
  told.target[static_cast<std::size_t>(slot)] = value;
  return told;
}

inline footfall_lcm::telemetry_t told_telemetry(double time, float height) {
  footfall_lcm::telemetry_t told{};
  told.session = 7;
  told.tick = static_cast<std::int64_t>(1000.0 * time);
  told.time = time;
  told.active = {1};
  footfall_lcm::task_t task{};
  task.error = 0.0021;
  task.authority = 0.43;
  told.tasks = {task};
  told.forces = {{0.0, 0.0, 262.0}, {0.0, 0.0, 0.0}};
  told.faults = {3};
  told.signals = {height, 0.0021F, 14.0F};
  return told;
}

inline TuneModel small_model() {
  TuneModel model;
  take_catalogue(model, small_catalogue());
  return model;
}

}  // namespace footfall::apps
