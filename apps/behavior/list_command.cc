// `footfall list`: what can be named without a path.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/shared/commands.h"
#include "apps/shared/option_value.h"
#include "core/text/search_folders.h"
#include "core/yaml/yaml.h"

namespace footfall::apps {
namespace {

struct NamedKind {
  const char* name;
  const char* place;   // below a folder of the search path
  const char* inside;  // the file in a folder of that name; empty: NAME.yaml itself
};
constexpr NamedKind kNamedKinds[] = {{"behaviors", "behaviors/library", ""},
                                     {"worlds", "sim/worlds", ""},
                                     {"robots", "robots", "robot.yaml"}};

// The first sentence of the file's `doc:`; empty without one.
std::string doc_of(const NamedKind& kind, const std::string& name) {
  for (const std::string& folder : search_path()) {
    core::Diagnostics ignored;
    const std::string stem = fmt::format("{}/{}/{}", folder, kind.place, name);
    const core::YamlNode root = core::load_yaml_file(
        *kind.inside == '\0' ? stem + ".yaml" : stem + "/" + kind.inside, ignored);
    if (ignored.has_errors()) continue;
    const core::YamlNode* const doc = root.find("doc");
    return doc == nullptr ? "" : doc->scalar.substr(0, doc->scalar.find_first_of("\n"));
  }
  return {};
}

int list(const std::string& only) {
  for (const NamedKind& kind : kNamedKinds) {
    if (!only.empty() && only != kind.name) continue;
    if (only.empty()) fmt::print("{}:\n", kind.name);
    for (const std::string& name : core::names_in(search_path(), kind.place, kind.inside)) {
      const std::string doc = doc_of(kind, name);
      fmt::print("{}{}\n", only.empty() ? "  " : "",
                 doc.empty() ? name : fmt::format("{:<22} {}", name, doc));
    }
  }
  return kGood;
}

}  // namespace

void add_list_command(CLI::App& app, int& exit_code) {
  auto kind = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "list", "Lists behaviors, worlds and robots that can be named without a path");
  command->add_option("KIND", *kind, "behaviors, worlds or robots; all of them without")
      ->check(one_of({"behaviors", "worlds", "robots"}));
  command->footer("Example: footfall list worlds");
  command->callback([kind, &exit_code] { exit_code = guarded([&] { return list(*kind); }); });
}

}  // namespace footfall::apps
