// Queue of one user's requests to an engine, sent one after the other: keys pressed while a request
// is pending are combined in the next one, and changes by other users are never overwritten
// unnoticed.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"

namespace footfall::apps {

class TuneOutbox {
 public:
  // Target value of an entry after all requests of this user, else the current target.
  double expected(const TuneModel& model, int entry) const;
  bool is_waiting(int entry) const;

  // Requests a new value; values with the same `over` are combined in one request.
  void want(const TuneModel& model, int entry, double value, double over);
  // Queues a complete request (undo, several values): refused if something has changed since.
  void ask(footfall_lcm::request_t request);
  // The next request to send, if none is pending and the values are as new as the last answer.
  // Entries changed by another user in the meantime are left out and reported in problems().
  std::optional<footfall_lcm::request_t> next(const TuneModel& model);
  // Handles the answer to the pending request. After a conflict with another user's edit of other
  // values, next() retries.
  void answered(const footfall_lcm::answer_t& answer);
  // Resets the queue for a new engine.
  void clear();

  // Problems since the last call, as text.
  std::vector<std::string> take_problems();
  bool empty() const { return queue_.empty() && !sent_; }

 private:
  // A new value, and the target value displayed when it was requested.
  struct Wanted {
    int entry = 0;  // into TuneModel::entries
    double seen = 0.0, value = 0.0;
  };
  struct Ask {
    footfall_lcm::request_t request;
    std::vector<Wanted> wanted;  // empty if the request was given as a whole
    double over = 0.0;
  };
  const Wanted* find_wanted(int entry) const;
  bool prepare(const TuneModel& model, Ask& ask);

  std::deque<Ask> queue_;
  std::optional<Ask> sent_;
  std::int64_t needed_revision_ = 0;  // revision of the last answer; older values are outdated
  std::vector<std::string> problems_;
};

}  // namespace footfall::apps
