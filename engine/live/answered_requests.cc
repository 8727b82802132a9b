// Windows of sequence numbers per client; see answered_requests.h.
#include "engine/live/answered_requests.h"

#include <algorithm>

namespace footfall::engine {

void LiveClients::Client::forget_to(std::int64_t sequence) {
  floor = std::max(floor, sequence);
  seen.erase(seen.begin(), seen.upper_bound(floor));
}

LiveClients::Verdict LiveClients::look(std::int64_t client, std::int64_t sequence) {
  auto place = clients_.find(client);
  if (place == clients_.end()) {
    if (clients_.size() >= most_clients_) return Verdict::too_many;
    place = clients_.emplace(client, Client{}).first;
  }
  Client& c = place->second;
  if (sequence <= c.floor) return Verdict::too_old;
  if (const auto seen = c.seen.find(sequence); seen != c.seen.end()) {
    if (!seen->second) return Verdict::pending;
    found_ = &*seen->second;
    return Verdict::answered;
  }
  c.seen.emplace(sequence, std::nullopt);
  c.highest = std::max(c.highest, sequence);
  c.forget_to(c.highest - kWindow);
  return Verdict::fresh;
}

void LiveClients::keep(const footfall_lcm::answer_t& answer) {
  const auto client = clients_.find(answer.client);
  if (client == clients_.end()) return;
  const auto seen = client->second.seen.find(answer.sequence);
  if (seen == client->second.seen.end()) return;  // left the window before the answer
  seen->second = answer;
  kept_.emplace_back(answer.client, answer.sequence);
  while (kept_.size() > most_answers_) {
    const auto [oldest, sequence] = kept_.front();
    kept_.pop_front();
    // If it has left its window but is stored here, all earlier ones have left, too.
    clients_.at(oldest).forget_to(sequence);
  }
}

}  // namespace footfall::engine
