// Undo history: the applied changes of a run by all users.
#pragma once

#include <deque>
#include <vector>

#include "engine/edits/door.h"

namespace footfall::engine {

// A change of values: previous values (or ramp targets) and new ones.
struct LiveChange {
  std::vector<behaviors::SlotValue> before, after;
  double over = 0.0;  // s, its ramp: undone and redone alike
};

class LiveHistory {
 public:
  static constexpr std::size_t kMost = 1000;  // older changes cannot be undone

  // The newest change to be undone or redone; nullptr if none.
  const LiveChange* undoable() const noexcept { return done_.empty() ? nullptr : &done_.back(); }
  const LiveChange* redoable() const noexcept {
    return undone_.empty() ? nullptr : &undone_.back();
  }
  std::size_t undo_count() const noexcept { return done_.size(); }
  std::size_t redo_count() const noexcept { return undone_.size(); }

  // Records an applied change: a new one (which clears the redo stack), an undo, or a redo.
  void changed(LiveChange change);
  void undid();
  void redid();
  void clear();

 private:
  std::deque<LiveChange> done_;
  std::vector<LiveChange> undone_;
};

}  // namespace footfall::engine
