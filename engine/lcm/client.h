// A client of live tuning: asks an engine for its catalogue, sends edits until they are answered,
// and hears values, telemetry and everybody's answers. One thread; everything happens in poll().
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
  std::string prefix = "FOOTFALL";  // of the channels
  std::optional<LiveKey> key;       // none: only an engine that runs with --lcm-open is heard
  std::string who;                  // for people and the log; empty: USER@HOST
  double retry = 0.1;               // s without an answer until a request is sent again
};

class LiveClient {
 public:
  // Throws std::invalid_argument with one sentence (a URL or prefix that cannot be), or
  // std::runtime_error (no network for it, and what to do).
  explicit LiveClient(const LiveClientSettings& settings);
  ~LiveClient();
  LiveClient(const LiveClient&) = delete;
  LiveClient& operator=(const LiveClient&) = delete;

  // Asks until catalogue and values are here, at most `timeout` seconds; false: they are not, and
  // why_not() says why.
  bool connect(double timeout);
  bool connected() const;
  // For people, when connect() fails or an engine falls silent: nobody answers, another key, ...
  std::string why_not() const;
  // Seconds since the engine was heard last.
  double silence() const;

  // Takes what arrives and sends again what is not answered; waits at most `seconds` for the first
  // arrival. Returns how many messages came.
  int poll(double seconds);
  // Readable when there is something to poll().
  int file_descriptor() const;

  // The newest of each; empty messages before connected(). Changes only within poll(). Another
  // session or generation of the catalogue (a new run, a reload) may bring other parameters.
  const footfall_lcm::catalogue_t& catalogue() const;
  const footfall_lcm::values_t& values() const;
  // tick < 0: none yet.
  const footfall_lcm::telemetry_t& telemetry() const;

  // Index of a parameter, state or signal in the catalogue; -1: no such name.
  int find_parameter(std::string_view name) const;
  int find_signal(std::string_view name) const;

  // Sends a request: what, over, revision, changes, events are the caller's; session, client, who,
  // mac and, if it is 0, sequence are filled in. Returns the sequence; the answer comes with
  // take_answers(). Needs connected().
  std::int64_t send(footfall_lcm::request_t request);
  // Sends and waits; none: no answer within `timeout` seconds (it will not be sent again: whether
  // it was applied is not known). Everybody's answers remain for take_answers().
  std::optional<footfall_lcm::answer_t> ask(const footfall_lcm::request_t& request, double timeout);
  // Requests of this client that wait for their answers.
  std::size_t waiting() const;

  // What arrived since the last call, in order: answers to everybody (repeated ones once), and
  // telemetry (of both the newest 4096).
  std::vector<footfall_lcm::answer_t> take_answers();
  std::vector<footfall_lcm::telemetry_t> take_telemetry();
  std::int64_t client() const;  // this one's number, in answers and requests
  const std::string& who() const;

  // Messages that were refused: malformed, not of the key, of another session.
  std::int64_t rejected() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
