// `scripts`: Lua files, read and run once at load, so that errors and function names are known
// before the robot moves.
#include "behaviors/load/chart/scripts.h"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "behaviors/language/language.h"
#include "behaviors/load/chart/steps.h"
#include "behaviors/load/context.h"
#include "behaviors/script/watched.h"

namespace footfall::behaviors {
namespace {

constexpr std::uintmax_t kLargestScript = 1024 * 1024;  // bytes

// Path relative to the file that names the script.
std::string script_path(const core::YamlNode& node, const core::Diagnostics& diagnostics) {
  const std::filesystem::path beside = node.mark.file < 0 ? "" : diagnostics.file(node.mark.file);
  return (beside.parent_path() / node.scalar).string();
}

void read_script(const core::YamlNode& node, core::Diagnostics& diagnostics,
                 std::vector<ScriptFile>& files) {
  const auto name = core::read_text(node, diagnostics, "the name of a Lua file");
  if (!name) return;
  const std::string path = script_path(node, diagnostics);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    diagnostics.error(node.mark, "no-script", fmt::format("cannot read '{}': no such file", path));
    return;
  }
  if (std::filesystem::file_size(path, error) > kLargestScript) {
    diagnostics.error(node.mark, "no-script", fmt::format("'{}' is larger than 1 MiB", path));
    return;
  }
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    diagnostics.error(node.mark, "no-script", fmt::format("cannot read '{}'", path));
    return;
  }
  files.push_back({path, std::move(text)});
}

// `FILE`, `[FILES]`, or `{files: ..., instructions: N}`.
void read_section(LoadContext& context, const core::YamlNode& node) {
  if (!node.is_map()) {
    context.behavior.scripts = read_script_files(node, context.diagnostics);
    return;
  }
  core::check_keys(node, kScriptsKeys, context.diagnostics);
  if (const auto* files = core::require_key(node, "files", context.diagnostics)) {
    context.behavior.scripts = read_script_files(*files, context.diagnostics);
  }
  if (const auto* instructions = node.find("instructions")) {
    if (const auto read =
            core::read_integer(*instructions, 1000, 1'000'000'000'000, context.diagnostics)) {
      context.behavior.script_limits.instructions = *read;
    }
  }
  if (const auto* deadline = node.find("deadline")) {
    const auto read = core::read_quantity(*deadline, core::kTime, context.diagnostics);
    if (read && !(*read > 0.0)) {
      context.diagnostics.error(deadline->mark, "out-of-range", "expected a time above 0 s");
    }
    context.behavior.script_limits.deadline = read.value_or(0.0);
  }
}

}  // namespace

std::vector<ScriptFile> read_script_files(const core::YamlNode& node,
                                          core::Diagnostics& diagnostics) {
  std::vector<ScriptFile> files;
  if (!node.is_sequence()) read_script(node, diagnostics, files);
  for (const core::YamlNode& item : node.items) read_script(item, diagnostics, files);
  return files;
}

void run_script_files(const std::vector<ScriptFile>& files, const std::shared_ptr<Script>& script,
                      core::Diagnostics& diagnostics) {
  for (const ScriptFile& file : files) {
    ScriptError problem;
    if (load_watched(script, file.text, problem,
                     std::filesystem::path(file.path).filename().string()))
      continue;
    const int index = diagnostics.add_file(file.path);
    diagnostics.error({index, problem.line, problem.line > 0 ? 1 : 0}, "script", problem.text);
  }
}

void load_scripts(LoadContext& context) {
  const core::YamlNode* section = context.section("scripts");
  if (section == nullptr) return;
  read_section(context, *section);
  ScriptSettings settings;
  settings.limits = context.behavior.script_limits;
  const auto script = std::make_shared<Script>(settings);
  const int errors_before = context.diagnostics.error_count();
  run_script_files(context.behavior.scripts, script, context.diagnostics);
  context.scripts_failed = context.diagnostics.error_count() > errors_before;
  if (script->stopped()) return;
  context.script_functions = script->functions();
  context.script_patterns = script->patterns();
}

}  // namespace footfall::behaviors
