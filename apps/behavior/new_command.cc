// `footfall new`: creates a behavior or a robot from the shipped scaffolds.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/option_value.h"
#include "core/text/whole_file.h"
#include "core/yaml/value_reader.h"
#include "core/yaml_text/write.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

struct NewOptions {
  std::string kind, name, from, base, robot;
};

// `FOLDER/NAME` in the search path; empty if not found.
std::string find_data(const std::string& path) {
  std::error_code ignored;
  for (const std::string& folder : search_path()) {
    if (fs::exists(fs::path(folder) / path, ignored)) return (fs::path(folder) / path).string();
  }
  return {};
}

void refuse_existing(const fs::path& path) {
  std::error_code ignored;
  if (fs::exists(fs::symlink_status(path, ignored))) {
    throw InputError(fmt::format("{}: exists already; nothing was written", path.string()));
  }
}

// Replaces the scalar under a key of the root; the rest stays, including comments.
std::string with_value(const std::string& text, const char* key, const std::string& value) {
  core::Diagnostics diagnostics;
  const core::YamlNode root = core::load_yaml_text(text, "scaffold", diagnostics);
  const core::YamlNode* node = root.find(key);
  if (node == nullptr || !node->is_scalar() || node->quoted) return text;
  std::size_t line = 0;
  for (int k = 1; k < node->mark.line; ++k) line = text.find('\n', line) + 1;
  std::string out = text;
  return out.replace(line + static_cast<std::size_t>(node->mark.column) - 1, node->scalar.size(),
                     value);
}

std::string stem(const NewOptions& options) {
  std::string name = fs::path(options.name).filename().string();
  if (options.kind == "behavior" && name.ends_with(".yaml")) name.resize(name.size() - 5);
  if (!core::is_name(name)) {
    throw InputError(fmt::format("'{}': expected a name of letters, digits and _, got '{}'",
                                 options.name, name));
  }
  return name;
}

// Throws unless the behavior loads, so that no invalid file is created.
void expect_good_behavior(const std::string& text, const std::string& path) {
  core::Diagnostics diagnostics;
  behaviors::LoadOptions load;
  load.search = search_path();
  behaviors::load_behavior_text(text, path, load, diagnostics);
  if (!diagnostics.has_errors()) return;
  print_diagnostics(diagnostics);
  throw InputError("nothing was written: it would not load there");
}

void write_behavior(const std::string& text, const fs::path& path) {
  expect_good_behavior(text, path.string());
  core::write_whole_file(path.string(), text);
  fmt::print("{} written; now: footfall check {}\n", path.string(), path.string());
}

// The value of `base:` in the new file: a library name unchanged, a file as a relative path.
std::string base_as_written(const NewOptions& options, const fs::path& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(options.base, ignored)) return options.base;
  const fs::path folder = fs::absolute(path).parent_path();
  return fs::absolute(options.base).lexically_normal().lexically_relative(folder).string();
}

// A file with a `base:`, and the values that it could change as comments.
std::string derived_text(const NewOptions& options, const fs::path& path) {
  core::Diagnostics diagnostics;
  const core::YamlNode base =
      core::load_yaml_with_base(find_behavior_file(options.base), diagnostics, nullptr,
                                behaviors::library_folders(search_path()));
  if (diagnostics.has_errors()) {
    core::Diagnostics there;
    print_diagnostics(behavior_is_there(options.base, there) ? diagnostics : there);
    throw InputError("");
  }
  std::string text = fmt::format("base: {}\n", base_as_written(options, path));
  if (!options.robot.empty()) text += fmt::format("robot: {}\n", options.robot);
  text +=
      "# What differs from the base goes here: maps merge by key, everything else is replaced,\n"
      "# `NAME: off` removes, `KEY+:` appends to a list. `footfall config` on this file shows the "
      "result.\n";
  const core::YamlNode* parameters = base.find("parameters");
  if (parameters == nullptr || !parameters->is_map()) return text;
  text += "# parameters:\n";
  for (const core::YamlEntry& entry : parameters->entries) {
    const core::YamlNode* value = entry.value.is_map() ? entry.value.find("value") : &entry.value;
    if (value != nullptr) {
      text += fmt::format("#   {}: {{value: {}}}\n", entry.key, core::to_flow_yaml(*value));
    }
  }
  return text;
}

void new_behavior(const NewOptions& options) {
  const std::string name = stem(options);
  const fs::path path = fs::path(options.name).parent_path() / (name + ".yaml");
  refuse_existing(path);
  if (!options.base.empty()) {
    write_behavior(derived_text(options, path), path);
    return;
  }
  const std::string from = options.from.empty() ? "squat" : options.from;
  std::string source = find_data("behaviors/scaffolds/" + from + ".yaml");
  if (source.empty()) source = find_behavior_file(from);
  std::error_code ignored;
  if (!fs::is_regular_file(source, ignored)) {
    throw InputError(
        fmt::format("--from {}: expected squat, chart, a behavior of the library or a file", from));
  }
  std::string text = core::read_whole_file(source);
  if (!options.robot.empty()) text = with_value(text, "robot", options.robot);
  write_behavior(text, path);
}

// Options of another kind would be ignored in silence.
void refuse_for_robot(const NewOptions& options) {
  const std::pair<const char*, const std::string&> given[] = {
      {"--from", options.from}, {"--base", options.base}, {"--robot", options.robot}};
  for (const auto& [name, value] : given) {
    if (value.empty()) continue;
    throw InputError(
        fmt::format("{}: a robot is made from the scaffold alone; the option is for "
                    "behaviors",
                    name));
  }
}

void new_robot(const NewOptions& options) {
  refuse_for_robot(options);
  const std::string name = stem(options);
  // A name without folder is created where robots are searched.
  const fs::path given(options.name);
  const fs::path folder = given.has_parent_path() ? given : fs::path("robots") / given;
  refuse_existing(folder);
  const fs::path source = find_data("robots/scaffolds/biped");
  if (source.empty())
    throw std::runtime_error("robots/scaffolds/biped: not found; set FOOTFALL_PATH");
  std::string robot = core::read_whole_file((source / "robot.yaml").string());
  std::string body = core::read_whole_file((source / "biped.xml").string());
  robot = with_value(with_value(robot, "name", name), "model", name + ".xml");
  constexpr std::string_view kModel = "model=\"biped\"";
  body.replace(body.find(kModel), kModel.size(), fmt::format("model=\"{}\"", name));
  // Created completely in a temporary folder, then renamed.
  fs::path part = folder;
  part += fmt::format(".{}.part", ::getpid());
  refuse_existing(part);
  fs::create_directories(part);
  core::write_whole_file((part / "robot.yaml").string(), robot);
  core::write_whole_file((part / (name + ".xml")).string(), body);
  fs::rename(part, folder);
  fmt::print("{}/robot.yaml and {}.xml written; now: footfall check {}/robot.yaml\n",
             folder.string(), name, folder.string());
}

int make(const NewOptions& options) {
  (options.kind == "behavior" ? new_behavior : new_robot)(options);
  return kGood;
}

}  // namespace

void add_new_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<NewOptions>();
  CLI::App* command = app.add_subcommand(
      "new", "Creates a small behavior or robot that runs; never replaces a file");
  command->add_option("KIND", options->kind, "behavior or robot")
      ->required()
      ->check(one_of({"behavior", "robot"}));
  command
      ->add_option(
          "NAME", options->name,
          "behavior: writes NAME.yaml; robot: writes robots/NAME/ (with a folder in NAME: there)")
      ->required();
  auto* from =
      command->add_option("--from", options->from,
                          "behavior: squat (default), chart, or a behavior's file or name to copy");
  command
      ->add_option("--base", options->base,
                   "behavior: a behavior's file or name to derive from, by `base:`")
      ->excludes(from);
  command->add_option("--robot", options->robot, "behavior: its robot (default hume)");
  command->footer(
      "Example: footfall new behavior my_squat\nExample: footfall new behavior my_walk --base "
      "balance_best\nExample: footfall new robot my_biped");
  command->callback([options, &exit_code] {
    exit_code = guarded([&] { return make(*options); }, kMachineFailed);
  });
}

}  // namespace footfall::apps
