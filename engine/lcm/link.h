// Connects an engine to the network of live tuning: a thread receives requests, passes them to the
// live server, and publishes answers, values, catalogue and telemetry. The tick only provides
// copies. No packet can end the thread or the process; rejected ones are counted. Packets to the
// engine must fit in one datagram.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "behaviors/check/physics/check.h"
#include "engine/lcm/bus.h"
#include "engine/live/codec.h"
#include "engine/live/key.h"
#include "engine/live/server.h"
#include "engine/realtime/live_port.h"

namespace footfall::engine {

struct LinkSettings {
  std::string url = kLiveUrl;
  std::string prefix = kLivePrefix;
  std::optional<LiveKey> key;       // none: requests of all clients are accepted
  double telemetry = 50.0;          // messages per second of the run; 0: none
  behaviors::PhysicsWorld world{};  // edits are judged in it, as `run` judges a behavior
};

struct LinkCounters {
  LiveCounters requests;
  std::int64_t heard_hello = 0, heard_request = 0;  // packets on each channel, valid or not
  std::int64_t hellos = 0;
  std::array<std::int64_t, static_cast<std::size_t>(PacketProblem::count)> rejected{};
  std::int64_t strange = 0;    // malformed datagrams
  std::int64_t telemetry = 0;  // messages sent
  std::int64_t dropped = 0;    // messages dropped because of a full queue

  std::int64_t rejected_in_all() const noexcept;
};

class LcmLink final : public LivePort {
 public:
  // Opens the network. Throws std::invalid_argument (URL or prefix) or std::runtime_error (network
  // not available), each with one sentence.
  LcmLink(ControlLoop& loop, const LinkSettings& settings);
  ~LcmLink() override;
  LcmLink(const LcmLink&) = delete;
  LcmLink& operator=(const LcmLink&) = delete;

  void start() override;
  void post(const ControlLoop& loop, std::int64_t tick_ns) noexcept override;
  void stop() noexcept override;
  std::unique_ptr<LiveBinding> prepare(ControlLoop& loop) const override;
  void rebind(std::unique_ptr<LiveBinding> binding) noexcept override;
  bool rebound() const noexcept override;

  // Current counters; exact after stop().
  LinkCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
