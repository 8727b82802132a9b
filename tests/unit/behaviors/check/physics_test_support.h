// Short ways to ask the physics checks about a behavior given as text.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"
#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {

// What the physics checks report, one line each; what prevented loading otherwise.
inline std::string judged_in(const std::string& text, const behaviors::PhysicsWorld& world,
                             const behaviors::LoadOptions& options = options_for_tests()) {
  core::Diagnostics diagnostics;
  const auto behavior = behaviors::load_behavior_text(text, "b.yaml", options, diagnostics);
  if (behavior == nullptr) return diagnostics.to_string();
  core::Diagnostics findings;  // without the loader's warnings; the same files in the same order
  for (int file = 0; file < diagnostics.file_count(); ++file) {
    findings.add_file(diagnostics.file(file));
  }
  behaviors::check_physics(*behavior, findings, world);
  return findings.to_string();
}
inline std::string physics(const std::string& text,
                           const behaviors::LoadOptions& options = options_for_tests()) {
  return judged_in(text, {}, options);
}

// `b.yaml:LINE:COLUMN: ` of the first place of a piece of text.
inline std::string place_of(const std::string& text, const std::string& piece) {
  const std::size_t found = text.find(piece);
  if (found == std::string::npos) return "not in the text: " + piece;
  int line = 1, column = 1;
  for (std::size_t i = 0; i < found; ++i) {
    ++column;
    if (text[i] == '\n') ++line, column = 1;
  }
  return "b.yaml:" + std::to_string(line) + ":" + std::to_string(column) + ": ";
}

// A behavior that stands in one state: contacts, tasks, and what else the stack holds.
inline std::string standing(const std::string& contacts, const std::string& tasks,
                            const std::string& rest = "") {
  return "behavior: 1\nrobot: hume\nstacks:\n  s:\n    contacts: " + contacts + "\n    tasks:\n" +
         tasks + rest + "machine:\n  stack: s\n  states: {stand: {doc: here}}\n";
}

inline std::string height() {
  return "      height: {type: com_position, axes: [z], reference: entry, gains: {kp: 1}}\n";
}
inline std::string attitude(const std::string& axes) {
  return "      attitude: {type: body_orientation, axes: " + axes +
         ", reference: 0, gains: {kp: 1}}\n";
}
inline std::string swing() {
  return "      swing: {type: point_position, point: left_foot, reference: entry, gains: {kp: "
         "1}}\n";
}
inline std::string rest() {
  return "      rest: {type: joint_damping, priority: 2, gains: {kd: 1}}\n";
}
inline std::string dual_tasks() { return height() + attitude("[yaw, pitch, roll]") + rest(); }
inline std::string single_tasks() { return height() + attitude("[pitch, roll]") + swing(); }

// Hume with other contacts: a robot file of its own, based on the shipped one.
inline behaviors::LoadOptions with_contacts(const std::string& folder, const std::string& right,
                                            const std::string& left) {
  const std::string path = folder + "/other.yaml";
  std::ofstream(path) << "robot: 1\nbase: "
                      << std::filesystem::absolute(FOOTFALL_SOURCE_DIR).string()
                      << "/robots/hume/robot.yaml\ncontacts:\n  right_foot: " << right
                      << "\n  left_foot: " << left << "\n";
  behaviors::LoadOptions options = options_for_tests();
  options.robot = path;
  return options;
}

}  // namespace footfall::tests
