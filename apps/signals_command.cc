// `footfall signals`: every name that expressions, logs and reports of a behavior know.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/commands.h"
#include "core/units.h"

namespace footfall::apps {

void add_signals_command(CLI::App& app, int& exit_code) {
  auto file = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("signals", "Lists every signal of a behavior with unit and meaning");
  command->add_option("BEHAVIOR", *file, "Behavior file or name")->required();
  command->footer("Example: footfall signals balance");
  command->callback([file, &exit_code] {
    const auto behavior = load_or_explain(*file, "", {});
    exit_code = behavior ? kGood : kBadInput;
    if (!behavior) return;
    for (const core::SignalInfo& info : behavior->signals.infos()) {
      fmt::print("{:<40} {:<10} {}\n", info.name, core::unit_text(info.dimension), info.doc);
    }
  });
}

}  // namespace footfall::apps
