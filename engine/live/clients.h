// Which requests of whom have been seen, and what they were answered: a request is done once,
// however often it arrives, and never again when it is long past. Bounded in memory.
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
  static constexpr std::int64_t kWindow = 256;  // newest sequence numbers of a client

  // `most_clients` of a run; the answers of all of them that are kept, beyond which the oldest go.
  explicit LiveClients(std::size_t most_clients = 65536, std::size_t most_answers = 16384)
      : most_clients_(most_clients), most_answers_(most_answers) {}

  enum class Verdict {
    fresh,     // never seen; from now on it is pending
    pending,   // seen, not answered yet
    answered,  // see answer()
    too_old,   // before the window
    too_many,  // clients
  };
  // sequence >= 1.
  Verdict look(std::int64_t client, std::int64_t sequence);
  // Of the last request that look() found answered.
  const footfall_lcm::answer_t& answer() const { return *found_; }
  // The answer to one that was fresh.
  void keep(const footfall_lcm::answer_t& answer);

 private:
  struct Client {
    std::int64_t highest = 0;  // sequence seen
    std::int64_t floor = 0;    // this and those below are too old
    std::map<std::int64_t, std::optional<footfall_lcm::answer_t>> seen;
    void forget_to(std::int64_t sequence);
  };
  std::size_t most_clients_, most_answers_;
  std::unordered_map<std::int64_t, Client> clients_;
  std::deque<std::pair<std::int64_t, std::int64_t>> kept_;  // client and sequence, oldest first
  const footfall_lcm::answer_t* found_ = nullptr;
};

}  // namespace footfall::engine
