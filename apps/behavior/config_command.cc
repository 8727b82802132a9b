// `footfall config`: the effective content of a file, and the origin of its values.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/shared/commands.h"
#include "behaviors/explain/explain_machine.h"
#include "behaviors/language/language.h"
#include "behaviors/loader.h"
#include "core/text/json_text.h"
#include "core/yaml/explain.h"
#include "core/yaml_text/write.h"
#include "lab/scenario/keys.h"
#include "model/robot/keys.h"
#include "sim/world/keys.h"

namespace footfall::apps {
namespace {

struct ConfigOptions {
  std::string file, key;
  std::vector<std::string> set;
  bool json = false;
};

// Input data of all answers.
struct Config {
  core::Diagnostics diagnostics;
  std::string path;
  core::YamlNode root;
  core::YamlHistory history;
  const core::KeyTable* table = nullptr;
  bool behavior = false;
};

const core::KeyTable* table_of(const core::YamlNode& root) {
  const std::string kind = root.is_map() && !root.entries.empty() ? root.entries.front().key : "";
  for (const core::FileTable* file :
       {&behaviors::kBehaviorFile, &model::kRobotFile, &sim::kWorldFile, &lab::kScenarioFile}) {
    if (kind == file->kind) return file->root;
  }
  return nullptr;
}

void load(const ConfigOptions& options, Config& config) {
  const auto settings = split_settings(options.set, config.diagnostics);
  config.path = require_named_file(options.file, config.diagnostics);
  if (config.path.empty()) return;
  config.root =
      core::load_yaml_with_base(config.path, config.diagnostics, &config.history, base_folders());
  if (config.diagnostics.has_errors()) return;
  config.table = table_of(config.root);
  config.behavior = config.table == behaviors::kBehaviorFile.root;
  if (settings.empty()) return;
  if (!config.behavior) {
    config.diagnostics.error({config.diagnostics.add_file("--set"), 0, 0}, "set",
                             "only values of behaviors can be set");
    return;
  }
  const core::YamlNode before = config.root;
  behaviors::apply_settings(config.root, settings, config.diagnostics);
  core::add_differences(before, config.root, config.history);
}

std::string place(const core::Diagnostics& diagnostics, core::Mark mark) {
  if (mark.file < 0) return "";
  const std::string& file = diagnostics.file(mark.file);
  return mark.line > 0 && !file.starts_with("--")
             ? fmt::format("{}:{}:{}", file, mark.line, mark.column)
             : file;
}

const char* verb_of(core::YamlChange::Kind kind) {
  switch (kind) {
    case core::YamlChange::Kind::removed:
      return "removed";
    case core::YamlChange::Kind::appended:
      return "appended to";
    default:
      return "replaces";
  }
}

void print_text(const core::Explanation& explanation, const std::vector<std::string>& made_from,
                const ConfigOptions& options, const core::Diagnostics& diagnostics) {
  constexpr int kPlace = 44;  // column in which positions are printed
  for (const core::ValueOrigin& value : explanation.values) {
    if (value.there) {
      const std::string head = value.path + ": " + core::to_flow_yaml(value.value);
      fmt::print("{:<{}}  {}\n", head, kPlace, place(diagnostics, value.value.mark));
    } else {
      const std::string head = value.path + ": (removed)";
      fmt::print("{:<{}}  {}\n", head, kPlace, place(diagnostics, value.changes.front().mark));
    }
    for (const core::YamlChange& change : value.changes) {
      const std::string head =
          fmt::format("  {} {}", verb_of(change.kind), core::to_flow_yaml(change.old));
      fmt::print("{:<{}}  {}\n", head, kPlace, place(diagnostics, change.old.mark));
    }
  }
  for (const std::string& text : made_from) fmt::print("  in an instance of {}\n", text);
  if (explanation.key == nullptr) return;
  if (explanation.values.empty()) {
    const std::string fallback(explanation.key->fallback);
    fmt::print("{}: not written; {}\n", options.key,
               fallback.empty() ? "there is no default" : "the default is " + fallback);
  }
  fmt::print("  meaning: {}\n", explanation.key->doc);
}

nlohmann::ordered_json mark_json(const core::Diagnostics& diagnostics, core::Mark mark) {
  const std::string file = mark.file < 0 ? "" : diagnostics.file(mark.file);
  return {{"file", file}, {"line", mark.line}, {"column", mark.column}};
}

void print_json(const core::Explanation& explanation, const std::vector<std::string>& made_from,
                const ConfigOptions& options, const core::Diagnostics& diagnostics) {
  nlohmann::ordered_json out = {{"key", options.key}, {"values", nlohmann::ordered_json::array()}};
  for (const core::ValueOrigin& value : explanation.values) {
    nlohmann::ordered_json item = {{"path", value.path}, {"value", nullptr}};
    if (value.there) item["value"] = core::to_flow_yaml(value.value);
    item.update(
        mark_json(diagnostics, value.there ? value.value.mark : value.changes.front().mark));
    item["history"] = nlohmann::ordered_json::array();
    for (const core::YamlChange& change : value.changes) {
      nlohmann::ordered_json old = {{"what", verb_of(change.kind)},
                                    {"value", core::to_flow_yaml(change.old)}};
      old.update(mark_json(diagnostics, change.old.mark));
      item["history"].push_back(std::move(old));
    }
    out["values"].push_back(std::move(item));
  }
  out["templates"] = made_from;
  const bool known = explanation.key != nullptr;
  out["meaning"] = nullptr;
  out["default"] = nullptr;
  if (known) out["meaning"] = std::string(explanation.key->doc);
  if (known && !explanation.key->fallback.empty()) {
    out["default"] = std::string(explanation.key->fallback);
  }
  fmt::print("{}\n", core::json_text(out));
}

// The full path of a key given by its last part only, e.g. `parameters.goal` for `goal`.
std::string whole_path(const core::YamlNode& root, const std::string& key) {
  const std::string head = key.substr(0, key.find('.'));
  for (const core::YamlEntry& section : root.entries) {
    if (section.value.is_map() && section.value.find(head) != nullptr) {
      return section.key + "." + key;
    }
  }
  return {};
}

int explain(const ConfigOptions& options, Config& config) {
  core::Explanation explanation =
      core::explain(config.root, config.history, config.table, options.key);
  std::vector<std::string> made_from;
  if (!explanation.problem.empty() && config.behavior && options.key.starts_with("machine.")) {
    behaviors::LoadOptions load;
    load.search = search_path();
    auto state =
        behaviors::explain_state(config.root, config.path, load, options.key, config.diagnostics);
    if (config.diagnostics.has_errors()) print_diagnostics(config.diagnostics);
    explanation = std::move(state.explanation);
    made_from = std::move(state.made_from);
  }
  if (!explanation.problem.empty()) {
    const std::string whole = whole_path(config.root, options.key);
    if (!whole.empty()) explanation.problem += fmt::format(" (did you mean '{}'?)", whole);
    fmt::print(stderr, "--explain {}: error: {}\n", options.key, explanation.problem);
    return kBadInput;
  }
  (options.json ? print_json : print_text)(explanation, made_from, options, config.diagnostics);
  return kGood;
}

}  // namespace

void add_config_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ConfigOptions>();
  CLI::App* command = app.add_subcommand(
      "config", "Prints a file with its bases and --set applied, or the origin of a value");
  command->add_option("FILE", options->file, "Behavior, world or robot file or name; scenario file")
      ->required();
  auto* explained = command->add_option(
      "--explain", options->key, "A key, with dots: gains.single.swing.kp, machine.states.step");
  command->add_option("--set", options->set, "NAME=VALUE, as in `footfall run`");
  command->add_flag("--json", options->json, "The explanation as one JSON object")
      ->needs(explained);
  command->footer(
      "Example: footfall config examples/high_steps.yaml --explain parameters.lift_time");
  command->callback([options, &exit_code] {
    Config config;
    load(*options, config);
    print_diagnostics(config.diagnostics);
    if (config.diagnostics.has_errors()) {
      exit_code = kBadInput;
    } else if (options->key.empty()) {
      fmt::print("{}", core::to_yaml(config.root));
    } else {
      exit_code = explain(*options, config);
    }
  });
}

}  // namespace footfall::apps
