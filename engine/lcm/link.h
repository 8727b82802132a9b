// An engine on the network of live tuning, the live port over LCM: a thread that hears requests,
// hands them to the live server, publishes answers, values, catalogue and telemetry. The tick only
// leaves copies for it. Nothing that arrives can end the thread or the process; what is refused is
// counted. What an engine hears is in one datagram each.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "engine/lcm/bus.h"
#include "engine/live/codec.h"
#include "engine/live/key.h"
#include "engine/live/port.h"
#include "engine/live/server.h"

namespace footfall::engine {

struct LinkSettings {
  std::string url = kLiveUrl;
  std::string prefix = kLivePrefix;
  std::optional<LiveKey> key;  // none: everybody's requests are believed
  double telemetry = 50.0;     // messages per second of the run; 0: none
};

struct LinkCounters {
  LiveCounters requests;
  std::int64_t heard_hello = 0, heard_request = 0;  // packets on each channel, good or bad
  std::int64_t hellos = 0;
  std::array<std::int64_t, static_cast<std::size_t>(PacketProblem::count)> rejected{};
  std::int64_t strange = 0;    // datagrams that were no LCM messages
  std::int64_t telemetry = 0;  // messages sent
  std::int64_t dropped = 0;    // and that found no room

  std::int64_t rejected_in_all() const noexcept;
};

class LcmLink final : public LivePort {
 public:
  // Opens the network. Throws std::invalid_argument (URL or prefix) or std::runtime_error (no such
  // network here), each with one sentence.
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

  // What came so far; exact after stop().
  LinkCounters counters() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace footfall::engine
