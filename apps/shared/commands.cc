// Functions shared by the sub-commands; see commands.h.
#include "apps/shared/commands.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <new>

#include "behaviors/check/physics/check.h"
#include "behaviors/loader.h"
#include "core/process/machine_error.h"
#include "sim/world/description.h"

namespace footfall::apps {
namespace fs = std::filesystem;

std::vector<std::string> search_path() {
  std::vector<std::string> folders = {"."};
  if (const char* variable = std::getenv("FOOTFALL_PATH")) {
    std::string text = variable;
    for (std::size_t begin = 0; begin <= text.size();) {
      const std::size_t end = std::min(text.find(':', begin), text.size());
      if (end > begin) folders.push_back(text.substr(begin, end - begin));
      begin = end + 1;
    }
  }
  // An installed program finds its data relative to itself, so that the installation can be moved.
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (!error)
    folders.push_back((program.parent_path() / "../share/footfall").lexically_normal().string());
  folders.emplace_back(FOOTFALL_SOURCE_DIR);
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
  std::string text = diagnostics.to_string();
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

std::vector<std::pair<std::string, std::string>> split_settings(const std::vector<std::string>& set,
                                                                core::Diagnostics& diagnostics) {
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      diagnostics.error({diagnostics.add_file("--set"), 0, 0}, "set",
                        fmt::format("expected NAME=VALUE, got '{}'", text));
      continue;
    }
    pairs.emplace_back(text.substr(0, equals), text.substr(equals + 1));
  }
  return pairs;
}

behaviors::PhysicsWorld physics_world(const sim::WorldDescription& world) {
  return {world.friction, world.physics.steps_per_tick, world.actuators.command_delay};
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
  std::unique_ptr<behaviors::Behavior> behavior;
  if (!diagnostics.has_errors()) {
    behavior = behaviors::load_behavior(find_behavior_file(path), options, diagnostics);
  }
  if (behavior != nullptr && world != nullptr) {
    behaviors::check_physics(*behavior, diagnostics, *world);
  }
  print_diagnostics(diagnostics);
  return diagnostics.has_errors() ? nullptr : std::move(behavior);
}

}  // namespace footfall::apps
