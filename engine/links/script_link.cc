// The scripts' thread and its queue; see script_link.h.
#include "engine/links/script_link.h"

#include <algorithm>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <utility>

#include "core/realtime/thread_priority.h"

namespace footfall::engine {

using behaviors::ScriptAnswer;
using behaviors::ScriptView;

namespace {

// Made on a thread of its own, whose part of the heap it gets: while Lua's thread frees or moves
// memory it holds that part's lock, for which the run's thread would wait if it were its own part.
std::shared_ptr<behaviors::Script> make_script(const behaviors::ScriptSettings& settings) {
  std::shared_ptr<behaviors::Script> script;
  const auto make = [&script, &settings] {
    try {
      script = std::make_shared<behaviors::Script>(settings);
    } catch (const std::bad_alloc&) {
    }
  };
  { const core::WatchedThread thread(make); }  // waits for its end
  if (script == nullptr) throw std::bad_alloc();
  return script;
}

}  // namespace

ScriptLink::Side::Side(const behaviors::Behavior& of, const behaviors::ScriptSettings& settings)
    : behavior(&of), events(of.events), script(make_script(settings)), batches(kBatches) {
  for (const auto& call : of.calls) calls.push_back(call.name);
  for (const behaviors::ScriptFile& file : of.scripts) {
    behaviors::ScriptError error;
    if (behaviors::load_watched(script, file.text, error,
                                std::filesystem::path(file.path).filename().string()))
      continue;
    throw std::runtime_error(file.path + ":" + std::to_string(error.line) +
                             ": error: " + error.text);
  }
  for (Batch& batch : batches) {
    batch.signals.resize(static_cast<std::size_t>(of.signals.size()));
    batch.parameters.resize(of.values.size());
    batch.active.resize(of.states.size());
  }
}

ScriptLink::ScriptLink(const behaviors::Behavior& behavior,
                       const behaviors::ScriptSettings& settings, bool paced)
    : side_(std::make_shared<Side>(behavior, settings)),
      limits_(behaviors::watch_limits(settings.limits)),
      thread_([side = side_, paced] {
        if (paced) core::take_idle_priority();
        side->work();
      }) {}

ScriptLink::~ScriptLink() {
  side_->stop.store(true);
  side_->posted.fetch_add(1);  // wakes the thread; it sees `stop` first
  side_->posted.notify_all();
  if (let_go_) return;
  // The thread ends with the call that is under way.
  if (!wait_for([this] { return side_->ended.load(); })) give_up();
}

void ScriptLink::deliver(behaviors::Machine& machine) noexcept {
  if (given_up_) return;
  const std::uint32_t answered = side_->answered.load(std::memory_order_acquire);
  const std::uint32_t begun = side_->begun.load(std::memory_order_relaxed);
  if (answered != delivered_ || begun != begun_) unanswered_ = 0;
  begun_ = begun;
  for (; delivered_ != answered; ++delivered_) {
    const Batch& done = side_->batch(delivered_);
    for (std::size_t k = 0; k < done.edit_count; ++k) {
      machine.parameters()[static_cast<std::size_t>(done.edits[k].slot)] = done.edits[k].value;
    }
    for (std::size_t k = 0; k < done.event_count; ++k) machine.raise(done.events[k]);
  }
}

bool ScriptLink::post(const behaviors::Machine& machine, const double* signals,
                      double time) noexcept {
  const auto requests = machine.script_requests();
  const std::uint32_t number = side_->posted.load(std::memory_order_relaxed);
  if (number != delivered_) ++unanswered_;
  if (requests.empty()) return true;
  if (given_up_ || number - delivered_ >= kBatches) return false;
  Batch& next = side_->batch(number);
  next.time = time;
  next.request_count = std::min(requests.size(), kRequests);
  std::copy_n(requests.begin(), next.request_count, next.requests.begin());
  std::copy_n(signals, next.signals.size(), next.signals.begin());
  std::copy_n(machine.parameters().begin(), next.parameters.size(), next.parameters.begin());
  std::fill(next.active.begin(), next.active.end(), std::uint8_t{0});
  for (const int s : machine.active_states()) next.active[static_cast<std::size_t>(s)] = 1;
  side_->posted.store(number + 1, std::memory_order_release);
  side_->posted.notify_one();  // a system call only if the thread sleeps
  return next.request_count == requests.size();
}

bool ScriptLink::stuck(double period) noexcept {
  if (given_up_) return true;
  if (delivered_ == side_->posted.load(std::memory_order_relaxed)) return false;
  const double waited = static_cast<double>(unanswered_) * period;
  if (waited <= limits_.cpu) return false;  // it cannot have used more
  if (waited <= limits_.wall) {
    // In this order: a call that begins in between has used nothing.
    const double used = thread_.cpu_time();
    if (used - side_->used_before.load(std::memory_order_acquire) <= limits_.cpu) return false;
  }
  given_up_ = true;
  side_->stop.store(true);  // if the call comes back after all, the thread ends with it
  return true;
}

void ScriptLink::wait() noexcept {
  const std::uint32_t posted = side_->posted.load(std::memory_order_relaxed);
  const auto done = [this, posted] {
    return side_->answered.load(std::memory_order_acquire) == posted;
  };
  if (!given_up_ && !wait_for(done)) give_up();
}

bool ScriptLink::wait_for(const std::function<bool()>& done) noexcept {
  return core::wait_watched(thread_, limits_, side_->mutex, side_->came, done);
}

void ScriptLink::give_up() noexcept {
  given_up_ = let_go_ = true;
  side_->script->stop();
  thread_.let_go();
}

std::vector<std::string> ScriptLink::take_messages() {
  Texts all;
  const std::size_t count = side_->texts.waiting();
  for (std::size_t k = 0; k < count; ++k) {
    Texts& texts = side_->texts.at(k);
    all.insert(all.end(), texts.begin(), texts.end());
    if (Texts* const back = side_->read_texts.next()) {
      std::swap(*back, texts);
      side_->read_texts.publish();
    }
  }
  side_->texts.release(count);
  if (given_up_ && !std::exchange(told_given_up_, true)) {
    all.emplace_back(std::string("script error: ") + behaviors::kGaveUp);
  }
  return all;
}

void ScriptLink::Side::work() noexcept {
  for (std::uint32_t number = 0;; ++number) {
    posted.wait(number, std::memory_order_acquire);
    Batch& next = batch(number);
    next.event_count = next.edit_count = 0;
    try {
      if (!stop) answer(next);
    } catch (...) {  // out of memory: as if the scripts had asked for nothing
      next.event_count = next.edit_count = 0;
    }
    begin_call();  // what the last one has used does not count for the next, which may come late
    const bool last = stop;
    {
      const std::lock_guard lock(mutex);
      answered.store(number + 1, std::memory_order_release);
      ended = last;
    }
    came.notify_all();
    if (last) return;
  }
}

void ScriptLink::Side::answer(Batch& batch) {
  const ScriptView view{behavior, batch.signals.data(), batch.parameters.data(),
                        batch.active.data(), batch.time};
  ScriptAnswer answer;
  for (std::size_t k = 0; k < batch.request_count && !script->stopped() && !stop; ++k) {
    const auto index = static_cast<std::size_t>(batch.requests[k].index);
    begin_call();
    if (batch.requests[k].is_event) {
      script->handle(events[index], view, answer);
    } else {
      script->call(calls[index], view, answer);
    }
  }
  batch.event_count = std::min(answer.events.size(), kAnswers);
  batch.edit_count = std::min(answer.edits.size(), kAnswers);
  std::copy_n(answer.events.begin(), batch.event_count, batch.events.begin());
  std::copy_n(answer.edits.begin(), batch.edit_count, batch.edits.begin());
  if (answer.events.size() > kAnswers || answer.edits.size() > kAnswers) {
    answer.messages.emplace_back("script error: too many events or edits in one tick");
  }
  if (!answer.messages.empty()) tell(std::move(answer.messages));
}

void ScriptLink::Side::begin_call() noexcept {
  used_before.store(core::WatchedThread::own_cpu_time(), std::memory_order_release);
  begun.fetch_add(1, std::memory_order_relaxed);
}

void ScriptLink::Side::tell(Texts said) {
  for (std::size_t k = 0; k < read_texts.waiting(); ++k) read_texts.at(k) = Texts();
  read_texts.release(read_texts.waiting());
  Texts* const next = texts.next();
  if (next == nullptr) {
    lost += said.size();
    return;
  }
  if (lost > 0) {
    said.push_back("script error: " + std::to_string(lost) + " texts were lost: nobody took them");
    lost = 0;
  }
  *next = std::move(said);
  texts.publish();
}

}  // namespace footfall::engine
