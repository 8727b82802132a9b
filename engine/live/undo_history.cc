// Undo and redo stacks; see undo_history.h.
#include "engine/live/undo_history.h"

#include <utility>

namespace footfall::engine {

void LiveHistory::changed(LiveChange change) {
  undone_.clear();
  done_.push_back(std::move(change));
  if (done_.size() > kMost) done_.pop_front();
}

void LiveHistory::undid() {
  undone_.push_back(std::move(done_.back()));
  done_.pop_back();
}

void LiveHistory::redid() {
  done_.push_back(std::move(undone_.back()));
  undone_.pop_back();
}

void LiveHistory::clear() {
  done_.clear();
  undone_.clear();
}

}  // namespace footfall::engine
