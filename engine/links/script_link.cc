// The scripts' thread and its queue; see script_link.h.
#include "engine/links/script_link.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace footfall::engine {

using behaviors::ScriptAnswer;
using behaviors::ScriptView;

ScriptLink::ScriptLink(const behaviors::Behavior& behavior,
                       const behaviors::ScriptSettings& settings)
    : behavior_(behavior), script_(settings), batches_(kBatches) {
  for (const behaviors::ScriptFile& file : behavior.scripts) {
    behaviors::ScriptError error;
    if (script_.load(file.text, error)) continue;
    throw std::runtime_error(file.path + ":" + std::to_string(error.line) +
                             ": error: " + error.text);
  }
  for (Batch& batch : batches_) {
    batch.signals.resize(static_cast<std::size_t>(behavior.signals.size()));
    batch.parameters.resize(behavior.values.size());
    batch.active.resize(behavior.states.size());
  }
  thread_ = std::thread([this] { work(); });
}

ScriptLink::~ScriptLink() {
  stop_.store(true);
  posted_.fetch_add(1);  // wakes the thread; it sees stop_ first
  posted_.notify_all();
  thread_.join();
}

void ScriptLink::deliver(behaviors::Machine& machine) noexcept {
  const std::uint32_t answered = answered_.load(std::memory_order_acquire);
  for (; delivered_ != answered; ++delivered_) {
    const Batch& done = batch(delivered_);
    for (std::size_t k = 0; k < done.edit_count; ++k) {
      machine.parameters()[static_cast<std::size_t>(done.edits[k].slot)] = done.edits[k].value;
    }
    for (std::size_t k = 0; k < done.event_count; ++k) machine.raise(done.events[k]);
  }
}

bool ScriptLink::post(const behaviors::Machine& machine, const double* signals,
                      double time) noexcept {
  const auto requests = machine.script_requests();
  if (requests.empty()) return true;
  const std::uint32_t number = posted_.load(std::memory_order_relaxed);
  if (number - delivered_ >= kBatches) return false;
  Batch& next = batch(number);
  next.time = time;
  next.request_count = std::min(requests.size(), kRequests);
  std::copy_n(requests.begin(), next.request_count, next.requests.begin());
  std::copy_n(signals, next.signals.size(), next.signals.begin());
  std::copy_n(machine.parameters().begin(), next.parameters.size(), next.parameters.begin());
  std::fill(next.active.begin(), next.active.end(), std::uint8_t{0});
  for (const int s : machine.active_states()) next.active[static_cast<std::size_t>(s)] = 1;
  posted_.store(number + 1, std::memory_order_release);
  posted_.notify_one();  // a system call only if the thread sleeps
  return next.request_count == requests.size();
}

void ScriptLink::wait() noexcept {
  const std::uint32_t posted = posted_.load(std::memory_order_relaxed);
  for (auto done = answered_.load(std::memory_order_acquire); done != posted;
       done = answered_.load(std::memory_order_acquire)) {
    answered_.wait(done);
  }
}

std::vector<std::string> ScriptLink::take_messages() {
  const std::lock_guard lock(messages_mutex_);
  return std::exchange(messages_, {});
}

void ScriptLink::work() noexcept {
  for (std::uint32_t number = 0;; ++number) {
    posted_.wait(number, std::memory_order_acquire);
    if (stop_.load()) return;
    Batch& next = batch(number);
    next.event_count = next.edit_count = 0;
    try {
      answer(next);
    } catch (...) {  // out of memory: as if the scripts had asked for nothing
      next.event_count = next.edit_count = 0;
    }
    answered_.store(number + 1, std::memory_order_release);
    answered_.notify_all();
  }
}

void ScriptLink::answer(Batch& batch) {
  const ScriptView view{&behavior_, batch.signals.data(), batch.parameters.data(),
                        batch.active.data(), batch.time};
  ScriptAnswer answer;
  for (std::size_t k = 0; k < batch.request_count; ++k) {
    const auto index = static_cast<std::size_t>(batch.requests[k].index);
    if (batch.requests[k].is_event) {
      script_.handle(behavior_.events[index], view, answer);
    } else {
      script_.call(behavior_.calls[index].name, view, answer);
    }
  }
  batch.event_count = std::min(answer.events.size(), kAnswers);
  batch.edit_count = std::min(answer.edits.size(), kAnswers);
  std::copy_n(answer.events.begin(), batch.event_count, batch.events.begin());
  std::copy_n(answer.edits.begin(), batch.edit_count, batch.edits.begin());
  if (answer.events.size() > kAnswers || answer.edits.size() > kAnswers) {
    answer.messages.emplace_back("script error: too many events or edits in one tick");
  }
  const std::lock_guard lock(messages_mutex_);
  messages_.insert(messages_.end(), answer.messages.begin(), answer.messages.end());
}

}  // namespace footfall::engine
