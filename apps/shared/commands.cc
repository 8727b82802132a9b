// Functions shared by the sub-commands; see commands.h.
#include "apps/shared/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>

#include "behaviors/check/actuators/drives.h"
#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/diagnostics/quantity_hint.h"
#include "core/process/machine_error.h"
#include "core/text/printable.h"
#include "core/text/search_folders.h"
#include "model/mjcf.h"
#include "sim/springs_check.h"
#include "sim/world/description.h"

namespace footfall::apps {
namespace fs = std::filesystem;

std::vector<std::string> search_path() {
  // What lies above the working folder, too: a project is found from inside it.
  std::vector<std::string> folders = core::search_from("./file", {});
  folders.insert(folders.begin(), ".");
  if (const char* variable = std::getenv("FOOTFALL_PATH")) {
    std::string text = variable;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) folders.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  std::vector<std::string> installed = installed_folders();
  folders.insert(folders.end(), installed.begin(), installed.end() - 1);
  folders.emplace_back(FOOTFALL_SOURCE_DIR);
  folders.push_back(installed.back());
  return folders;
}

std::vector<std::string> installed_folders() {
  std::vector<std::string> folders;
  // An installed program finds its data relative to itself, so that the installation can be moved.
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error)
    folders.push_back((program.parent_path() / "../share/footfall").lexically_normal().string());
  folders.emplace_back(FOOTFALL_DATA_DIR);
  return folders;
}

std::string find_behavior_file(const std::string& name) {
  std::error_code ignored;
  if (fs::is_regular_file(name, ignored)) return name;
  for (const std::string& folder : search_path()) {
    for (const char* ending : {"", ".yaml"}) {
      const std::string candidate = folder + "/behaviors/library/" + name + ending;
      if (fs::is_regular_file(candidate, ignored)) return candidate;
    }
  }
  return name;
}

bool behavior_is_there(const std::string& name, core::Diagnostics& diagnostics) {
  const std::string path = find_behavior_file(name);
  std::error_code ignored;
  if (path != name || fs::exists(path, ignored)) return true;
  const std::string hint = core::did_you_mean_or_list(
      fs::path(name).stem().string(), core::names_in(search_path(), "behaviors/library"));
  diagnostics.error({diagnostics.add_file(name), 0, 0}, "cannot-read",
                    "no such file, and no behavior of this name in the library" + hint);
  return false;
}

std::string require_named_file(const std::string& name, core::Diagnostics& diagnostics) {
  const std::vector<std::string> search = search_path();
  std::string path = find_behavior_file(name);
  if (path != name || core::is_readable_source(name)) return path;
  path = sim::find_world_file(name, search);
  if (path.empty()) path = model::find_robot_file(name, search);
  std::error_code ignored;
  // A folder hides no name; one that nothing else is called by is refused by who reads it.
  if (path.empty() && fs::exists(name, ignored)) path = name;
  if (!path.empty()) return path;
  std::vector<std::string> known = core::names_in(search, "behaviors/library");
  for (const auto& [place, inside] : {std::pair("sim/worlds", ""), {"robots", "robot.yaml"}}) {
    for (std::string& other : core::names_in(search, place, inside))
      known.push_back(std::move(other));
  }
  diagnostics.error({diagnostics.add_file(name), 0, 0}, "cannot-read",
                    "no such file, and no behavior, world or robot of this name" +
                        core::did_you_mean(fs::path(name).stem().string(), known));
  return {};
}

std::vector<std::string> base_folders() {
  std::vector<std::string> folders = behaviors::library_folders(search_path());
  for (std::string& folder : sim::world_folders(search_path()))
    folders.push_back(std::move(folder));
  return folders;
}

int tell_error(const std::exception& error, int otherwise) {
  const auto* const files = dynamic_cast<const fs::filesystem_error*>(&error);
  const std::string text =
      files == nullptr ? std::string(error.what())
                       : fmt::format("{}: {}", files->path1().string(), files->code().message());
  const char* const end = text.ends_with('\n') ? "" : "\n";
  const bool machine = files != nullptr || dynamic_cast<const core::MachineError*>(&error) ||
                       dynamic_cast<const std::bad_alloc*>(&error);
  if (machine) {
    fmt::print(stderr, "footfall: error: {}{}", text, end);
    return kMachineFailed;
  }
  const bool ours = dynamic_cast<const InputError*>(&error) != nullptr;
  const bool placed = text.find("error: ") != std::string::npos;
  if (!text.empty()) fmt::print(stderr, "{}{}{}", placed ? "" : "error: ", text, end);
  return ours || placed ? kBadInput : otherwise;
}

int guarded(const std::function<int()>& work, int otherwise) {
  try {
    return work();
  } catch (const std::exception& error) {
    return tell_error(error, otherwise);
  }
}

void print_diagnostics(const core::Diagnostics& diagnostics) {
  std::string text = core::printable_lines(diagnostics.to_string());
  if (::isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr) {
    for (const auto& [word, colour] : {std::pair(" error: ", 31), std::pair(" warning: ", 33)}) {
      const std::string coloured = fmt::format(
          " \033[1;{}m{}\033[0m ", colour, std::string_view(word).substr(1, std::strlen(word) - 2));
      // Only the first occurrence in each line: the rest may quote the file.
      for (std::size_t line = 0; line < text.size();) {
        const std::size_t end = std::min(text.find('\n', line), text.size());
        const std::size_t at = text.find(word, line);
        if (at < end) {
          text.replace(at, std::strlen(word), coloured);
          line = text.find('\n', at) + 1;
        } else {
          line = end + 1;
        }
      }
    }
  }
  std::fputs(text.c_str(), stderr);
}

namespace {

// The same value, or one of the other's parts: `goal` and `goal.x`.
bool overlap(const std::string& a, const std::string& b) {
  const std::string& whole = a.size() < b.size() ? a : b;
  const std::string& part = a.size() < b.size() ? b : a;
  return part.starts_with(whole) &&
         (part.size() == whole.size() || part[whole.size()] == '.' || part[whole.size()] == '[');
}

}  // namespace

std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& set,
                                                                core::Diagnostics& diagnostics) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (std::size_t k = 0; k < set.size(); ++k) {
    const std::string& text = set[k];
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      bool rest = false;
      const std::string hint = core::split_argument_hint(set, k, rest);
      if (rest) continue;
      diagnostics.error(
          {diagnostics.add_file("--set"), 0, 0}, "set",
          fmt::format("expected NAME=VALUE, got '{}'{}{}", text, hint.empty() ? "" : ": ", hint));
      continue;
    }
    const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
    const auto before = std::ranges::find_if(
        pairs, [&name](const auto& pair) { return overlap(pair.first, name); });
    if (before != pairs.end()) {
      const std::string twice =
          before->first == name
              ? fmt::format("'{}' is set twice, to '{}' and to '{}'", name, before->second, value)
              : fmt::format("'{}' and '{}' are both set", before->first, name);
      diagnostics.error({diagnostics.add_file("--set"), 0, 0}, "set",
                        twice + ": expected one of them");
      continue;
    }
    pairs.emplace_back(name, value);
  }
  return pairs;
}

namespace {

std::function<void(model::RobotDescription&, core::Diagnostics&)> actuators_of(
    const sim::WorldDescription& world) {
  if (!sim::changes_robot(world.actuators)) return {};
  return [actuators = world.actuators](model::RobotDescription& robot, core::Diagnostics& told) {
    sim::apply_actuators(actuators, robot, told);
  };
}

}  // namespace

behaviors::PhysicsWorld physics_world(const sim::WorldDescription& world, bool held) {
  return {world.variation.least_friction().value_or(world.friction),
          world.physics.steps_per_tick,
          world.actuators.command_delay + world.variation.most_command_delay(),
          world.actuators.model == sim::ActuatorModel::series_elastic,
          world.actuators.measurement_delay,
          world.actuators.viscous,
          world.constraints.empty() && !held ? world.name : "",
          world.control_model.terrain,
          actuators_of(world),
          [start = world.start_joints](const model::RobotDescription& robot) {
            core::Diagnostics ignored;  // told where the world meets the robot
            return sim::start_joints(start, robot, ignored);
          }};
}

void check_world_fits(const sim::WorldDescription& world, const model::RobotDescription& of_file,
                      core::Diagnostics& diagnostics,
                      const std::vector<model::BodySprings>& holds) {
  model::RobotDescription robot = of_file;
  const int before = diagnostics.error_count();
  sim::apply_actuators(world.actuators, robot, diagnostics);  // once more, maybe: the same
  if (diagnostics.error_count() > before) return;
  sim::check_actuators(world, robot, diagnostics);
  sim::check_sensors(world.sensors, robot, diagnostics);
  if (world.actuators.model == sim::ActuatorModel::series_elastic) {
    behaviors::check_drives(robot, diagnostics);
  }
  try {
    const bool names = !world.links.empty() || !world.variation.links.empty();
    // Spares reading the model.
    if (names) sim::check_links(world, model::body_names(robot.model_path), diagnostics);
    sim::check_springs(world, holds, robot, diagnostics);
  } catch (const std::runtime_error& error) {
    diagnostics.error({diagnostics.add_file(robot.path), 0, 0}, "model", error.what());
  }
}

std::unique_ptr<behaviors::Behavior> load_or_explain(const std::string& path,
                                                     const std::string& robot,
                                                     const std::vector<std::string>& set,
                                                     const behaviors::PhysicsWorld* world) {
  core::Diagnostics diagnostics;
  behaviors::LoadOptions options;
  options.search = search_path();
  options.robot = robot;
  options.set = split_settings(set, diagnostics);
  if (world != nullptr) options.check = behaviors::physics_check(*world);
  if (world != nullptr) options.world = world->actuators;
  std::unique_ptr<behaviors::Behavior> behavior;
  if (!diagnostics.has_errors() && behavior_is_there(path, diagnostics)) {
    behavior = behaviors::load_behavior(find_behavior_file(path), options, diagnostics);
  }
  print_diagnostics(diagnostics);
  return diagnostics.has_errors() ? nullptr : std::move(behavior);
}

}  // namespace footfall::apps
