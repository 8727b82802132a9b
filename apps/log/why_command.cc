// `footfall why`: explains a behavior's decisions at a moment of a logged run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/log_argument.h"
#include "apps/shared/option_value.h"
#include "apps/shared/time_option.h"
#include "core/units/units.h"
#include "lab/replay/why.h"
#include "lab/steps/fall_chain.h"
#include "lab/steps/log_steps.h"

namespace footfall::apps {
namespace {

struct WhyArguments {
  std::string log, at;
  std::int64_t tick = -1;
  bool fall = false, json = false;
};

std::int64_t tick_asked(const WhyArguments& arguments, const lab::Log& log) {
  if (arguments.tick >= 0) return arguments.tick;
  if (arguments.at.empty()) return lab::telling_tick(log);
  const double time = read_time(arguments.at, "--at");
  if (!(time >= 0.0 && time < 1e6)) {
    throw std::runtime_error("--at: error: expected a time in the run, got '" + arguments.at + "'");
  }
  const double rate = static_cast<double>(log.rate_mhz) / 1e3;
  const std::int64_t tick = std::llround(time * rate);
  // A summary gives the time after the last tick, rounded to hundredths of a second.
  const std::int64_t end = log.inputs.first_tick + log.inputs.ticks();
  const auto rounding = static_cast<std::int64_t>(std::ceil(5e-3 * rate));
  return tick >= end && tick <= end + rounding ? end - 1 : tick;
}

// How a fall came about over its last steps. A run that goes on to its end is no mistake of a user.
int explain_fall(const WhyArguments& arguments) {
  lab::LogSteps reader;
  std::string end;
  for (const std::string& path : run_logs(arguments.log)) {
    const lab::Log log = lab::read_log(path, {.all_rows = true, .inputs = true});
    reader.add(log);
    end = lab::end_of(log);
  }
  const lab::RunSteps steps = reader.steps();
  const bool fell = end == "fall";
  if (arguments.json) {
    nlohmann::ordered_json out = lab::chain_json(steps.rows, fell);
    out["truth"] = steps.truth;
    fmt::print("{}\n", out.dump());
    return kGood;
  }
  if (!fell) {
    fmt::print("the run did not fall: it ended with '{}' after {} steps\n",
               end.empty() ? "no end in its log" : end, steps.rows.size());
    return kGood;
  }
  fmt::print("the fall, by {}:\n{}",
             steps.truth ? "the simulator's truth" : "the robot's own estimate",
             lab::chain_text(steps.rows));
  return kGood;
}

int run_why(const WhyArguments& arguments) {
  if (arguments.fall) return explain_fall(arguments);
  std::deque<lab::Log> logs;  // of the run, then of each reload; a replay keeps referring to them
  for (const std::string& path : run_logs(arguments.log)) logs.push_back(read_whole_log(path));
  const std::int64_t tick = tick_asked(arguments, logs.back());
  lab::Replay replay(logs.front());
  for (std::size_t k = 1; k < logs.size() && tick >= replay.end(); ++k) {
    while (replay.next() < replay.end()) replay.tick({});
    replay.go_on(logs[k]);
  }
  const auto begun = [tick](const lab::Log& log) { return log.inputs.first_tick <= tick; };
  const std::string text = lab::explain_tick(replay, tick);
  const auto log = std::ranges::find_if(logs.rbegin(), logs.rend(), begun);
  fmt::print("{}{}", text, log == logs.rend() ? "" : lab::faults_until(*log, tick));
  return kGood;
}

}  // namespace

void add_why_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<WhyArguments>();
  CLI::App* command = app.add_subcommand("why",
                                         "Explains a moment of a run: transitions taken and not "
                                         "taken, with each guard's terms; or its "
                                         "fall");
  command->add_option("LOG", arguments->log, "log.mcap, or the folder it is in")->required();
  auto* at = command->add_option("--at", arguments->at,
                                 "A time, e.g. 12.3s (default: the fall, or the last transition)");
  auto* tick = command->add_option("--tick", arguments->tick, "A tick instead of a time")
                   ->excludes(at)
                   ->check(at_least(0, "a whole number from 0 on"));
  auto* fall = command->add_flag("--fall", arguments->fall,
                                 "How the fall came about: what was out of bounds in its last "
                                 "steps, and what first");
  fall->excludes(at)->excludes(tick);
  command->add_flag("--json", arguments->json, "The same as an object, for scripts")->needs(fall);
  command->footer("Example: footfall why out/run --at 12.3s");
  command->callback(
      [arguments, &exit_code] { exit_code = guarded([&] { return run_why(*arguments); }); });
}

}  // namespace footfall::apps
