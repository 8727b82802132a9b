// `footfall replay` and `footfall diff`: repeats a run from its log, and compares two logs.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <deque>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/log_argument.h"
#include "apps/shared/time_option.h"
#include "behaviors/language/language.h"
#include "core/diagnostics/did_you_mean.h"
#include "core/text/json_text.h"
#include "engine/tick/control_loop.h"
#include "lab/log/diff.h"
#include "lab/replay/estimation.h"
#include "lab/replay/replay.h"
#include "lab/run/log_setup.h"
#include "lab/run/reload.h"

namespace footfall::apps {
namespace {

struct ReplayArguments {
  std::string log, behavior, estimator;
  std::vector<std::string> set;
  std::string from = "2s";
  bool verify = false, json = false;
};

double from_of(const ReplayArguments& arguments) {
  double from = 0.0;
  try {
    from = read_time(arguments.from, "--from");
  } catch (const std::runtime_error& problem) {
    throw InputError(problem.what());
  }
  if (from >= 0.0) return from;
  throw InputError(fmt::format("--from: error: expected 0 s or later, got '{}'", arguments.from));
}

void print_lines(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) fmt::print("  {}\n", line);
}

// `name`: name of a reload, empty for the log at the beginning of the run.
int verify(const std::string& name, const lab::Log& log, lab::Replay& replay) {
  if (!name.empty()) fmt::print("{}: ", name);
  const lab::ReplayReport report = lab::verify_replay(log, replay);
  if (!report.parameters.empty()) {
    fmt::print("parameters that are not as logged:\n");
    print_lines(report.parameters);
  }
  if (report.differs_at < 0 && report.parameters.empty()) {
    const bool whole = log.inputs.after_gap == 0;
    fmt::print("identical: {} ticks{}\n", report.ticks, whole ? "" : ", up to a gap in the log");
    return whole ? kGood : kRobotFailed;
  }
  if (report.differs_at < 0) {
    fmt::print("no signal differs in {} ticks\n", report.ticks);
    return kRobotFailed;
  }
  fmt::print("first difference: tick {}, {:.6f} s, in {}\n", report.differs_at, report.time,
             report.state);
  if (report.lines.empty()) {
    fmt::print("  a signal, by less than the precision of logged values\n");
  } else if (report.visible_at != report.differs_at) {
    fmt::print("  by less than the precision of logged values; at tick {}:\n", report.visible_at);
  }
  print_lines(report.lines);
  return kRobotFailed;
}

int replay_one(const std::string& name, const lab::Log& log, lab::Replay& replay, bool compare) {
  if (compare) return verify(name, log, replay);
  while (replay.next() < replay.end()) replay.tick({});
  return kGood;
}

int run_estimator(const ReplayArguments& arguments) {
  const std::vector<std::string> known = core::word_names(behaviors::kEstimatorTypes);
  if (std::ranges::find(known, arguments.estimator) == known.end()) {
    throw InputError(fmt::format("--estimator: error: expected {}, got '{}'{}",
                                 fmt::join(known, ", "), arguments.estimator,
                                 core::did_you_mean(arguments.estimator, known)));
  }
  lab::EstimatorTrial trial{arguments.estimator, {}, from_of(arguments)};
  for (const std::string& item : arguments.set) {
    const std::size_t sign = item.find('=');
    if (sign == std::string::npos || sign == 0) {
      throw InputError(fmt::format("--set {}: error: expected estimator.NAME=VALUE", item));
    }
    if (item.substr(0, sign) == "estimator.type") {
      throw InputError(fmt::format("--set {}: error: --estimator names the type", item));
    }
    const std::string name = item.substr(0, sign), value = item.substr(sign + 1);
    for (const auto& [before, other] : trial.set) {
      if (before != name) continue;
      throw InputError(
          fmt::format("--set: error: '{}' is set twice, to '{}' and to '{}': expected "
                      "one of them",
                      name, other, value));
    }
    trial.set.emplace_back(name, value);
  }
  const lab::Log log = read_whole_log(arguments.log);
  try {
    const lab::EstimationFigures figures = lab::replay_estimator(log, trial);
    if (arguments.json) {
      fmt::print("{}\n", core::json_text(lab::estimation_json(figures)));
    } else {
      fmt::print("{}", lab::estimation_text(figures));
    }
  } catch (const std::runtime_error& problem) {
    throw InputError(problem.what());
  }
  return kGood;
}

int run_replay(const ReplayArguments& arguments) {
  if (!arguments.estimator.empty()) return run_estimator(arguments);
  const lab::Log log = read_whole_log(arguments.log);
  const std::string file = arguments.behavior.empty() ? "" : find_behavior_file(arguments.behavior);
  lab::Replay replay(log, file);
  if (log.get("build") != lab::build_id()) {
    std::fputs("warning: the log is another build's; results may differ in the last digits\n",
               stderr);
  }
  int code = replay_one("", log, replay, arguments.verify);
  const std::string folder = std::filesystem::path(log.path).parent_path().string();
  std::deque<lab::Log> reloads;
  for (int k = 1; code == kGood && file.empty(); ++k) {
    const std::string path = lab::reload_log(folder.empty() ? "." : folder, k);
    if (!std::filesystem::exists(path)) break;
    reloads.push_back(read_whole_log(path));
    replay.go_on(reloads.back());
    code = replay_one(fmt::format("reload-{}", k), reloads.back(), replay, arguments.verify);
  }
  if (arguments.verify) return code;
  fmt::print("replayed {} ticks, {:.3f} s, to {}\n", replay.next(),
             static_cast<double>(replay.next()) * replay.loop().period(), replay.state());
  return kGood;
}

int run_diff(const std::string& first, const std::string& second) {
  const lab::LogComparison found = lab::compare_logs(read_whole_log(first), read_whole_log(second));
  if (!found.setup.empty()) fmt::print("before the first tick:\n");
  print_lines(found.setup);
  for (const lab::LogDifference& d : found.differences) {
    fmt::print("{:8} tick {}, {:.6f} s: {}\n", d.kind, d.tick, d.time, d.text);
  }
  if (found.same()) fmt::print("the same: {} ticks\n", found.ticks);
  return found.same() ? kGood : kRobotFailed;
}

}  // namespace

void add_replay_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReplayArguments>();
  CLI::App* command = app.add_subcommand(
      "replay", "Repeats the ticks of a run with the inputs, plans, edits and files of its log");
  command->add_option("LOG", arguments->log, "log.mcap, or the folder it is in")->required();
  command->add_flag("--verify", arguments->verify,
                    "Compares every tick bit for bit; names the first difference (exit 1)");
  command->add_option("--behavior", arguments->behavior, "Behavior, instead of the log's");
  CLI::Option* const estimator = command->add_option(
      "--estimator", arguments->estimator,
      "Runs this estimator alone over the logged sensors; prints its errors from the logged truth");
  command->add_option("--set", arguments->set, "estimator.NAME=VALUE")->needs(estimator);
  command->add_option("--from", arguments->from, "Errors count from this time on, e.g. 2s")
      ->needs(estimator)
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "The errors as one JSON object")->needs(estimator);
  estimator->check([](const std::string& name) {
    return name.empty() ? std::string("expected the name of an estimator") : std::string();
  });
  estimator->excludes("--verify")->excludes("--behavior");
  command->footer(
      "Example: footfall replay out/run --verify\n"
      "         footfall replay out/run --estimator contact_kalman --json");
  command->callback(
      [arguments, &exit_code] { exit_code = guarded([&] { return run_replay(*arguments); }); });
}

void add_diff_command(CLI::App& app, int& exit_code) {
  auto logs = std::make_shared<std::pair<std::string, std::string>>();
  CLI::App* command = app.add_subcommand("diff",
                                         "Finds where two runs diverge: settings, files, first "
                                         "differing input, command, signal, event");
  command->add_option("LOG", logs->first, "log.mcap, or the folder it is in")->required();
  command->add_option("OTHER", logs->second, "another")->required();
  command->footer("Example: footfall diff out/before out/after");
  command->callback([logs, &exit_code] {
    exit_code = guarded([&] { return run_diff(logs->first, logs->second); });
  });
}

}  // namespace footfall::apps
