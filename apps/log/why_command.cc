// `footfall why`: explains a behavior's decisions at a moment of a logged run.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "apps/shared/commands.h"
#include "apps/shared/log_argument.h"
#include "core/units/units.h"
#include "lab/replay/why.h"

namespace footfall::apps {
namespace {

struct WhyArguments {
  std::string log, at;
  std::int64_t tick = -1;
};

std::int64_t tick_asked(const WhyArguments& arguments, const lab::Log& log) {
  if (arguments.tick >= 0) return arguments.tick;
  if (arguments.at.empty()) return lab::telling_tick(log);
  const auto quantity = core::parse_quantity(arguments.at);
  const bool time = quantity && (quantity->bare || quantity->dimension == core::kTime);
  if (!time || !(quantity->value >= 0.0 && quantity->value < 1e6)) {
    throw std::runtime_error("--at: error: expected a time such as 12.3s, got '" + arguments.at +
                             "'");
  }
  const std::int64_t tick = std::llround(quantity->value * static_cast<double>(log.rate_mhz) / 1e3);
  // A summary gives the time after the last tick, rounded to milliseconds.
  const std::int64_t end = log.inputs.first_tick + log.inputs.ticks();
  const auto rounding = static_cast<std::int64_t>(1e-3 * static_cast<double>(log.rate_mhz) / 1e3);
  return tick >= end && tick <= end + rounding ? end - 1 : tick;
}

int run_why(const WhyArguments& arguments) {
  const lab::Log log = read_whole_log(arguments.log);
  lab::Replay replay(log);
  fmt::print("{}", lab::explain_tick(replay, tick_asked(arguments, log)));
  return kGood;
}

}  // namespace

void add_why_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<WhyArguments>();
  CLI::App* command = app.add_subcommand(
      "why",
      "Explains a moment of a run: transitions taken and not taken, with each guard's terms");
  command->add_option("LOG", arguments->log, "log.mcap, or the folder it is in")->required();
  auto* at = command->add_option("--at", arguments->at,
                                 "A time, e.g. 12.3s (default: the fall, or the last transition)");
  command->add_option("--tick", arguments->tick, "A tick instead of a time")
      ->excludes(at)
      ->check(CLI::NonNegativeNumber);
  command->footer("Example: footfall why out/run --at 12.3s");
  command->callback(
      [arguments, &exit_code] { exit_code = guarded([&] { return run_why(*arguments); }); });
}

}  // namespace footfall::apps
