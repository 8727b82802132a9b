// A connection to an engine: messages from the network update the model.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"
#include "apps/tune/model/options.h"
#include "engine/lcm/client.h"

namespace footfall::apps {

// Several engines are at the address, and none was chosen; the text lists them.
struct SeveralEngines : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct TuneSession {
  explicit TuneSession(const engine::LiveClientSettings& settings) : client(settings) {}

  engine::LiveClient client;
  TuneModel model;
};

// Connects and waits for catalogue and values; nullptr if no engine answers, with advice on stderr.
// Throws InputError for an invalid URL, prefix or key, SeveralEngines if --session is needed. Names
// the session on stderr unless `silent`.
std::unique_ptr<TuneSession> open_session(const TuneOptions& options, bool silent = false);
// Names the engine on stderr: `session 123456: balance_best, pid 4711 on bench`.
void tell_session(const footfall_lcm::catalogue_t& catalogue);
// Waits at most `seconds` for messages and applies them; returns the answers.
std::vector<footfall_lcm::answer_t> take_messages(TuneSession& session, double seconds);
// Sends a request and waits until the timeout. Prints the result (reasons on stderr); returns the
// exit code.
int send_and_explain(TuneSession& session, const footfall_lcm::request_t& request,
                     const TuneOptions& options);

// Reads the behavior's file again for its values; on failure (false) the engine's initial values
// are kept.
bool read_file_values(TuneModel& model);

}  // namespace footfall::apps
