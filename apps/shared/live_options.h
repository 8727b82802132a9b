// Options of `footfall run` for live tuning over a network.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace CLI {
class App;
}

namespace footfall::engine {
class ControlLoop;
class LcmLink;
struct EngineIdentity;
}  // namespace footfall::engine

namespace footfall::behaviors {
struct PhysicsWorld;
}

namespace footfall::apps {

struct LiveOptions {
  std::string url;     // empty: live tuning is off
  std::string key;     // path of the key file; empty: the user's default key
  bool open = false;   // no key required
  std::string prefix;  // prefix of the channel names
  std::string telemetry = "50 Hz";
};

void add_live_options(CLI::App& command, LiveOptions& options);

// Joins `--lcm URL` to `--lcm=URL`: without the `=` the next argument could also be the behavior.
void join_live_url(int& argc, char** argv);

// Creates the link given by the options, null without --lcm; warns if everybody may change the run.
// Throws InputError for invalid options, std::runtime_error if the network is not available.
std::unique_ptr<engine::LcmLink> make_link(const LiveOptions& options, engine::ControlLoop& loop,
                                           const behaviors::PhysicsWorld& world);

// `balance_best, pid 4711 on bench, since 10:01:02, session 123456`.
std::string engine_text(const engine::EngineIdentity& engine);

// The options with which `footfall tune` finds this run; empty if it needs none.
std::string tune_options_text(const LiveOptions& options);

// Statistics of the link after a run: one line of text, and JSON.
std::string live_text(const LiveOptions& options, const engine::LcmLink& link);
nlohmann::ordered_json live_json(const LiveOptions& options, const engine::LcmLink& link);

}  // namespace footfall::apps
