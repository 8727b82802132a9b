// Copies the state in the tick, and builds messages outside of it; see snapshot.h.
#include "engine/live/snapshot.h"

#include <algorithm>
#include <cmath>
#include <footfall_lcm/telemetry_t.hpp>

#include "core/index.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {
namespace {

constexpr std::size_t kSnapshots = 64;
constexpr double kValuesRate = 50.0;  // 1/s

std::int64_t ticks_between(const ControlLoop& loop, double rate) {
  if (!(rate > 0.0)) return 0;
  return std::max<std::int64_t>(1, std::llround(1.0 / (rate * loop.period())));
}

LiveSnapshot empty_snapshot(const behaviors::Behavior& behavior) {
  LiveSnapshot snapshot;
  snapshot.now.resize(behavior.values.size());
  snapshot.target.resize(behavior.values.size());
  snapshot.signals.resize(at(behavior.signals.size()));
  snapshot.active.resize(behavior.states.size());
  snapshot.tasks.resize(behavior.task_names.size());
  return snapshot;
}

// Names of the active tasks, each once.
void copy_tasks(const ControlLoop& loop, LiveSnapshot& to) noexcept {
  const tasks::ControlSet& set = loop.machine().control().primary;
  to.task_count = 0;
  for (int t = 0; t < set.task_count; ++t) {
    const int name = loop.behavior().task_instances[at(set.tasks[at(t)].instance)].signals;
    const auto end = to.tasks.begin() + static_cast<std::ptrdiff_t>(to.task_count);
    if (std::find(to.tasks.begin(), end, name) == end) to.tasks[to.task_count++] = name;
  }
}

void copy(const ControlLoop& loop, LiveSnapshot& to) noexcept {
  to.tick = loop.ticks();
  to.time = loop.time();
  to.state = loop.state();
  to.revision = loop.edits().revision();
  const auto parameters = loop.machine().parameters();
  std::copy(parameters.begin(), parameters.end(), to.now.begin());
  loop.edits().ramps().copy_targets(parameters, to.target);
  std::copy_n(loop.signals().values(), to.signals.size(), to.signals.begin());
  const auto active = loop.machine().active_atomic();
  to.active_count = std::min(active.size(), to.active.size());
  std::copy_n(active.begin(), to.active_count, to.active.begin());
  copy_tasks(loop, to);
  for (std::size_t f = 0; f < to.faults.count.size(); ++f) {
    to.faults.count[f] = loop.faults().count[f] + loop.machine().faults().count[f];
  }
}

}  // namespace

LiveFeed::LiveFeed(const ControlLoop& loop, double rate)
    : ring_(kSnapshots, empty_snapshot(loop.behavior())),
      telemetry_every_(ticks_between(loop, rate)),
      values_every_(ticks_between(loop, kValuesRate)) {}

void LiveFeed::post(const ControlLoop& loop, std::int64_t tick_ns) noexcept {
  worst_ns_ = std::max(worst_ns_, tick_ns);
  const bool last = loop.state() != LoopState::running;
  const bool telemetry = telemetry_every_ > 0 && (last || loop.ticks() % telemetry_every_ == 0);
  if (!telemetry && !last && loop.ticks() % values_every_ != 0) return;
  LiveSnapshot* const to = ring_.next();
  if (to == nullptr) {
    dropped_.fetch_add(telemetry ? 1 : 0, std::memory_order_relaxed);
    return;
  }
  to->telemetry = telemetry;
  to->tick_ns = tick_ns;
  to->worst_ns = worst_ns_;
  copy(loop, *to);
  ring_.publish();
  if (telemetry) worst_ns_ = 0;
}

const LiveSnapshot* LiveFeed::front() noexcept {
  return ring_.waiting() > 0 ? &ring_.at(0) : nullptr;
}

void fill_telemetry(const LiveSnapshot& snapshot, const behaviors::Behavior& behavior,
                    footfall_lcm::telemetry_t& message) {
  const behaviors::SignalLayout& layout = behavior.layout;
  const auto signal = [&](int index) { return index < 0 ? 0.0 : snapshot.signals[at(index)]; };
  message.tick = snapshot.tick;
  message.time = snapshot.time;
  message.condition = static_cast<std::int8_t>(snapshot.state);
  message.active.assign(
      snapshot.active.begin(),
      snapshot.active.begin() + static_cast<std::ptrdiff_t>(snapshot.active_count));
  message.tasks.clear();
  for (std::size_t t = 0; t < snapshot.task_count; ++t) {
    const behaviors::TaskSignals& task = layout.task[at(snapshot.tasks[t])];
    footfall_lcm::task_t& out = message.tasks.emplace_back();
    out.name = snapshot.tasks[t];
    out.error = signal(task.error);
    out.authority = signal(task.authority);
  }
  message.forces.clear();
  for (const int force : layout.force) {
    message.forces.push_back({signal(force), signal(force + 1), signal(force + 2)});
  }
  message.faults.assign(snapshot.faults.count.begin(), snapshot.faults.count.end());
  message.tick_us = static_cast<float>(snapshot.tick_ns) * 1e-3F;
  message.tick_us_worst = static_cast<float>(snapshot.worst_ns) * 1e-3F;
  message.signals.resize(snapshot.signals.size());
  std::transform(snapshot.signals.begin(), snapshot.signals.end(), message.signals.begin(),
                 [](double value) { return static_cast<float>(value); });
}

static_assert(static_cast<int>(LoopState::running) == footfall_lcm::telemetry_t::RUNNING &&
              static_cast<int>(LoopState::finished) == footfall_lcm::telemetry_t::FINISHED &&
              static_cast<int>(LoopState::fallen) == footfall_lcm::telemetry_t::FALLEN &&
              static_cast<int>(LoopState::stopped) == footfall_lcm::telemetry_t::STOPPED);

}  // namespace footfall::engine
