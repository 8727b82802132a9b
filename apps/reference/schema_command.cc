// `footfall schema`: a JSON Schema of each file kind, for editors. `footfall reference`: the same
// tables as Markdown.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/reference/json_schema.h"
#include "apps/reference/reference.h"
#include "apps/shared/commands.h"
#include "apps/shared/option_value.h"
#include "behaviors/language/language.h"
#include "core/text/json_text.h"
#include "lab/scenario/keys.h"
#include "lab/sweep/plan/keys.h"
#include "model/robot/keys.h"
#include "sim/world/keys.h"

namespace footfall::apps {

std::vector<const core::FileTable*> file_tables() {
  return {&behaviors::kBehaviorFile, &model::kRobotFile, &sim::kWorldFile, &lab::kScenarioFile,
          &lab::kSweepFile};
}

void add_schema_command(CLI::App& app, int& exit_code) {
  std::vector<std::string> kinds;
  for (const core::FileTable* file : file_tables()) kinds.emplace_back(file->kind);
  auto kind = std::make_shared<std::string>(kinds.front());
  CLI::App* command =
      app.add_subcommand("schema", "Prints the JSON Schema of a kind of file, for editors");
  command->add_option("KIND", *kind, fmt::format("One of {}", fmt::join(kinds, ", ")))
      ->check(one_of(kinds));
  command->footer("Example: footfall schema behavior > behavior.schema.json   (docs/editor.md)");
  command->callback([kind, &exit_code] {
    for (const core::FileTable* file : file_tables()) {
      if (file->kind == *kind) fmt::print("{}\n", core::json_text(json_schema(*file), 2));
    }
    exit_code = kGood;
  });
}

void add_reference_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("reference", "Prints every key, word, signal and event as Markdown");
  command->footer("Example: footfall reference > docs/reference.md");
  command->callback([&exit_code] {
    fmt::print("{}", reference_markdown());
    exit_code = kGood;
  });
}

}  // namespace footfall::apps
