// A live server at the door of a small statechart, and requests of somebody called Ann.
#pragma once

#include <gtest/gtest.h>

#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <string>
#include <utility>
#include <vector>

#include "engine/live/server.h"
#include "tests/unit/engine/doored_chart.h"

namespace footfall::tests {

inline constexpr std::int64_t kTunedSession = 4711;

inline constexpr const char* kTunedChart = R"(
behavior: 1
parameters:
  lift_time: {value: 145 ms, range: [80 ms, 400 ms], live: true, doc: "of a swing"}
  goal: {value: [0 m, 0 m], range: [-5 m, 5 m], live: true}
  fixed: {value: 2 s, range: [1 s, 3 s]}
events: {go: "from outside", stop: "from outside"}
machine:
  states:
    idle: {transitions: [{on: go, to: gone}]}
    gone: {transitions: [{on: stop, to: idle}, {when: "$goal.x > 100 m", to: idle}]}
)";

// Keeps what the door showed to the log.
struct LoggedChart : DooredChart {
  LoggedChart() : DooredChart(kTunedChart, 64) {}
  void tick() {
    DooredChart::tick();
    for (std::size_t i = 0; i < door->taken(); ++i) log.push_back(door->taken(i));
  }

  std::vector<engine::EditOrder> log;
};

class LiveServer : public testing::Test {
 protected:
  // One that changes what is given, as client 1 and the next of its sequence.
  footfall_lcm::request_t edit(
      const std::vector<std::pair<std::string, std::vector<double>>>& changes) {
    footfall_lcm::request_t request{};
    request.session = kTunedSession;
    request.client = 1;
    request.sequence = ++sequence;
    request.who = "ann@bench";
    request.revision = -1;
    for (const auto& [name, values] : changes) {
      footfall_lcm::change_t change{};
      change.name = name;
      change.component = -1;
      change.values = values;
      request.changes.push_back(change);
    }
    return request;
  }
  footfall_lcm::request_t ask(std::int8_t what) {
    footfall_lcm::request_t request = edit({});
    request.what = what;
    return request;
  }
  // The answers of a request that the tick, if it comes to that, handles at once.
  std::vector<footfall_lcm::answer_t> answers(const footfall_lcm::request_t& request) {
    std::vector<footfall_lcm::answer_t> all;
    server.request(request, all);
    bench.tick();
    server.poll(all);
    return all;
  }
  footfall_lcm::answer_t answer(const footfall_lcm::request_t& request) {
    const auto all = answers(request);
    EXPECT_EQ(all.size(), 1U);
    return all.empty() ? footfall_lcm::answer_t{} : all.front();
  }
  std::string reasons(const footfall_lcm::request_t& request) {
    const footfall_lcm::answer_t a = answer(request);
    EXPECT_FALSE(a.accepted);
    EXPECT_EQ(a.tick, -1);
    EXPECT_EQ(static_cast<std::size_t>(a.reason_count), a.reasons.size());
    std::string text;
    for (const std::string& reason : a.reasons) text += reason + "\n";
    return text;
  }
  footfall_lcm::values_t values() {
    std::vector<double> targets(bench.machine->parameters().size());
    bench.door->ramps().copy_targets(bench.machine->parameters(), targets);
    footfall_lcm::values_t out{};
    server.fill_values({bench.now, bench.door->revision(), bench.machine->parameters(), targets},
                       out);
    return out;
  }

  LoggedChart bench;
  engine::LiveServer server{*bench.behavior, bench.door->entrance(1), {kTunedSession, true}};
  std::int64_t sequence = 0;
};

}  // namespace footfall::tests
