// `footfall runs`: lists the runs of a folder, finds one's report, removes old ones.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/shared/commands.h"
#include "apps/shared/option_value.h"
#include "apps/shared/save_dialog.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/json_text.h"
#include "core/text/printable.h"
#include "core/text/whole_file.h"
#include "lab/run/run_folder.h"

namespace footfall::apps {
namespace {

namespace fs = std::filesystem;

struct RunsOptions {
  std::string folder = lab::kRunsFolder;
  std::string run;  // `open`
  int keep = 20;    // `prune`
  bool json = false, yes = false;
};

// What summary.json says; null for a run that was killed or still goes on.
nlohmann::json summary_of(const std::string& folder) {
  std::string problem;
  const auto text = core::read_file(folder + "/summary.json", std::string::npos, problem);
  if (!text) return nullptr;
  try {
    return core::parse_json(*text);
  } catch (const std::exception&) {
    return nullptr;
  }
}

std::string text_at(const nlohmann::json& json, const char* key, const char* otherwise) {
  const bool there = json.is_object() && json.contains(key) && json[key].is_string();
  return there ? core::on_one_line(json[key].get<std::string>()) : otherwise;
}

int list(const RunsOptions& options) {
  const auto names = lab::run_names(options.folder);
  if (names.empty() && !options.json) fmt::print("no runs in {}\n", options.folder);
  for (const std::string& name : names) {
    const std::string folder = options.folder + "/" + name;
    const nlohmann::json summary = summary_of(folder);
    const std::string end = lab::is_in_use(folder) ? "running" : text_at(summary, "end", "cut off");
    if (options.json) {
      const nlohmann::ordered_json row = {{"run", name},
                                          {"end", end},
                                          {"folder", folder},
                                          {"behavior", text_at(summary, "behavior", "")},
                                          {"world", text_at(summary, "world", "")}};
      fmt::print("{}\n", core::json_text(row));
    } else {
      fmt::print("{:<44} {:<10} {:<12} {}\n", name, end, text_at(summary, "world", "-"),
                 text_at(summary, "behavior", "-"));
    }
  }
  return kGood;
}

int open_run(const RunsOptions& options) {
  std::string folder = lab::newest_run(options.folder);
  if (!options.run.empty()) {
    const auto names = lab::run_names(options.folder);
    if (std::ranges::find(names, options.run) == names.end()) {
      throw InputError(fmt::format("error: no run '{}' in {}{}", options.run, options.folder,
                                   core::did_you_mean(options.run, names)));
    }
    folder = options.folder + "/" + options.run;
  }
  std::error_code ignored;
  const std::string report = folder + "/report.html";
  if (!fs::is_regular_file(report, ignored)) {
    throw InputError(
        fmt::format("error: no report in {}; footfall report {} makes it", folder, folder));
  }
  fmt::print("{}\n", fs::absolute(report).lexically_normal().string());
  return kGood;
}

int prune(const RunsOptions& options) {
  std::vector<std::string> old;
  auto names = lab::run_names(options.folder);
  const auto kept = std::min(names.size(), static_cast<std::size_t>(options.keep));
  names.resize(names.size() - kept);
  for (const std::string& name : names) {
    const std::string folder = options.folder + "/" + name;
    if (!lab::is_in_use(folder)) old.push_back(folder);
  }
  for (const std::string& folder : old) fmt::print("{}\n", folder);
  if (old.empty()) return kGood;
  if (!options.yes && !confirmed("Remove them?")) return kGood;
  for (const std::string& folder : old) fs::remove_all(folder);
  lab::mend_latest(options.folder);
  return kGood;
}

}  // namespace

void add_runs_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RunsOptions>();
  CLI::App* command =
      app.add_subcommand("runs", "Lists the runs in out/run, finds a report, removes old runs");
  const auto add = [&](const char* name, const char* what, int (*work)(const RunsOptions&)) {
    CLI::App* action = command->add_subcommand(name, what);
    action->add_option("--in", options->folder, "Folder of runs")->capture_default_str();
    action->callback(
        [options, work, &exit_code] { exit_code = guarded([&] { return work(*options); }); });
    return action;
  };
  add("list", "One line a run, oldest first: folder, end, world, behavior", list)
      ->add_flag("--json", options->json, "One JSON object a line");
  add("open", "Prints where the report of a run is", open_run)
      ->add_option("RUN", options->run, "Its folder's name; the newest run without");
  CLI::App* pruning = add("prune", "Removes old runs, newest kept; asks before", prune);
  pruning->add_option("--keep", options->keep, "How many stay")
      ->check(at_least(0, "a whole number from 0 on"))
      ->capture_default_str();
  pruning->add_flag("--yes", options->yes, "Removes without asking");
  command->require_subcommand(1);
  command->footer("Example: footfall runs list\nExample: xdg-open $(footfall runs open)");
}

}  // namespace footfall::apps
