// Files and settings of a run; see log_setup.h.
#include "lab/run/log_setup.h"

#include <elf.h>
#include <fmt/format.h>
#include <link.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/text/json_text.h"
#include "core/text/whole_file.h"
#include "core/yaml/yaml.h"
#include "lab/run/run_log.h"
#include "model/robot/torque_loop.h"

namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

std::string absolute(const std::string& path) {
  return path.empty() ? path : fs::absolute(path).lexically_normal().string();
}

// The values of all XML attributes NAME, which begins a word: NAME="value" or NAME='value'.
std::vector<std::string> attribute_values(std::string_view text, std::string_view name) {
  constexpr std::string_view kSpace = " \t\r\n";
  std::vector<std::string> values;
  for (std::size_t at = text.find(name); at != text.npos; at = text.find(name, at + 1)) {
    if (at == 0 || kSpace.find(text[at - 1]) == text.npos) continue;
    std::size_t next = text.find_first_not_of(kSpace, at + name.size());
    if (next == text.npos || text[next] != '=') continue;
    next = text.find_first_not_of(kSpace, next + 1);
    if (next == text.npos || (text[next] != '"' && text[next] != '\'')) continue;
    const std::size_t end = text.find(text[next], next + 1);
    if (end != text.npos) values.emplace_back(text.substr(next + 1, end - next - 1));
  }
  return values;
}

class Collector {
 public:
  std::vector<engine::LogFile> files;

  // A YAML file and its bases.
  void add_yaml(const std::string& path) {
    if (path.empty()) return;
    core::Diagnostics diagnostics;
    core::load_yaml_with_base(path, diagnostics);
    for (int i = 0; i < diagnostics.file_count(); ++i) add(diagnostics.file(i), "application/yaml");
  }

  void add_text(const std::string& path, const std::string& media_type, std::string text) {
    const std::string name = absolute(path);
    if (has(name)) return;
    files.push_back({name, media_type, std::move(text)});
  }

  // A model, and what it names by `file="..."`: other models and meshes.
  void add_model(const std::string& path) {
    if (path.empty() || has(absolute(path)) || !add(path, "application/xml")) return;
    const std::string text = files.back().content;  // add() may move it
    const fs::path folder = fs::path(absolute(path)).parent_path();
    std::vector<fs::path> folders = {folder};
    for (const char* name : {"meshdir", "texturedir", "assetdir"}) {
      for (const std::string& value : attribute_values(text, name)) {
        folders.push_back(folder / value);
      }
    }
    for (const char* attribute : {"file", "filename"}) {  // MJCF, URDF
      for (const std::string& name : attribute_values(text, attribute)) {
        for (const fs::path& from : folders) add_part((from / name).string());
      }
    }
  }

 private:
  void add_part(const std::string& file) {
    if (file.ends_with(".xml")) {
      add_model(file);
    } else {
      add(file, "application/octet-stream");
    }
  }

  bool has(const std::string& path) const {
    return std::ranges::any_of(files, [&](const auto& file) { return file.path == path; });
  }

  bool add(const std::string& path, const std::string& media_type) {
    const std::string name = absolute(path);
    std::error_code error;
    if (has(name) || !fs::exists(name, error) || fs::is_directory(name, error)) return false;
    std::string problem;
    auto content = core::read_file(name, std::string::npos, problem);
    if (content) files.push_back({name, media_type, std::move(*content)});
    return content.has_value();
  }
};

}  // namespace

std::vector<engine::LogFile> source_files(const behaviors::Behavior& behavior,
                                          const std::string& world_file) {
  Collector collector;
  collector.add_yaml(behavior.path);
  for (const std::string& file : behavior.files) collector.add_yaml(file);
  for (const behaviors::ScriptFile& script : behavior.scripts) {
    collector.add_text(script.path, "text/x-lua", script.text);
  }
  collector.add_yaml(behavior.robot.path);
  collector.add_model(behavior.robot.model_path);
  collector.add_yaml(world_file);
  return std::move(collector.files);
}

namespace {

nlohmann::ordered_json terrain_json(const model::Terrain& terrain) {
  auto json = nlohmann::ordered_json::array();
  for (const model::TerrainPiece& box : terrain.boxes) {
    json.push_back({{"centre", box.centre}, {"R_WP", box.R_WP}, {"half", box.half}});
  }
  return json;
}

// Level ground in logs from before there was terrain.
model::Terrain read_terrain(const nlohmann::json& json, const char* key) {
  model::Terrain terrain;
  for (const auto& box : json.value(key, nlohmann::json::array())) {
    model::TerrainPiece& piece = terrain.boxes.emplace_back();
    box.at("centre").get_to(piece.centre);
    box.at("R_WP").get_to(piece.R_WP);
    box.at("half").get_to(piece.half);
  }
  return terrain;
}

void add_actuators(const model::RobotDescription& robot, nlohmann::ordered_json& json) {
  json["command_limit"] = robot.command_limit;
  json["springs"] = json["torque_loop"] = nlohmann::ordered_json::array();
  for (const model::JointDescription& joint : robot.joints) json["springs"].push_back(joint.spring);
  for (const hal::TorqueLoopGains& gains : robot.drives.torque_loop) {
    nlohmann::ordered_json row = {static_cast<int>(gains.type), static_cast<int>(gains.damps)};
    for (const model::TorqueLoopKey& key : model::kTorqueLoopGainKeys) {
      row.push_back(gains.*key.member);
    }
    json["torque_loop"].push_back(std::move(row));
  }
}

void read_actuators(const nlohmann::json& json, RunSetup& setup) {
  json.at("springs").get_to(setup.springs);
  setup.command_limit = json.value("command_limit", 1.0);
  for (const auto& row : json.at("torque_loop")) {
    hal::TorqueLoopGains& gains = setup.torque_loop.emplace_back();
    gains.type = static_cast<hal::TorqueLoopGains::Type>(row.at(0).get<int>());
    gains.damps = static_cast<hal::TorqueLoopGains::Damping>(row.at(1).get<int>());
    std::size_t column = 2;
    for (const model::TorqueLoopKey& key : model::kTorqueLoopGainKeys) {
      row.at(column++).get_to(gains.*key.member);
    }
  }
}

}  // namespace

std::function<void(model::RobotDescription&, core::Diagnostics&)> actuators_of(
    const RunSetup& setup) {
  if (setup.springs.empty()) return {};
  return [springs = setup.springs, loops = setup.torque_loop, limit = setup.command_limit](
             model::RobotDescription& robot, core::Diagnostics&) {
    robot.command_limit = limit;
    for (std::size_t j = 0; j < robot.joints.size() && j < springs.size(); ++j) {
      robot.joints[j].spring = springs[j];
    }
    if (loops.size() == robot.joints.size()) robot.drives.torque_loop = loops;
  };
}

std::string setup_text(const behaviors::Behavior& behavior, const LogSource& source) {
  const engine::LoopSettings& s = source.settings;
  nlohmann::ordered_json json;
  json["behavior_file"] = absolute(behavior.path);
  json["robot_file"] = absolute(behavior.robot.path);
  json["world_file"] = absolute(source.world_file);
  json["set"] = source.set;
  json["seed"] = s.seed;
  json["lockstep"] = s.lockstep;
  json["planner_latency"] = s.planner_latency;
  json["mass_scale"] = s.deviation.mass_scale;
  json["mass_scales"] = s.deviation.mass_scales;
  json["com_shift"] = s.deviation.com_shift;
  json["terrain"] = terrain_json(s.deviation.terrain);
  json["true_terrain"] = terrain_json(source.terrain);
  json["held"] = nlohmann::json::array();
  for (const model::HeldAxis& held : s.deviation.held) {
    json["held"].push_back({held.body, held.axis});
  }
  if (source.own_actuators) add_actuators(behavior.robot, json["actuators"]);
  json["surface"] = nlohmann::json::array();
  for (const model::SurfaceRamp& ramp : s.surface.ramps) {
    json["surface"].push_back({ramp.from, ramp.to, ramp.rise});
  }
  json["script_access"] = {{"files", s.script_access.files},
                           {"processes", s.script_access.processes}};
  return core::json_text(json);
}

Grounds grounds_of(const std::string& setup_text) {
  if (setup_text.empty()) return {};
  try {
    RunSetup setup = read_setup(setup_text);
    return {std::move(setup.terrain), std::move(setup.settings.deviation.terrain)};
  } catch (const std::runtime_error&) {
    return {};
  }
}

std::string setup_text(const std::string& text, const LogContinuation& continues) {
  auto json = core::parse_ordered_json(text);
  json["continues"] = {
      {"number", continues.number}, {"back", continues.back}, {"watch", continues.watch}};
  return core::json_text(json);
}

RunSetup read_setup(const std::string& text) {
  RunSetup setup;
  try {
    const auto json = core::parse_json(text);
    setup.behavior_file = json.at("behavior_file");
    setup.robot_file = json.at("robot_file");
    json.at("set").get_to(setup.set);
    engine::LoopSettings& s = setup.settings;
    json.at("seed").get_to(s.seed);
    json.at("lockstep").get_to(s.lockstep);
    json.at("planner_latency").get_to(s.planner_latency);
    json.at("mass_scale").get_to(s.deviation.mass_scale);
    json.at("mass_scales").get_to(s.deviation.mass_scales);
    json.at("com_shift").get_to(s.deviation.com_shift);
    s.deviation.terrain = read_terrain(json, "terrain");
    setup.terrain = read_terrain(json, "true_terrain");
    for (const auto& held : json.value("held", nlohmann::json::array())) {
      s.deviation.held.push_back({held.at(0), held.at(1)});
    }
    for (const auto& ramp : json.at("surface")) {
      s.surface.ramps.push_back({ramp.at(0), ramp.at(1), ramp.at(2)});
    }
    if (json.contains("actuators")) read_actuators(json.at("actuators"), setup);
    if (json.contains("continues")) {
      const auto& from = json.at("continues");
      setup.continues = {from.at("number"), from.at("back"), from.at("watch")};
    }
    s.script_access = {json.at("script_access").at("files"),
                       json.at("script_access").at("processes")};
  } catch (const nlohmann::json::exception&) {
    throw std::runtime_error("the log does not say how its run was set up, so it has no replay");
  }
  return setup;
}

std::string build_id() {
  std::string id;
  const auto visit = [](dl_phdr_info* info, std::size_t, void* to) {
    for (int i = 0; i < info->dlpi_phnum; ++i) {
      const ElfW(Phdr)& header = info->dlpi_phdr[i];
      if (header.p_type != PT_NOTE) continue;
      const auto* at = reinterpret_cast<const char*>(info->dlpi_addr + header.p_vaddr);
      const char* end = at + header.p_memsz;
      while (at + sizeof(ElfW(Nhdr)) <= end) {
        ElfW(Nhdr) note;
        std::memcpy(&note, at, sizeof note);
        const char* name = at + sizeof note;
        const char* bytes = name + (note.n_namesz + 3) / 4 * 4;
        at = bytes + (note.n_descsz + 3) / 4 * 4;
        if (note.n_type != NT_GNU_BUILD_ID || std::memcmp(name, "GNU", 4) != 0) continue;
        for (unsigned k = 0; k < note.n_descsz; ++k) {
          *static_cast<std::string*>(to) +=
              fmt::format("{:02x}", static_cast<unsigned char>(bytes[k]));
        }
      }
    }
    return 1;  // the first object is the program
  };
  ::dl_iterate_phdr(visit, &id);
  return id;
}

}  // namespace footfall::lab
