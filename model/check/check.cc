// Compiles a robot's model twice, with all shapes and as physics has it; see check.h.
#include "model/check/check.h"

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "core/index.h"
#include "model/check/context.h"
#include "model/mjcf.h"

namespace footfall::model {
namespace {

using Compiled = std::unique_ptr<mjModel, void (*)(mjModel*)>;

Compiled compile_whole(const std::string& path) { return {load_whole_model(path), mj_deleteModel}; }
Compiled compile_physics(const std::string& path) {
  return {load_robot_model(path), mj_deleteModel};
}

// The word in quotes behind `before`.
std::string quoted(const std::string& text, const std::string& before) {
  const std::size_t at = text.find(before + " '");
  if (at == std::string::npos) return {};
  const std::size_t from = at + before.size() + 2;
  return text.substr(from, text.find('\'', from) - from);
}

const MjcfElement* search(const MjcfElement& e, const std::string& tag, const std::string& name) {
  if (e.tag == tag && e.find(name) != nullptr) return &e;
  for (const MjcfElement* child : e.children) {
    if (const MjcfElement* found = search(*child, tag, name)) return found;
  }
  return nullptr;
}

// MuJoCo says "unrecognized attribute: 'x' Element 'body', line 0": files that are included have no
// lines for it.
MjcfPlace place_of_refusal(const MjcfSource& source, const std::string& text) {
  const std::string tag = quoted(text, "Element");
  const std::string attribute = quoted(text, "attribute:");
  for (const MjcfElement* root : source.roots()) {
    const MjcfElement* const found = search(*root, tag, attribute);
    if (found != nullptr) return found->find(attribute)->place;
  }
  return {};
}

}  // namespace

bool check_model(const RobotDescription& robot, core::Diagnostics& diagnostics) {
  const MjcfSource source(robot.model_path);
  std::optional<Compiled> whole, physics;
  try {
    whole = compile_whole(robot.model_path);
    physics = compile_physics(robot.model_path);
  } catch (const std::runtime_error& error) {
    std::string text = error.what();
    const MjcfPlace place = place_of_refusal(source, text);
    const std::string head = robot.model_path + ": error: ";
    if (text.starts_with(head)) text.erase(0, head.size());
    const auto& files = source.files();
    const std::string& file = files.empty() ? robot.model_path : files[at(place.file)];
    diagnostics.error({diagnostics.add_file(file), place.line, place.column}, "model", text);
    return false;
  }
  ModelContext context(**whole, robot, source, diagnostics);
  check_settings(context);
  check_base(context);
  check_actuators(context);
  check_passive(context);
  check_collisions(context);
  check_masses(context, **physics);
  return true;
}

}  // namespace footfall::model
