// An engine and the picture of it: what comes over the network goes into the model.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"
#include "apps/tune/model/options.h"
#include "engine/lcm/client.h"

namespace footfall::apps {

struct TuneSession {
  explicit TuneSession(const engine::LiveClientSettings& settings) : client(settings) {}

  engine::LiveClient client;
  TuneModel model;
};

// Connected, catalogue and values in the model; nullptr: nobody answers, said on stderr with what
// to check. Throws InputError for a URL, prefix or key that cannot be.
std::unique_ptr<TuneSession> open_session(const TuneOptions& options);
// Waits at most `seconds` for messages and takes them; the answers that came.
std::vector<footfall_lcm::answer_t> take_messages(TuneSession& session, double seconds);
// Sends and waits until the timeout. Prints what became of it (reasons on stderr); the exit code.
int send_and_explain(TuneSession& session, const footfall_lcm::request_t& request,
                     const TuneOptions& options);

// Reads the behavior's file again for the values that it has; what cannot be read keeps what the
// engine began with (false).
bool read_file_values(TuneModel& model);

}  // namespace footfall::apps
