// Creates a link from options; see live_options.h.
#include "apps/shared/live_options.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string_view>

#include "apps/shared/commands.h"
#include "core/units/units.h"
#include "engine/lcm/client.h"
#include "engine/lcm/link.h"

namespace footfall::apps {
namespace {

double rate_of(const std::string& text) {
  const auto quantity = core::parse_quantity(text);
  const bool rate = quantity && (quantity->bare || quantity->dimension == core::kRate);
  if (!rate || !(quantity->value >= 0.0) || quantity->value > 10'000.0) {
    throw InputError(
        "--telemetry: error: expected a rate from 0 to 10000 Hz such as '50 Hz', got '" + text +
        "'");
  }
  return quantity->value;
}

// The number of refused packets by reason.
std::string rejected_text(const engine::LinkCounters& counters) {
  std::string text;
  for (std::size_t k = 1; k < counters.rejected.size(); ++k) {
    if (counters.rejected[k] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? " (" : ", ", counters.rejected[k],
                        engine::packet_problem_name(static_cast<engine::PacketProblem>(k)));
  }
  return text.empty() ? text : text + ")";
}

}  // namespace

void add_live_options(CLI::App& command, LiveOptions& o) {
  const std::string flag = fmt::format("--lcm{{{}}}", engine::default_url());
  CLI::Option* const lcm =
      command.add_flag(flag, o.url,
                       fmt::format("Can be tuned while it runs (footfall tune), at --lcm=URL or {}",
                                   engine::default_url()));
  CLI::Option* const key =
      command
          .add_option("--lcm-key", o.key,
                      "File with the key that edits need (footfall tune key FILE makes one); "
                      "default: the user's own key")
          ->needs(lcm);
  command
      .add_flag("--lcm-open", o.open,
                "Accepts edits without a key: everybody on the network may change the run")
      ->needs(lcm)
      ->excludes(key);
  o.prefix = engine::kLivePrefix;
  command.add_option("--lcm-prefix", o.prefix, "Prefix of the channel names")
      ->needs(lcm)
      ->capture_default_str();
  command
      .add_option("--telemetry", o.telemetry,
                  "Telemetry with --lcm, per second of the run; 0: none")
      ->needs(lcm)
      ->capture_default_str();
}

void join_live_url(int& argc, char** argv) {
  static std::string joined;
  for (int i = 1; i + 1 < argc; ++i) {
    if (std::string_view(argv[i]) != "--lcm" ||
        std::string_view(argv[i + 1]).find("://") == std::string_view::npos) {
      continue;
    }
    joined = std::string("--lcm=") + argv[i + 1];
    argv[i] = joined.data();
    for (int k = i + 1; k < argc; ++k) argv[k] = argv[k + 1];  // argv ends with a null pointer
    --argc;
    return;
  }
}

namespace {

// Warns of engines that use the same channels already.
void warn_of_others(const LiveOptions& options, const engine::LinkSettings& settings) {
  constexpr double kLook = 0.35;  // s
  engine::LiveClientSettings look{settings.url, settings.prefix, settings.key, "", 0.1, 0};
  engine::LiveClient client(look);
  for (const engine::EngineIdentity& other : client.look(kLook)) {
    std::fprintf(stderr,
                 "footfall: warning: another engine is at %s (%s_*) already: %s; `footfall tune` "
                 "will ask for --session, or choose another --lcm-prefix\n",
                 options.url.c_str(), options.prefix.c_str(), engine_text(other).c_str());
  }
  if (client.other_version()) {
    std::fprintf(stderr,
                 "footfall: warning: an engine of another version is at %s (%s_*) already\n",
                 options.url.c_str(), options.prefix.c_str());
  }
}

}  // namespace

std::string engine_text(const engine::EngineIdentity& engine) {
  return fmt::format("{}, pid {} on {}, since {:%H:%M:%S}, session {}{}", engine.behavior,
                     engine.pid, engine.host, fmt::localtime(engine.start / 1'000'000),
                     engine::session_number(engine.session),
                     engine.usable ? "" : " (of another key)");
}

std::unique_ptr<engine::LcmLink> make_link(const LiveOptions& options, engine::ControlLoop& loop,
                                           const behaviors::PhysicsWorld& world) {
  if (options.url.empty()) return nullptr;
  engine::LinkSettings settings;
  settings.url = options.url;
  settings.prefix = options.prefix;
  settings.world = world;
  settings.telemetry = rate_of(options.telemetry);
  if (!options.open) {
    settings.key = options.key.empty() ? engine::default_key() : engine::read_key(options.key);
  } else {
    std::fprintf(stderr,
                 "footfall: warning: --lcm-open: everybody who reaches %s may change this run\n",
                 options.url.c_str());
  }
  try {
    warn_of_others(options, settings);
    return std::make_unique<engine::LcmLink>(loop, settings);
  } catch (const std::invalid_argument& error) {
    throw InputError(std::string("--lcm: error: ") + error.what());
  }
}

std::string tune_options_text(const LiveOptions& options) {
  std::string text;
  if (options.url != engine::kLiveUrl) text += fmt::format(" --url '{}'", options.url);
  if (options.prefix != engine::kLivePrefix) text += " --prefix " + options.prefix;
  if (!options.key.empty()) text += " --key " + options.key;
  if (options.open) text += " --open";
  return text;
}

std::string live_text(const LiveOptions& options, const engine::LcmLink& link) {
  const engine::LinkCounters counters = link.counters();
  return fmt::format(
      "  live         {} ({}_*): {} edits applied, {} refused; {} packets rejected{}\n",
      options.url, options.prefix, counters.requests.applied, counters.requests.refused,
      counters.rejected_in_all(), rejected_text(counters));
}

nlohmann::ordered_json live_json(const LiveOptions& options, const engine::LcmLink& link) {
  const engine::LinkCounters counters = link.counters();
  nlohmann::ordered_json rejected = nlohmann::ordered_json::object();
  for (std::size_t k = 1; k < counters.rejected.size(); ++k) {
    std::string name = engine::packet_problem_name(static_cast<engine::PacketProblem>(k));
    std::ranges::replace(name, ' ', '_');
    rejected[name] = counters.rejected[k];
  }
  return {{"url", options.url},
          {"prefix", options.prefix},
          {"packets", {{"HELLO", counters.heard_hello}, {"REQUEST", counters.heard_request}}},
          {"requests", counters.requests.requests},
          {"applied", counters.requests.applied},
          {"refused", counters.requests.refused},
          {"repeated", counters.requests.repeated},
          {"hellos", counters.hellos},
          {"rejected", rejected},
          {"strange_datagrams", counters.strange},
          {"telemetry", counters.telemetry},
          {"telemetry_dropped", counters.dropped}};
}

}  // namespace footfall::apps
