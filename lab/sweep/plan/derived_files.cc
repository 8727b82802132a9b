// Writes derived scenarios and worlds; see derived_files.h.
#include "lab/sweep/plan/derived_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <stdexcept>

#include "core/text/dotted_name.h"
#include "core/text/whole_file.h"
#include "core/yaml_text/write.h"
#include "lab/sweep/plan/yaml_build.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;
using core::YamlNode;

constexpr std::string_view kScript = "script.", kWorld = "world.", kVariation = "variation.";

YamlNode parsed(const std::string& text) {
  core::Diagnostics ignored;  // the file was loaded before, or written by us
  return core::load_yaml_text(text, "", ignored);
}

// Sets the value at the path `parts` (without its first element); creates missing maps.
void put_at(YamlNode& root, const std::vector<std::string>& parts, const std::string& text) {
  YamlNode* node = &root;
  for (std::size_t k = 1; k + 1 < parts.size(); ++k) {
    YamlNode* next = nullptr;
    for (core::YamlEntry& entry : node->entries) {
      if (entry.key == parts[k]) next = &entry.value;
    }
    node = next != nullptr && next->is_map() ? next : &yaml_put(*node, parts[k], yaml_map());
  }
  yaml_put(*node, parts.back(), parsed(text));
}

// script.N.KEY...
void put_in_script(std::vector<YamlNode>& script, const std::string& name,
                   const std::string& text) {
  std::vector<std::string> parts = core::split_dots(name);
  std::size_t number = 0;
  const std::string& digits = parts[1];
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (error != std::errc() || end != digits.data() + digits.size() || number < 1 ||
      number > script.size() || parts.size() < 3) {
    throw std::runtime_error(fmt::format(
        "expected script.N.KEY with N from 1 to {}: the scenario's entries", script.size()));
  }
  const YamlNode* known = &script[number - 1];
  for (std::size_t k = 2; k + 1 < parts.size() && known != nullptr; ++k) {
    known = known->find(parts[k]);
  }
  if (known == nullptr || !known->is_map()) {
    throw std::runtime_error(fmt::format("entry {} of the script has no '{}'", digits, parts[2]));
  }
  parts.erase(parts.begin());
  put_at(script[number - 1], parts, text);
}

YamlNode fault_entry(const SweepFault& fault) {
  YamlNode entry = yaml_map();
  yaml_put(entry, "at", yaml_scalar(fault.at));
  yaml_put(entry, "fault", yaml_scalar(fault.fault));
  if (!fault.duration.empty()) yaml_put(entry, "for", yaml_scalar(fault.duration));
  return entry;
}

std::string absolute(const std::string& path) {
  return fs::absolute(path).lexically_normal().string();
}

}  // namespace

bool is_script_axis(const std::string& name) { return name.starts_with(kScript); }
bool is_world_axis(const std::string& name) { return name.starts_with(kWorld); }
bool is_variation_axis(const std::string& name) { return name.starts_with(kVariation); }
bool is_scenario_axis(const std::string& name) {
  return is_script_axis(name) || is_variation_axis(name);
}

SweepFiles::SweepFiles(const SweepDescription& sweep, std::string folder,
                       std::vector<std::string> worlds)
    : sweep_(sweep), folder_(std::move(folder)), worlds_(std::move(worlds)) {
  any_fault_ =
      std::ranges::any_of(sweep.faults, [](const SweepFault& f) { return !f.fault.empty(); });
  any_of_scenario_ =
      std::ranges::any_of(sweep.axes, [](const SweepAxis& a) { return is_scenario_axis(a.name); });
  if (sweep.scenario.empty()) return;
  core::Diagnostics diagnostics;
  scenario_ = core::load_yaml_with_base(sweep.scenario, diagnostics);
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
}

SweepTarget SweepFiles::target(const SweepRun& run) {
  SweepTarget target;
  target.scenario = !sweep_.scenario.empty() || any_fault_ || any_of_scenario_;
  if (!worlds_.empty()) target.world = derived_world(run, worlds_[run.world]);
  for (auto& [name, text] : settings_of(sweep_, run)) {
    if (!is_scenario_axis(name) && !is_world_axis(name)) target.set.emplace_back(name, text);
  }
  target.path = sweep_.behavior;
  if (!target.scenario) return target;
  target.path = sweep_.scenario;
  const bool as_it_is = !sweep_.scenario.empty() && !any_fault_ && !any_of_scenario_ &&
                        worlds_.empty() && sweep_.duration.empty() &&
                        scenario_.find("golden") == nullptr;
  if (!as_it_is) target.path = derived_scenario(run, target);
  return target;
}

std::string SweepFiles::derived_scenario(const SweepRun& run, const SweepTarget& target) {
  YamlNode root = yaml_map();
  yaml_put(root, "scenario", yaml_scalar("1"));
  std::vector<YamlNode> script;
  if (sweep_.scenario.empty()) {
    yaml_put(root, "behavior", yaml_scalar(absolute(sweep_.behavior)));
    if (!sweep_.robot.empty()) yaml_put(root, "robot", yaml_scalar(sweep_.robot));
    yaml_put(root, "for", yaml_scalar(sweep_.duration.empty() ? "20 s" : sweep_.duration));
  } else {
    yaml_put(root, "base", yaml_scalar(absolute(sweep_.scenario)));
    if (!sweep_.duration.empty()) yaml_put(root, "for", yaml_scalar(sweep_.duration));
    // The golden trace was recorded with other parameters.
    if (scenario_.find("golden") != nullptr) yaml_put(root, "golden", yaml_scalar("off"));
    if (const YamlNode* base = scenario_.find("script")) script = base->items;
  }
  if (!target.world.empty()) yaml_put(root, "world", yaml_scalar(absolute(target.world)));
  for (const auto& [name, text] : settings_of(sweep_, run)) {
    try {
      if (is_script_axis(name)) put_in_script(script, name, text);
      if (is_variation_axis(name)) put_at(root, core::split_dots("scenario." + name), text);
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(name + ": " + error.what());
    }
  }
  const SweepFault& fault = sweep_.faults[run.fault];
  if (!fault.fault.empty()) script.push_back(fault_entry(fault));
  if (!script.empty()) {
    YamlNode list;
    list.kind = YamlNode::Kind::sequence;
    list.items = std::move(script);
    yaml_put(root, "script", std::move(list));
  }
  return write(root, "scenario");
}

std::string SweepFiles::derived_world(const SweepRun& run, const std::string& base) {
  YamlNode root = yaml_map();
  yaml_put(root, "world", yaml_scalar("1"));
  yaml_put(root, "base", yaml_scalar(absolute(base)));
  bool changed = false;
  for (const auto& [name, text] : settings_of(sweep_, run)) {
    if (!is_world_axis(name)) continue;
    put_at(root, core::split_dots(name), text);
    changed = true;
  }
  return changed ? write(root, "world") : base;
}

std::string SweepFiles::write(const YamlNode& root, const char* kind) {
  const std::string text = core::to_yaml(root);
  const std::string path = fmt::format("{}/{}-{}.yaml", folder_, kind, digest(text));
  if (!written_.insert(path).second) return path;
  std::error_code error;
  fs::create_directories(folder_, error);
  core::write_whole_file(path, text);
  return path;
}

std::vector<std::string> command_of(const std::string& program, const SweepDescription& sweep,
                                    const SweepRun& run, const SweepTarget& target) {
  std::vector<std::string> command = {program, "run", target.path};
  if (!target.scenario) {
    if (!sweep.robot.empty()) command.insert(command.end(), {"--robot", sweep.robot});
    if (!target.world.empty()) command.insert(command.end(), {"--world", target.world});
    if (!sweep.duration.empty()) command.insert(command.end(), {"--for", sweep.duration});
  }
  command.insert(command.end(), {"--seed", std::to_string(run.seed)});
  for (const auto& [name, text] : target.set) {
    command.insert(command.end(), {"--set", name + "=" + text});
  }
  return command;
}

}  // namespace footfall::lab
