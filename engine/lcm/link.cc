// The link's thread; see link.h.
#include "engine/lcm/link.h"

#include <sodium.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/hello_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/telemetry_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <mutex>
#include <numeric>
#include <thread>
#include <utility>

#include "core/process/machine_error.h"
#include "engine/live/host_name.h"
#include "engine/live/snapshot.h"
#include "engine/tick/control_loop.h"

namespace footfall::engine {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr std::size_t kEntrance = 1;  // the link's entrance of the edit door
// Minimum intervals of messages, and the maximum interval of values.
constexpr milliseconds kCatalogueApart{100}, kValuesApart{20}, kMovingApart{100}, kValuesPause{500};
// Waiting time for packets: while an edit is waiting for the tick, and otherwise.
constexpr int kBusyWait = 1, kIdleWait = 5;  // ms

std::int64_t random_number() {
  if (sodium_init() < 0) throw core::MachineError("this machine gives no random numbers");
  std::int64_t number = 0;
  randombytes_buf(&number, sizeof number);
  return std::max<std::int64_t>(1, number & INT64_MAX);
}

}  // namespace

// The link's data for one loop.
struct LinkBinding final : LiveBinding {
  LinkBinding(ControlLoop& loop, const LinkSettings& how)
      : behavior(loop.behavior()),
        entrance(loop.edits().entrance(kEntrance)),
        feed(loop, how.telemetry),
        edited(behavior, how.world) {}
  const behaviors::Behavior& behavior;
  EditEntrance& entrance;
  LiveFeed feed;
  behaviors::EditedValues edited;
};

std::int64_t LinkCounters::rejected_in_all() const noexcept {
  return std::accumulate(rejected.begin(), rejected.end(), std::int64_t{0});
}

struct LcmLink::Impl {
  Impl(ControlLoop& loop, const LinkSettings& how)
      : settings(how),
        binding(std::make_unique<LinkBinding>(loop, how)),
        posting(binding.get()),
        server(loop.behavior(), binding->entrance, identity(how.key.has_value())),
        bus(how.url) {
    server.judge_by(&binding->edited);
    bus.subscribe(channel("HELLO"), [this](auto packet) { take_hello(packet); });
    bus.subscribe(channel("REQUEST"), [this](auto packet) { take_request(packet); });
  }

  static LiveSettings identity(bool keyed) {
    LiveSettings own{random_number(), keyed, host_name(), ::getpid(), 0};
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    own.start = std::chrono::duration_cast<std::chrono::microseconds>(now).count();
    return own;
  }

  // --- The link's thread. ---
  std::string channel(const char* name) const { return settings.prefix + "_" + name; }
  const LiveKey* key() const { return settings.key ? &*settings.key : nullptr; }

  template <class Message>
  void publish(const char* name, Message&& message) {
    bus.publish(channel(name), encode(std::forward<Message>(message), key()));
  }

  template <class Message>
  bool read(std::span<const std::uint8_t> packet, Message& message) {
    const PacketProblem problem = decode(packet, key(), message);
    if (problem == PacketProblem::none) return true;
    ++counters.rejected[static_cast<std::size_t>(problem)];
    tell_version(problem);
    return false;
  }

  void tell_version(PacketProblem problem) {
    const bool other =
        problem == PacketProblem::wrong_type || problem == PacketProblem::other_protocol;
    if (!other || std::exchange(version_told, true)) return;
    std::fprintf(stderr,
                 "footfall: warning: a program of another version sends to %s_*: it is not "
                 "understood (this is protocol %d)\n",
                 settings.prefix.c_str(), static_cast<int>(footfall_lcm::hello_t::PROTOCOL));
  }

  void take_hello(std::span<const std::uint8_t> packet) {
    footfall_lcm::hello_t hello;
    ++counters.heard_hello;
    if (!read(packet, hello)) return;
    ++counters.hellos;
    catalogue_wanted |= hello.session == 0 || hello.session == server.session();
  }

  void take_request(std::span<const std::uint8_t> packet) {
    footfall_lcm::request_t request;
    ++counters.heard_request;
    if (!read(packet, request)) return;
    server.request(request, answers);
    publish_answers();
  }

  void publish_answers() {
    for (footfall_lcm::answer_t& answer : answers) publish("ANSWER", std::move(answer));
    answers.clear();
  }

  void publish_catalogue(Clock::time_point now) {
    if (!catalogue_wanted || now - catalogue_at < kCatalogueApart) return;
    catalogue_wanted = false;
    catalogue_at = now;
    footfall_lcm::catalogue_t catalogue;
    server.fill_catalogue(catalogue);
    publish("CATALOGUE", std::move(catalogue));
    values_wanted = true;  // a client that asks for the catalogue needs the values, too
  }

  void publish_telemetry(const LiveSnapshot& snapshot) {
    telemetry.session = server.session();
    telemetry.generation = server.generation();
    telemetry.revision = server.revision_of(snapshot.revision);
    telemetry.dropped = binding->feed.dropped() + dropped_before;
    fill_telemetry(snapshot, binding->behavior, telemetry);
    publish("TELEMETRY", telemetry);
    ++counters.telemetry;
  }

  bool values_due(const LiveSnapshot& snapshot, Clock::duration since) const {
    if (snapshot.state != LoopState::running || since >= kValuesPause) return true;
    const bool moving = snapshot.now != snapshot.target;
    // Each row of telemetry follows its values: a client must not show them with another time.
    const bool stale = moving || told_moving || snapshot.revision != told_revision;
    if (snapshot.telemetry && stale) return true;
    const bool changed = values_wanted || server.changed() || (told_moving && !moving);
    return (changed && since >= kValuesApart) || (moving && since >= kMovingApart);
  }

  void publish_values(const LiveSnapshot& snapshot, Clock::time_point now) {
    footfall_lcm::values_t values;
    server.fill_values({snapshot.tick, snapshot.revision, snapshot.now, snapshot.target}, values);
    publish("VALUES", std::move(values));
    values_at = now;
    values_wanted = false;
    told_moving = snapshot.now != snapshot.target;
    told_revision = snapshot.revision;
  }

  // Publishes telemetry of all snapshots, and before it the values that are due.
  void take_snapshots(Clock::time_point now) {
    while (const LiveSnapshot* snapshot = binding->feed.front()) {
      if (values_due(*snapshot, now - values_at)) publish_values(*snapshot, now);
      if (snapshot->telemetry) publish_telemetry(*snapshot);
      binding->feed.pop();
    }
  }

  void take_rebinding() {
    if (!rebinding.load(std::memory_order_acquire)) return;
    take_snapshots(Clock::now());
    dropped_before += binding->feed.dropped();
    server.rebind(next->behavior, next->entrance, "the behavior was loaded anew", answers);
    publish_answers();
    binding = std::move(next);
    server.judge_by(&binding->edited);
    catalogue_wanted = true;
    rebinding.store(false, std::memory_order_release);
  }

  void once() {
    bus.poll(binding->entrance.outstanding() > 0 ? kBusyWait : kIdleWait);
    server.poll(answers);
    publish_answers();
    const Clock::time_point now = Clock::now();
    publish_catalogue(now);
    take_snapshots(now);
    take_rebinding();
    tell_counters();
  }

  void tell_counters() {
    counters.requests = server.counters();
    counters.strange = bus.strange();
    counters.dropped = dropped_before + binding->feed.dropped();
    const std::lock_guard lock(told_mutex);
    told = counters;
  }

  void work() noexcept {
    while (!stopping.load(std::memory_order_acquire)) guarded([this] { once(); });
    guarded([this] {
      once();  // the last tick's snapshot
      server.rebind(binding->behavior, binding->entrance, "the run has ended", answers);
      publish_answers();
      publish_end();
      tell_counters();
    });
  }

  // Most runs end in a tick like any other: by time, by steps, by hand.
  void publish_end() {
    if (counters.telemetry == 0) return;
    telemetry.condition = footfall_lcm::telemetry_t::ENDED;
    publish("TELEMETRY", telemetry);
  }

  // After an exception (such as out of memory) the current item is lost, the next one is handled.
  template <class Step>
  static void guarded(Step&& step) noexcept {
    try {
      step();
    } catch (...) {
    }
  }

  const LinkSettings settings;
  std::unique_ptr<LinkBinding> binding;
  LinkBinding* posting;  // used by the tick's thread
  LiveServer server;
  LcmBus bus;
  LiveServer::Answers answers;
  footfall_lcm::telemetry_t telemetry;  // reused to keep its memory
  LinkCounters counters;
  std::uint64_t told_revision = 0;  // of the door, in the values published last
  std::int64_t dropped_before = 0;  // snapshots dropped by the feeds of replaced loops
  bool catalogue_wanted = true, values_wanted = true, told_moving = false, version_told = false;
  Clock::time_point catalogue_at, values_at;

  // --- Between the threads. ---
  std::unique_ptr<LinkBinding> next;  // of the tick's thread until `rebinding`, then of the link's
  std::atomic<bool> rebinding{false}, stopping{false};
  mutable std::mutex told_mutex;  // never locked by the tick
  LinkCounters told;
  std::thread thread;
};

LcmLink::LcmLink(ControlLoop& loop, const LinkSettings& settings) {
  check_live_prefix(settings.prefix);
  impl_ = std::make_unique<Impl>(loop, settings);
}

LcmLink::~LcmLink() { stop(); }

void LcmLink::start() {
  impl_->thread = std::thread([impl = impl_.get()] { impl->work(); });
}

void LcmLink::post(const ControlLoop& loop, std::int64_t tick_ns) noexcept {
  impl_->posting->feed.post(loop, tick_ns);
}

void LcmLink::stop() noexcept {
  if (!impl_->thread.joinable()) return;
  impl_->stopping.store(true, std::memory_order_release);
  impl_->thread.join();
}

std::unique_ptr<LiveBinding> LcmLink::prepare(ControlLoop& loop) const {
  return std::make_unique<LinkBinding>(loop, impl_->settings);
}

void LcmLink::rebind(std::unique_ptr<LiveBinding> binding) noexcept {
  impl_->next.reset(static_cast<LinkBinding*>(binding.release()));  // created by prepare()
  impl_->posting = impl_->next.get();
  impl_->rebinding.store(true, std::memory_order_release);
}

bool LcmLink::rebound() const noexcept { return !impl_->rebinding.load(std::memory_order_acquire); }

LinkCounters LcmLink::counters() const {
  const std::lock_guard lock(impl_->told_mutex);
  return impl_->told;
}

}  // namespace footfall::engine
