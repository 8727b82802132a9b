// `footfall set`: writes new values of a behavior's parameters and gains to its files, in place.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <optional>

#include "apps/shared/commands.h"
#include "apps/shared/save_dialog.h"
#include "behaviors/loader.h"
#include "behaviors/save/values.h"
#include "core/units/units.h"
#include "core/yaml/flow_traps.h"
#include "core/yaml/value_reader.h"
#include "core/yaml/yaml.h"

namespace footfall::apps {
namespace {

struct SetOptions {
  std::string file, robot, to;
  std::vector<std::string> settings;
  bool into_base = false, dry_run = false, yes = false;
};

// One number of a value in SI; bare numbers are SI.
std::optional<double> read_number(const core::YamlNode& node, const behaviors::ParameterInfo& info,
                                  core::Diagnostics& diagnostics) {
  return info.bare ? core::read_quantity(node, core::kNone, diagnostics)
                   : core::read_quantity(node, info.dimension, diagnostics);
}

// Converts NAME=VALUE for plan_save(): a list, or one number for all values of NAME.
std::optional<behaviors::NamedValue> read_setting(const behaviors::Behavior& behavior,
                                                  const std::string& name, const std::string& text,
                                                  core::Diagnostics& diagnostics) {
  if (text.find_first_not_of(" \t") == std::string::npos) {
    diagnostics.error({}, "expected", fmt::format("{}: expected a value after '='", name));
    return std::nullopt;
  }
  const core::YamlNode node = core::load_yaml_text(text, name, diagnostics);
  const behaviors::ParameterPart part = behavior.find_parameter_part(name);
  behaviors::NamedValue value{name, {}};
  if (part.parameter < 0 || node.is_null()) return value;  // plan_save() reports the reason
  const auto& info = behavior.parameters[static_cast<std::size_t>(part.parameter)];
  const std::size_t size = part.component < 0 ? static_cast<std::size_t>(info.size) : 1;
  if (size > 1 && !node.is_sequence() && !info.gain) {
    diagnostics.error(
        node.mark, "expected",
        fmt::format("expected {} values, \"{}=[...]\", or one by its name, {}={}; one "
                    "number for all is for gains",
                    size, name, value_name(info, 0), text));
    return std::nullopt;
  }
  const std::vector<core::YamlNode> items =
      node.is_sequence() ? node.items : std::vector<core::YamlNode>(size, node);
  if (items.size() != size) {
    diagnostics.error(node.mark, "expected",
                      fmt::format("expected {} values, or one for all, got {}{}", size,
                                  items.size(), core::comma_hint(node)));
    return std::nullopt;
  }
  for (const core::YamlNode& item : items) {
    const auto number = read_number(item, info, diagnostics);
    if (!number) return std::nullopt;
    value.values.push_back(*number);
  }
  return value;
}

int set_values(const SetOptions& options) {
  core::Diagnostics diagnostics;
  behaviors::LoadOptions load;
  load.search = search_path();
  load.robot = options.robot;
  const auto settings = split_settings(options.settings, diagnostics);
  const std::string path = find_behavior_file(options.file);
  std::vector<behaviors::NamedValue> values;
  core::Diagnostics problems;
  const auto behavior = behaviors::load_behavior(path, load, problems);
  if (behavior == nullptr) {
    print_diagnostics(problems);
    return kBadInput;
  }
  for (const auto& [name, text] : settings) {
    if (auto value = read_setting(*behavior, name, text, diagnostics)) {
      values.push_back(std::move(*value));
    }
  }
  print_diagnostics(diagnostics);
  if (diagnostics.has_errors()) return kBadInput;
  const behaviors::SaveTarget target{options.to, options.into_base, installed_folders()};
  const auto plan = behaviors::plan_save(path, load, values, target, diagnostics);
  print_diagnostics(diagnostics);
  for (const std::string& reason : plan.refusals) fmt::print(stderr, "error: {}\n", reason);
  if (plan.refused()) return plan.unwritable ? kMachineFailed : kBadInput;
  return show_and_write(plan, options.to.empty() ? options.file : options.to, options.dry_run,
                        options.yes);
}

}  // namespace

void add_set_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<SetOptions>();
  CLI::App* command = app.add_subcommand(
      "set", "Writes values of parameters and gains to a behavior's file; the rest is unchanged");
  command->add_option("FILE", options->file, "Behavior file, or its name in the library")
      ->required();
  command
      ->add_option("NAME=VALUE", options->settings,
                   "Parameters and gains, values as in YAML: lift_time=160ms, goal.x=1m")
      ->required();
  auto* to = command->add_option(
      "--to", options->to, "Writes to this overlay, a new or existing file with FILE as base");
  command
      ->add_flag("--into-base", options->into_base,
                 "Writes each value where it is defined, also into a base of FILE")
      ->excludes(to);
  command->add_option("--robot", options->robot, "Robot, instead of the file's");
  auto* dry = command->add_flag("--dry-run", options->dry_run, "Shows the diff, writes nothing");
  command->add_flag("--yes", options->yes, "Writes without asking")->excludes(dry);
  command->footer("Example: footfall set balance lift_time=160ms --to my_balance.yaml");
  command->callback(
      [options, &exit_code] { exit_code = guarded([&] { return set_values(*options); }); });
}

}  // namespace footfall::apps
