// The options of `footfall run` that put it on the network of live tuning.
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
}  // namespace footfall::engine

namespace footfall::apps {

struct LiveOptions {
  std::string url;     // empty: nothing listens
  std::string key;     // file; empty: the user's own
  bool open = false;   // no key
  std::string prefix;  // of the channels
  std::string telemetry = "50 Hz";
};

void add_live_options(CLI::App& command, LiveOptions& options);

// `--lcm URL` as `--lcm=URL`: without the `=` the next argument could as well be the behavior.
void join_live_url(int& argc, char** argv);

// The link that the options ask for, null without --lcm; warns where everybody may change the run.
// Throws InputError for what cannot be, std::runtime_error where there is no such network.
std::unique_ptr<engine::LcmLink> make_link(const LiveOptions& options, engine::ControlLoop& loop);

// Of a run that has ended: a line for people, and the same for scripts.
std::string live_text(const LiveOptions& options, const engine::LcmLink& link);
nlohmann::ordered_json live_json(const LiveOptions& options, const engine::LcmLink& link);

}  // namespace footfall::apps
