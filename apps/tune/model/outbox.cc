// Queue of one user's requests; see outbox.h.
#include "apps/tune/model/outbox.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/index.h"

namespace footfall::apps {

const TuneOutbox::Wanted* TuneOutbox::find_wanted(int entry) const {
  const auto in = [entry](const Ask& ask) {
    const auto found = std::ranges::find(ask.wanted, entry, &Wanted::entry);
    return found == ask.wanted.end() ? nullptr : &*found;
  };
  for (auto ask = queue_.rbegin(); ask != queue_.rend(); ++ask) {
    if (const Wanted* wanted = in(*ask)) return wanted;
  }
  return sent_ ? in(*sent_) : nullptr;
}

double TuneOutbox::expected(const TuneModel& model, int entry) const {
  const Wanted* wanted = find_wanted(entry);
  return wanted != nullptr ? wanted->value : model.value_target(model.entries[at(entry)].slot);
}

bool TuneOutbox::is_waiting(int entry) const { return find_wanted(entry) != nullptr; }

void TuneOutbox::want(const TuneModel& model, int entry, double value, double over) {
  const double seen = expected(model, entry);
  if (queue_.empty() || queue_.back().wanted.empty() || queue_.back().over != over) {
    queue_.push_back({{}, {}, over});
  }
  std::vector<Wanted>& wanted = queue_.back().wanted;
  const auto there = std::ranges::find(wanted, entry, &Wanted::entry);
  if (there != wanted.end()) {
    there->value = value;
  } else {
    wanted.push_back({entry, seen, value});
  }
}

void TuneOutbox::ask(footfall_lcm::request_t request) {
  queue_.push_back({std::move(request), {}, 0.0});
}

// Completes the request; false if nothing is left to send.
bool TuneOutbox::prepare(const TuneModel& model, Ask& ask) {
  if (!ask.wanted.empty()) {
    std::vector<footfall_lcm::change_t> changes;
    std::vector<Wanted> kept;
    for (const Wanted& wanted : ask.wanted) {
      const TuneEntry& entry = model.entries[at(wanted.entry)];
      const double target = model.value_target(entry.slot);
      if (target != wanted.seen) {
        problems_.push_back(
            fmt::format("{} was changed meanwhile, to {}: look again", entry.name,
                        shown_value(target, model.parameters[at(entry.parameter)].unit)));
      } else if (wanted.value != target) {
        changes.push_back(change_of(model, entry, wanted.value));
        kept.push_back(wanted);
      }
    }
    if (kept.empty()) return false;
    ask.wanted = std::move(kept);
    ask.request = edit_request(std::move(changes), {}, ask.over, -1);
  }
  ask.request.revision = model.values.revision;
  return true;
}

std::optional<footfall_lcm::request_t> TuneOutbox::next(const TuneModel& model) {
  if (sent_ || model.values.revision < needed_revision_) return std::nullopt;
  while (!queue_.empty()) {
    Ask ask = std::move(queue_.front());
    queue_.pop_front();
    if (!prepare(model, ask)) continue;
    sent_ = std::move(ask);
    return sent_->request;
  }
  return std::nullopt;
}

void TuneOutbox::answered(const footfall_lcm::answer_t& answer) {
  if (!sent_) return;
  Ask ask = *std::exchange(sent_, std::nullopt);
  needed_revision_ = answer.revision;
  if (answer.accepted != 0) return;
  if (!ask.wanted.empty() && is_conflict(ask.request, answer)) {
    queue_.push_front(std::move(ask));
    return;
  }
  // Later requests may depend on the refused value, so they are dropped.
  queue_.clear();
  for (const std::string& reason : answer.reasons) problems_.push_back(reason);
}

void TuneOutbox::clear() {
  queue_.clear();
  sent_.reset();
  needed_revision_ = 0;
}

std::vector<std::string> TuneOutbox::take_problems() { return std::exchange(problems_, {}); }

}  // namespace footfall::apps
