// `footfall graph`: the state diagram of a behavior.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/external_program.h"
#include "apps/shared/option_value.h"
#include "apps/shared/output_option.h"
#include "behaviors/explain/diagram.h"
#include "core/process/machine_error.h"
#include "core/text/whole_file.h"

namespace footfall::apps {
namespace {

struct GraphOptions {
  std::string file, out, format;
  std::vector<std::string> expand;
};

// The format given by option, else by the file's extension, else SVG.
std::string format_of(const GraphOptions& options) {
  if (!options.format.empty()) return options.format;
  if (options.out.ends_with(".dot") || options.out.ends_with(".gv")) return "dot";
  if (options.out.ends_with(".mmd")) return "mermaid";
  if (options.out.empty() || options.out.ends_with(".svg")) return "svg";
  return {};
}

int graph(const GraphOptions& options) {
  const std::string format = format_of(options);
  if (format.empty()) {
    fmt::print(stderr, "{}: error: expected an ending .svg, .dot or .mmd, or --format\n",
               options.out);
    return kBadInput;
  }
  core::Diagnostics diagnostics;
  behaviors::LoadOptions load;
  load.search = search_path();
  if (!behavior_is_there(options.file, diagnostics)) {
    print_diagnostics(diagnostics);
    return kBadInput;
  }
  require_no_input("-o", options.out, {find_behavior_file(options.file)});
  auto diagram = behaviors::load_diagram(find_behavior_file(options.file), load, diagnostics);
  print_diagnostics(diagnostics);
  if (!diagram) return kBadInput;
  if (!options.expand.empty()) {
    std::string why;
    diagram = behaviors::close_states(*diagram, options.expand, why);
    if (!diagram) {
      fmt::print(stderr, "--expand: error: {}\n", why);
      return kBadInput;
    }
  }
  try {
    std::string text = format == "mermaid" ? to_mermaid(*diagram) : to_dot(*diagram);
    if (format == "svg") text = run_program("dot", "-Tsvg", text, "graphviz");
    if (options.out.empty() || options.out == "-") {
      std::fwrite(text.data(), 1, text.size(), stdout);
    } else {
      core::write_whole_file(options.out, text);
    }
  } catch (const core::MachineError& error) {
    const bool no_picture = format == "svg";
    throw core::MachineError(
        fmt::format("{}{}", error.what(),
                    no_picture ? "; --format dot and mermaid need no other program" : ""));
  }
  return kGood;
}

}  // namespace

void add_graph_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<GraphOptions>();
  CLI::App* command =
      app.add_subcommand("graph", "Draws the state diagram as SVG, Graphviz DOT or Mermaid");
  command->add_option("FILE", options->file, "Behavior file or name")->required();
  command->add_option("-o,--output", options->out,
                      "The picture, .svg, .dot or .mmd (default: stdout)");
  command->add_option("--format", options->format, "svg (needs Graphviz), dot or mermaid")
      ->check(one_of({"svg", "dot", "mermaid"}));
  command
      ->add_option("--expand", options->expand,
                   "Draws only this state with its content (may be repeated)")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  command->footer("Example: footfall graph balance -o balance.svg");
  command->callback([options, &exit_code] { exit_code = graph(*options); });
}

}  // namespace footfall::apps
