// What can be undone and done again: the applied changes of a run, whoever made them.
#pragma once

#include <deque>
#include <vector>

#include "engine/edits/door.h"

namespace footfall::engine {

// A change of values: where each was (or was going), and where it was sent.
struct LiveChange {
  std::vector<behaviors::SlotValue> before, after;
};

class LiveHistory {
 public:
  static constexpr std::size_t kMost = 1000;  // older changes stay

  // The newest change that is not undone, the newest that is; nullptr: none.
  const LiveChange* undoable() const noexcept { return done_.empty() ? nullptr : &done_.back(); }
  const LiveChange* redoable() const noexcept {
    return undone_.empty() ? nullptr : &undone_.back();
  }
  std::size_t undo_count() const noexcept { return done_.size(); }
  std::size_t redo_count() const noexcept { return undone_.size(); }

  // What was applied: something new (what was undone is out of reach then), an undo, a redo.
  void changed(LiveChange change);
  void undid();
  void redid();
  void clear();

 private:
  std::deque<LiveChange> done_;
  std::vector<LiveChange> undone_;
};

}  // namespace footfall::engine
