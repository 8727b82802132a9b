// `footfall signals`: lists the names available to expressions, logs and reports of a behavior, and
// its parameters and gains.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "apps/shared/commands.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/units/units.h"
#include "core/yaml/glob.h"

namespace footfall::apps {
namespace {

struct ListedName {
  std::string name, unit, text;
};

// `[0, 0]`, or a single number.
std::string values_of(const behaviors::Behavior& behavior, const behaviors::ParameterInfo& info) {
  const auto first = behavior.values.begin() + info.slot;
  const std::vector<double> values(first, first + info.size);
  return info.size == 1 ? fmt::format("{:g}", values[0])
                        : fmt::format("[{:g}]", fmt::join(values, ", "));
}

// A parameter by its name in expressions, a gain by its path.
ListedName row_of(const behaviors::Behavior& behavior, const behaviors::ParameterInfo& info) {
  ListedName row{info.gain ? info.name : "$" + info.name, core::unit_text(info.dimension), {}};
  row.text = fmt::format("{} {}",
                         info.of_estimator() ? "estimator's parameter"
                         : info.gain         ? "gain"
                         : info.variable     ? "variable"
                                             : "parameter",
                         values_of(behavior, info));
  if (info.has_range()) row.text += fmt::format(", range {:g} to {:g}", info.min, info.max);
  if (info.live) row.text += ", live";
  if (!info.doc.empty()) row.text += ": " + info.doc;
  return row;
}

std::vector<ListedName> rows_of(const behaviors::Behavior& behavior) {
  std::vector<ListedName> rows;
  for (const core::SignalInfo& info : behavior.signals.infos()) {
    rows.push_back({info.name, core::unit_text(info.dimension), info.doc});
  }
  for (const behaviors::ParameterInfo& info : behavior.parameters) {
    rows.push_back(row_of(behavior, info));
  }
  return rows;
}

bool is_wanted(const ListedName& row, const std::string& filter) {
  if (!core::is_glob(filter)) return row.name.find(filter) != std::string::npos;
  const std::string_view name = row.name;
  return core::glob_matches(filter, name) ||
         (name.starts_with("$") && core::glob_matches(filter, name.substr(1)));
}

int list(const std::string& file, const std::string& filter) {
  const auto behavior = load_or_explain(file, "", {});
  if (!behavior) return kBadInput;
  const std::vector<ListedName> rows = rows_of(*behavior);
  std::vector<std::string> names;
  bool any = false;
  for (const ListedName& row : rows) {
    names.push_back(row.name);
    if (!filter.empty() && !is_wanted(row, filter)) continue;
    any = true;
    fmt::print("{:<40} {:<10} {}\n", row.name, row.unit, row.text);
  }
  if (any) return kGood;
  fmt::print(stderr, "error: no signal, parameter or gain of '{}' matches '{}'{}\n", file, filter,
             core::did_you_mean(filter, names));
  return kBadInput;
}

}  // namespace

void add_signals_command(CLI::App& app, int& exit_code) {
  struct Options {
    std::string file, filter;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "signals", "Lists every signal of a behavior, its parameters and gains, with units");
  command->add_option("BEHAVIOR", options->file, "Behavior file or name")->required();
  command->add_option("FILTER", options->filter,
                      "Only names that contain this, or match it with * and ?");
  command->footer("Example: footfall signals balance \"gains.*.kp\"");
  command->callback([options, &exit_code] { exit_code = list(options->file, options->filter); });
}

}  // namespace footfall::apps
