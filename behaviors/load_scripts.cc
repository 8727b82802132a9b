// `scripts`: files of Lua, read and run once at load, so that their mistakes and the names of their
// functions are known before anything moves.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "behaviors/language.h"
#include "behaviors/load_context.h"
#include "behaviors/script.h"

namespace footfall::behaviors {
namespace {

constexpr std::uintmax_t kLargestScript = 1024 * 1024;  // bytes

// The file beside the one in which it is named.
std::string script_path(const LoadContext& context, const core::YamlNode& node) {
  const std::filesystem::path beside =
      node.mark.file < 0 ? "" : context.diagnostics.file(node.mark.file);
  return (beside.parent_path() / node.scalar).string();
}

void read_script(LoadContext& context, const core::YamlNode& node) {
  const auto name = core::read_text(node, context.diagnostics, "the name of a Lua file");
  if (!name) return;
  const std::string path = script_path(context, node);
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    context.error(node.mark, "no-script", fmt::format("cannot read '{}': no such file", path));
    return;
  }
  if (std::filesystem::file_size(path, error) > kLargestScript) {
    context.error(node.mark, "no-script", fmt::format("'{}' is larger than 1 MiB", path));
    return;
  }
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file) {
    context.error(node.mark, "no-script", fmt::format("cannot read '{}'", path));
    return;
  }
  context.behavior.scripts.push_back({path, std::move(text)});
}

void read_files(LoadContext& context, const core::YamlNode& node) {
  if (!node.is_sequence()) {
    read_script(context, node);
    return;
  }
  for (const core::YamlNode& item : node.items) read_script(context, item);
}

// `FILE`, `[FILES]`, or `{files: ..., instructions: N}`.
void read_section(LoadContext& context, const core::YamlNode& node) {
  if (!node.is_map()) {
    read_files(context, node);
    return;
  }
  core::check_keys(node, kScriptsKeys, context.diagnostics);
  if (const auto* files = core::require_key(node, "files", context.diagnostics)) {
    read_files(context, *files);
  }
  if (const auto* instructions = node.find("instructions")) {
    context.behavior.script_instructions =
        core::read_integer(*instructions, 1000, 1'000'000'000'000, context.diagnostics).value_or(0);
  }
}

}  // namespace

void load_scripts(LoadContext& context) {
  const core::YamlNode* section = context.section("scripts");
  if (section == nullptr) return;
  read_section(context, *section);
  ScriptSettings settings;
  if (context.behavior.script_instructions > 0) {
    settings.instructions = context.behavior.script_instructions;
  }
  Script script(settings);
  for (const ScriptFile& file : context.behavior.scripts) {
    ScriptError problem;
    if (script.load(file.text, problem)) continue;
    const int index = context.diagnostics.add_file(file.path);
    context.error({index, problem.line, problem.line > 0 ? 1 : 0}, "script", problem.text);
  }
  context.script_functions = script.functions();
  context.script_patterns = script.patterns();
}

}  // namespace footfall::behaviors
