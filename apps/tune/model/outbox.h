// What one person asks of an engine, one request after the other: keys pressed meanwhile gather in
// the next, and nothing that somebody else changed in between is overwritten unseen.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "apps/tune/model/model.h"

namespace footfall::apps {

class TuneOutbox {
 public:
  // Where the entry goes as far as this person knows: asked for, else the target in force.
  double expected(const TuneModel& model, int entry) const;
  bool is_waiting(int entry) const;

  // A new value; further ones of the same `over` wait in one request.
  void want(const TuneModel& model, int entry, double value, double over);
  // A whole request (undo, several values): refused if something changed since.
  void ask(footfall_lcm::request_t request);
  // The next request to send, if none is under way and the values are as new as the last answer;
  // entries that somebody else changed meanwhile are left out and said in problems().
  std::optional<footfall_lcm::request_t> next(const TuneModel& model);
  // The answer to the request under way. A conflict with somebody else's edit of other values is
  // tried again by next().
  void answered(const footfall_lcm::answer_t& answer);
  // The engine is another one: nothing is under way.
  void clear();

  // What went wrong since the last call, for people.
  std::vector<std::string> take_problems();
  bool empty() const { return queue_.empty() && !sent_; }

 private:
  // A new value, and the target that the person saw when they asked for it.
  struct Wanted {
    int entry = 0;  // into TuneModel::entries
    double seen = 0.0, value = 0.0;
  };
  struct Ask {
    footfall_lcm::request_t request;
    std::vector<Wanted> wanted;  // empty: the request is whole
    double over = 0.0;
  };
  const Wanted* find_wanted(int entry) const;
  bool prepare(const TuneModel& model, Ask& ask);

  std::deque<Ask> queue_;
  std::optional<Ask> sent_;
  std::int64_t needed_revision_ = 0;  // values older than that are not what is in force
  std::vector<std::string> problems_;
};

}  // namespace footfall::apps
