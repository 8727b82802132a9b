// `footfall fmt`: the canonical layout of YAML files; keeps comments.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "core/text/whole_file.h"
#include "core/yaml_text/format.h"

namespace footfall::apps {
namespace {

struct FmtOptions {
  std::vector<std::string> files;
  bool check = false, to_stdout = false;
};

// The formatted text; nullopt on failure, with the reason on stderr and an exit code.
std::optional<std::string> format_text(const std::string& name, const std::string& text,
                                       int& exit_code) {
  core::Diagnostics diagnostics;
  const core::YamlNode before = core::load_yaml_text(text, name, diagnostics);
  print_diagnostics(diagnostics);
  if (diagnostics.has_errors()) {
    exit_code = kBadInput;
    return std::nullopt;
  }
  auto formatted = core::format_yaml(text);
  core::Diagnostics problems;
  const bool same =
      formatted && core::same_values(before, core::load_yaml_text(*formatted, name, problems));
  if (same && !problems.has_errors() && core::format_yaml(*formatted) == formatted)
    return formatted;
  // Never change the meaning: leave the file unformatted.
  fmt::print(stderr, "{}: error: cannot be formatted without a change of meaning; unchanged\n",
             name);
  exit_code = kMachineFailed;
  return std::nullopt;
}

int format_file(const std::string& file, const FmtOptions& options) {
  int exit_code = kGood;
  const std::string text = core::read_whole_file(file);
  const auto formatted = format_text(file == "-" ? "stdin" : file, text, exit_code);
  if (!formatted) return exit_code;
  if (options.check) {
    if (*formatted == text) return kGood;
    fmt::print("{}: would change\n", file);
    return kRobotFailed;
  }
  if (options.to_stdout || file == "-") {
    std::fwrite(formatted->data(), 1, formatted->size(), stdout);
  } else if (*formatted != text) {
    core::write_whole_file(file, *formatted);
    fmt::print("{}: formatted\n", file);
  }
  return kGood;
}

}  // namespace

void add_fmt_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<FmtOptions>();
  CLI::App* command =
      app.add_subcommand("fmt", "Formats YAML files in the canonical layout; keeps comments");
  command->add_option("FILE", options->files, "YAML files, - for stdin to stdout")->required();
  auto* check = command->add_flag("--check", options->check,
                                  "Writes nothing; exit 1 and their names if files would change");
  command->add_flag("--stdout", options->to_stdout, "Writes to stdout instead of the file")
      ->excludes(check);
  command->footer("Example: footfall fmt --check behaviors/library/balance.yaml");
  command->callback([options, &exit_code] {
    exit_code = kGood;
    for (const std::string& file : options->files) {
      exit_code = std::max(exit_code, guarded([&] { return format_file(file, *options); }));
    }
  });
}

}  // namespace footfall::apps
