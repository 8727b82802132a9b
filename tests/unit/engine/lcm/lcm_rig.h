// An engine on the network of live tuning, on a port of its own, with its clients.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <functional>
#include <random>
#include <thread>

#include "engine/lcm/client.h"
#include "engine/lcm/link.h"
#include "engine/live/snapshot.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"
#include "tests/support/live_packets.h"
#include "tests/support/multicast.h"

namespace footfall::tests {

using engine::LiveClient;
using engine::LiveKey;
using engine::PacketProblem;
using testing::ElementsAre;
using testing::HasSubstr;

inline constexpr const char* kTuned = R"(
behavior: 1
robot: hume
parameters:
  speed: {value: 1 m/s, range: [0 m/s, 10 m/s], live: true}
  goal: {value: [0 m, 0 m], range: [-5 m, 5 m], live: true}
events: {go: "from outside"}
machine:
  states:
    float:
      contacts: []
      tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}
      transitions: [{on: go, to: gone}]
    gone: {contacts: [], tasks: {rest: {type: joint_damping, priority: 1, gains: {kd: 20}}}}
)";

inline std::string some_url() {
  std::random_device device;
  const int port = std::uniform_int_distribution<int>(20'000, 60'000)(device);
  return "udpm://239.255.76.67:" + std::to_string(port) + "?ttl=0";
}

inline LiveKey key_of(std::uint8_t byte) {
  LiveKey key{};
  key.fill(byte);
  return key;
}

// True as soon as `done` is, false after a time that no working network takes.
inline bool wait_for(const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

class LcmLink : public testing::Test {
 protected:
  void SetUp() override {
    if (!multicast_works()) GTEST_SKIP() << kNoMulticast;
    strange = std::make_unique<engine::LcmBus>(url);
    strange->subscribe("FOOTFALL_ANSWER", [this](std::span<const std::uint8_t> packet) {
      overheard.emplace_back(packet.begin(), packet.end());
    });
    open({url, "FOOTFALL", key_of(1), 200.0});
  }
  void TearDown() override { end(); }

  void open(const engine::LinkSettings& settings) {
    link = std::make_unique<engine::LcmLink>(*rig.loop, settings);
  }
  void tick() {
    rig.loop->sense();
    rig.loop->compute();
    link->post(*rig.loop, 1000);
    rig.loop->actuate();
  }
  // Ticks until end().
  void begin() {
    rig.loop->start();
    link->start();
    ticking = std::thread([this] {
      while (!done.load()) {
        tick();
        std::this_thread::sleep_for(std::chrono::microseconds(300));
      }
    });
  }
  void end() {
    done = true;
    if (ticking.joinable()) ticking.join();
    if (link) link->stop();
  }
  std::unique_ptr<LiveClient> client(const LiveKey& key, const std::string& who = "ann") const {
    return std::make_unique<LiveClient>(engine::LiveClientSettings{url, "FOOTFALL", key, who, 0.1});
  }
  static footfall_lcm::request_t set(const char* name, std::vector<double> values) {
    footfall_lcm::request_t request{};
    request.revision = -1;
    request.changes.push_back({name, -1, 0, std::move(values)});
    return request;
  }
  std::int64_t rejected(PacketProblem problem) const {
    return link->counters().rejected[static_cast<std::size_t>(problem)];
  }

  const std::string url = some_url();
  StubRig rig{kTuned};
  std::unique_ptr<engine::LcmLink> link;
  std::unique_ptr<engine::LcmBus> strange;  // somebody without manners
  std::vector<engine::PacketBytes> overheard;
  std::thread ticking;
  std::atomic<bool> done{false};
};

}  // namespace footfall::tests
