// Remembers the requests of every client and their answers: a request is executed at most once,
// however often it arrives, and never if it is outdated. Bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <footfall_lcm/answer_t.hpp>
#include <map>
#include <optional>
#include <unordered_map>
#include <utility>

namespace footfall::engine {

class LiveClients {
 public:
  static constexpr std::int64_t kWindow = 256;  // newest sequence numbers kept per client

  // Limits of the number of clients in a run and of stored answers of all clients; the oldest
  // answers are dropped.
  explicit LiveClients(std::size_t most_clients = 65536, std::size_t most_answers = 16384)
      : most_clients_(most_clients), most_answers_(most_answers) {}

  enum class Verdict {
    fresh,     // new; pending from now on
    pending,   // seen, not yet answered
    answered,  // see answer()
    too_old,   // before the window
    too_many,  // limit of clients reached
  };
  // Classifies a request; sequence >= 1.
  Verdict look(std::int64_t client, std::int64_t sequence);
  // The answer to the last request for which look() returned `answered`.
  const footfall_lcm::answer_t& answer() const { return *found_; }
  // Stores the answer to a pending request.
  void keep(const footfall_lcm::answer_t& answer);

 private:
  struct Client {
    std::int64_t highest = 0;  // highest sequence seen
    std::int64_t floor = 0;    // this and lower ones are too old
    std::map<std::int64_t, std::optional<footfall_lcm::answer_t>> seen;
    void forget_to(std::int64_t sequence);
  };
  std::size_t most_clients_, most_answers_;
  std::unordered_map<std::int64_t, Client> clients_;
  std::deque<std::pair<std::int64_t, std::int64_t>> kept_;  // client and sequence, oldest first
  const footfall_lcm::answer_t* found_ = nullptr;
};

}  // namespace footfall::engine
