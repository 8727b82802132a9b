// Requests, the edit door and answers; see server.h.
#include "engine/live/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <utility>

#include "core/index.h"
#include "core/text/printable.h"
#include "engine/live/answered_requests.h"
#include "engine/live/catalogue.h"
#include "engine/live/request.h"
#include "engine/live/undo_history.h"

namespace footfall::engine {
namespace {

using behaviors::Behavior;
using behaviors::ParameterInfo;
using footfall_lcm::answer_t;
using footfall_lcm::request_t;

constexpr std::size_t kMostWaiting = 64;  // requests queued behind an undo that waits for the tick

template <typename T>
auto count_of(const T& list) {
  return static_cast<std::int32_t>(list.size());
}

}  // namespace

struct LiveServer::Impl {
  // A request submitted, or to be submitted, to the door.
  struct Pending {
    answer_t answer;  // as far as known
    std::int8_t what = request_t::EDIT;
    std::vector<behaviors::SlotValue> values;  // of an EDIT
    double over = 0.0;                         // s, its ramp
  };

  Impl(const Behavior& b, EditEntrance& e, const LiveSettings& s)
      : behavior(&b), entrance(&e), names(b), settings(s), targets(b.values) {}

  std::int64_t revision() const noexcept { return revision_of(entrance->revision()); }
  std::int64_t revision_of(std::uint64_t door) const noexcept {
    return base + static_cast<std::int64_t>(door);
  }
  void refuse(answer_t answer, std::vector<std::string> reasons, bool keep, Answers& answers);
  bool is_known(const request_t& request, const answer_t& answer, Answers& answers);
  void process(const request_t& request, Answers& answers);
  EditBatch batch_of(const request_t& request, std::vector<std::string>& reasons) const;
  std::vector<std::string> physics_against(const EditBatch& batch);
  void follow(const LiveState& state);
  void take(const EditAnswer& told, std::span<const double> former, Answers& answers);
  void remember(const Pending& done, std::span<const double> former);
  void take_answers(Answers& answers);

  const Behavior* behavior;
  EditEntrance* entrance;
  LiveNames names;
  LiveSettings settings;
  std::int64_t generation = 0;
  std::int64_t base = 0;          // changes before this door was bound
  std::int64_t told = -1;         // revision of the last values sent
  std::deque<Pending> pending;    // submitted to the door, in order
  std::deque<request_t> waiting;  // queued until the door has answered
  std::vector<double> former;
  behaviors::EditedValues* edited = nullptr;
  std::vector<double> targets;         // values of live parameters after all applied edits, by slot
  std::uint64_t targets_revision = 0;  // of the door
  LiveHistory history;
  LiveClients clients;
  LiveCounters counters;
};

namespace {

answer_t blank_answer(const request_t& request, std::int64_t session) {
  answer_t answer{};
  answer.session = session;
  answer.client = request.client;
  answer.sequence = request.sequence;
  answer.who = core::printable(request.who, kMaxWho);
  answer.tick = -1;
  return answer;
}

const char* what_name(std::int8_t what) {
  return what == request_t::UNDO ? "undo" : what == request_t::REDO ? "redo" : "";
}

std::string joined(const std::vector<std::string>& reasons) {
  std::string text;
  for (const std::string& reason : reasons) text += (text.empty() ? "" : "; ") + reason;
  return text;
}

}  // namespace

void LiveServer::Impl::refuse(answer_t answer, std::vector<std::string> reasons, bool keep,
                              Answers& answers) {
  answer.revision = revision();
  answer.reasons = shortened(std::move(reasons));
  answer.reason_count = count_of(answer.reasons);
  ++counters.refused;
  entrance->tell_refused(EditSource::live, answer.who, joined(answer.reasons));
  if (keep) clients.keep(answer);
  answers.push_back(std::move(answer));
}

// Whether the request was answered before, or must not be executed.
bool LiveServer::Impl::is_known(const request_t& request, const answer_t& answer,
                                Answers& answers) {
  const auto no = [&](std::string reason) {
    refuse(answer, {std::move(reason)}, false, answers);
    return true;
  };
  if (request.session != settings.session) {  // to another engine: that one answers
    ++counters.refused;
    return true;
  }
  if (request.sequence < 1) return no("sequence: a client counts its requests from 1");
  switch (clients.look(request.client, request.sequence)) {
    case LiveClients::Verdict::fresh:
      return false;
    case LiveClients::Verdict::pending:
      ++counters.repeated;
      return true;
    case LiveClients::Verdict::answered:
      ++counters.repeated;
      answers.push_back(clients.answer());
      return true;
    case LiveClients::Verdict::too_old:
      return no(fmt::format("sequence {} is too old: newer ones of this client were seen",
                            request.sequence));
    case LiveClients::Verdict::too_many:
      break;
  }
  return no("too many clients in this run: it takes no new ones");
}

EditBatch LiveServer::Impl::batch_of(const request_t& request,
                                     std::vector<std::string>& reasons) const {
  EditBatch batch;
  if (request.what == request_t::EDIT) {
    batch = read_edit(*behavior, names, request, reasons);
  } else if (request.what == request_t::UNDO || request.what == request_t::REDO) {
    const bool undo = request.what == request_t::UNDO;
    const LiveChange* change = undo ? history.undoable() : history.redoable();
    if (!request.changes.empty() || !request.events.empty()) {
      reasons.push_back(fmt::format("{}: takes no changes or events", what_name(request.what)));
    }
    if (change == nullptr) {
      reasons.push_back(fmt::format("there is nothing to {}", what_name(request.what)));
    } else {
      batch.values = undo ? change->before : change->after;
    }
    // Of its own duration, unless another one is asked for.
    batch.over = request.over != 0.0 || change == nullptr ? request.over : change->over;
  } else {
    reasons.push_back(fmt::format("what: 0 (edit), 1 (undo) or 2 (redo) was expected, got {}",
                                  static_cast<int>(request.what)));
  }
  batch.who = core::printable(request.who, kMaxWho);
  batch.note = what_name(request.what);
  if (request.revision < -1) {
    reasons.push_back(fmt::format("revision {}: -1 or more was expected", request.revision));
  } else if (request.revision >= 0 && request.revision != revision()) {
    reasons.push_back(fmt::format("revision {} was expected, {} is in force: read it again",
                                  request.revision, revision()));
  } else if (request.revision >= 0) {
    batch.revision = static_cast<std::uint64_t>(request.revision - base);
  }
  return batch;
}

// Reasons for which `run` would refuse to start with the values after this batch.
std::vector<std::string> LiveServer::Impl::physics_against(const EditBatch& batch) {
  if (edited == nullptr || batch.values.empty()) return {};
  std::vector<double> values = targets;
  const auto apply = [&values](const std::vector<behaviors::SlotValue>& changes) {
    for (const auto& [slot, value] : changes) values[at(slot)] = value;
  };
  for (const Pending& earlier : pending) apply(earlier.values);
  apply(batch.values);
  std::vector<std::string> reasons;
  for (const core::Diagnostic& error : edited->errors(values)) {
    reasons.push_back("`run` would refuse it: " + error.text);
  }
  return reasons;
}

// Values that others edited, or that an edit of this server had applied.
void LiveServer::Impl::follow(const LiveState& state) {
  if (state.revision < targets_revision) return;
  for (const int p : names.parameters) {
    const ParameterInfo& info = behavior->parameters[at(p)];
    for (int slot = info.slot; slot < info.slot + info.size; ++slot) {
      targets[at(slot)] = state.target[at(slot)];
    }
  }
}

void LiveServer::Impl::process(const request_t& request, Answers& answers) {
  std::vector<std::string> reasons;
  EditBatch batch = batch_of(request, reasons);
  answer_t answer = blank_answer(request, settings.session);
  if (!reasons.empty()) {
    // Report all problems at once; an empty edit only follows from omitted names.
    if (!batch.values.empty() || !batch.events.empty()) {
      batch.revision.reset();
      for (std::string& reason : reasons_against(*behavior, batch, entrance->revision())) {
        reasons.push_back(std::move(reason));
      }
    }
    return refuse(std::move(answer), std::move(reasons), true, answers);
  }
  // Only a batch that is good otherwise: indices and ranges were checked.
  if (reasons_against(*behavior, batch, entrance->revision()).empty()) {
    reasons = physics_against(batch);
    if (!reasons.empty()) return refuse(std::move(answer), std::move(reasons), true, answers);
  }
  EditReply reply = entrance->submit(batch);
  if (!reply.accepted()) {
    return refuse(std::move(answer), std::move(reply.reasons), true, answers);
  }
  answer.text = batch.note.empty() ? "" : batch.note + ": ";
  answer.text += change_text(*behavior, batch, ramp_time(*behavior, batch));
  pending.push_back({std::move(answer), request.what, std::move(batch.values), batch.over});
}

void LiveServer::Impl::remember(const Pending& done, std::span<const double> before) {
  if (done.what == request_t::UNDO) return history.undid();
  if (done.what == request_t::REDO) return history.redid();
  if (done.values.empty()) return;  // events only
  LiveChange change{done.values, done.values, done.over};
  for (std::size_t k = 0; k < change.before.size(); ++k) change.before[k].value = before[k];
  history.changed(std::move(change));
}

void LiveServer::Impl::take(const EditAnswer& told_by_tick, std::span<const double> before,
                            Answers& answers) {
  Pending done = std::move(pending.front());
  pending.pop_front();
  answer_t& answer = done.answer;
  if (told_by_tick.outcome != EditOutcome::applied) {
    answer.text.clear();
    answer.revision = revision_of(told_by_tick.revision);
    answer.reasons = {fmt::format("revision {} is in force, another was expected: read it again",
                                  answer.revision)};
    answer.reason_count = 1;
    ++counters.refused;
  } else {
    answer.accepted = 1;
    answer.tick = told_by_tick.tick;
    answer.revision = revision_of(told_by_tick.revision);
    remember(done, before);
    for (const auto& [slot, value] : done.values) targets[at(slot)] = value;
    targets_revision = told_by_tick.revision;
    ++counters.applied;
  }
  clients.keep(answer);
  answers.push_back(std::move(answer));
}

void LiveServer::Impl::take_answers(Answers& answers) {
  EditAnswer told_by_tick;
  former.resize(behavior->values.size());
  while (!pending.empty() && entrance->take_answer(told_by_tick, former)) {
    take(told_by_tick, former, answers);
  }
}

LiveServer::LiveServer(const Behavior& behavior, EditEntrance& entrance,
                       const LiveSettings& settings)
    : impl_(std::make_unique<Impl>(behavior, entrance, settings)) {}
LiveServer::~LiveServer() = default;

void LiveServer::request(const request_t& request, Answers& answers) {
  Impl& m = *impl_;
  ++m.counters.requests;
  const answer_t answer = blank_answer(request, m.settings.session);
  if (m.is_known(request, answer, answers)) return;
  // The newest change is known only after the door's pending edits were applied or refused.
  const bool waits =
      !m.waiting.empty() || (request.what != request_t::EDIT && m.entrance->outstanding() > 0);
  if (!waits) return m.process(request, answers);
  if (m.waiting.size() < kMostWaiting) {
    m.waiting.push_back(request);
  } else {
    m.refuse(answer, {fmt::format("{} requests wait already: try again", kMostWaiting)}, true,
             answers);
  }
}

void LiveServer::poll(Answers& answers) {
  Impl& m = *impl_;
  m.take_answers(answers);
  while (!m.waiting.empty()) {
    if (m.waiting.front().what != request_t::EDIT && m.entrance->outstanding() > 0) return;
    m.process(m.waiting.front(), answers);
    m.waiting.pop_front();
  }
}

void LiveServer::fill_catalogue(footfall_lcm::catalogue_t& catalogue) const {
  const Impl& m = *impl_;
  fill_names(*m.behavior, m.names, catalogue);
  catalogue.session = m.settings.session;
  catalogue.generation = m.generation;
  catalogue.revision = m.revision();
  catalogue.keyed = m.settings.keyed ? 1 : 0;
  catalogue.host = m.settings.host;
  catalogue.pid = m.settings.pid;
  catalogue.start = m.settings.start;
}

void LiveServer::fill_values(const LiveState& state, footfall_lcm::values_t& values) {
  Impl& m = *impl_;
  values.session = m.settings.session;
  values.generation = m.generation;
  values.revision = m.told = m.revision_of(state.revision);
  values.tick = state.tick;
  m.follow(state);
  values.undo_count = static_cast<std::int32_t>(m.history.undo_count());
  values.redo_count = static_cast<std::int32_t>(m.history.redo_count());
  values.now.clear();
  values.target.clear();
  for (const int p : m.names.parameters) {
    const ParameterInfo& info = m.behavior->parameters[at(p)];
    for (int slot = info.slot; slot < info.slot + info.size; ++slot) {
      values.now.push_back(state.now[at(slot)]);
      values.target.push_back(state.target[at(slot)]);
    }
  }
  values.count = count_of(values.now);
}

void LiveServer::judge_by(behaviors::EditedValues* edited) { impl_->edited = edited; }
bool LiveServer::changed() const noexcept { return impl_->revision() != impl_->told; }
std::int64_t LiveServer::session() const noexcept { return impl_->settings.session; }
std::int64_t LiveServer::generation() const noexcept { return impl_->generation; }
std::int64_t LiveServer::revision() const noexcept { return impl_->revision(); }
std::int64_t LiveServer::revision_of(std::uint64_t door_revision) const noexcept {
  return impl_->revision_of(door_revision);
}
const LiveCounters& LiveServer::counters() const noexcept { return impl_->counters; }

void LiveServer::rebind(const Behavior& behavior, EditEntrance& entrance, const std::string& reason,
                        Answers& answers) {
  Impl& m = *impl_;
  m.take_answers(answers);
  const std::int64_t next = m.revision() + 1;
  m.behavior = &behavior;
  m.entrance = &entrance;
  m.names = LiveNames(behavior);
  m.base = next - static_cast<std::int64_t>(entrance.revision());  // the count continues
  m.history.clear();
  m.edited = nullptr;
  m.targets = behavior.values;
  m.targets_revision = entrance.revision();
  ++m.generation;
  for (const Impl::Pending& p : std::exchange(m.pending, {})) {
    answer_t answer = p.answer;
    answer.text.clear();
    m.refuse(std::move(answer), {reason}, true, answers);
  }
  for (const request_t& request : std::exchange(m.waiting, {})) {
    m.refuse(blank_answer(request, m.settings.session), {reason}, true, answers);
  }
}

}  // namespace footfall::engine
