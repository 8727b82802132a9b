// A client of live tuning: requests an engine's catalogue, repeats edits until they are answered,
// and receives values, telemetry and the answers to all clients. One thread; everything happens in
// poll().
#pragma once

#include <cstdint>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/telemetry_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/live/key.h"

namespace footfall::engine {

struct LiveClientSettings {
  std::string url;                  // empty: kLiveUrl of bus.h
  std::string prefix = "FOOTFALL";  // prefix of the channel names
  std::optional<LiveKey> key;       // none: only engines that run with --lcm-open are accepted
  std::string who;                  // name shown to other users and in the log; empty: USER@HOST
  double retry = 0.1;               // s without an answer until a request is repeated
  std::int64_t session = 0;  // the only engine to talk to, or its session_number(); 0: any one
};

// A session for people: six digits of it.
constexpr std::int64_t session_number(std::int64_t session) { return 1 + session % 999'999; }

// An engine on the network.
struct EngineIdentity {
  std::int64_t session = 0, pid = 0;
  std::int64_t start = 0;  // us since 1970, UTC
  std::string host, behavior, robot;
  bool usable = true;  // false: it has another key
};

class LiveClient {
 public:
  // Throws std::invalid_argument with one sentence (invalid URL or prefix), or std::runtime_error
  // (network not available, with the remedy).
  explicit LiveClient(const LiveClientSettings& settings);
  ~LiveClient();
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;

  // Waits at most `timeout` seconds for catalogue and values; false if they did not arrive,
  // why_not() gives the reason. Without settings.session it then looks for others for a moment;
  // it talks to one engine only, until that is silent.
  bool connect(double timeout);
  // Asks who is there and listens for this time, longer while somebody has not answered.
  std::vector<EngineIdentity> look(double seconds);
  // The engines heard so far, oldest first.
  std::vector<EngineIdentity> engines() const;
  // Whether messages of another version of this program were heard.
  bool other_version() const;
  bool connected() const;
  // Reason for a failed connect() or a silent engine, as text: no answer, another key, ...
  std::string why_not() const;
  // Seconds since the last message from the engine.
  double silence() const;

  // Handles arriving messages and repeats unanswered requests; waits at most `seconds` for the
  // first message. Returns the number of messages.
  int poll(double seconds);
  // Readable when poll() has messages to handle.
  int file_descriptor() const;

  // The newest message of each type; empty before connected(). They change only within poll().
  // Another session or generation of the catalogue (a new run, a reload) may have other parameters.
  const footfall_lcm::catalogue_t& catalogue() const;
  const footfall_lcm::values_t& values() const;
  // tick < 0 before the first message.
  const footfall_lcm::telemetry_t& telemetry() const;

  // Index of a parameter, state or signal in the catalogue; -1 if absent.
  int find_parameter(std::string_view name) const;
  int find_signal(std::string_view name) const;

  // Sends a request. The caller fills what, over, revision, changes, events; session, client, who,
  // mac and, if it is 0, sequence are filled here. Returns the sequence; the answer is returned by
  // take_answers(). Requires connected().
  std::int64_t send(footfall_lcm::request_t request);
  // Sends a request and waits; nullopt without answer in `timeout` seconds (it is not repeated
  // afterwards: whether it was applied is unknown). Answers to all clients remain available to
  // take_answers().
  std::optional<footfall_lcm::answer_t> ask(const footfall_lcm::request_t& request, double timeout);
  // Number of this client's unanswered requests.
  std::size_t waiting() const;

  // Messages since the last call, in order: answers to all clients (repetitions only once), values
  // and telemetry (at most the newest 4096 of each).
  std::vector<footfall_lcm::answer_t> take_answers();
  std::vector<footfall_lcm::values_t> take_values();
  std::vector<footfall_lcm::telemetry_t> take_telemetry();
  std::int64_t client() const;  // this client's number in answers and requests
  const std::string& who() const;

  // Number of rejected messages: malformed, another key, another session.
  std::int64_t rejected() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
