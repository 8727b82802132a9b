// Requests of people in, answers out: done once, whole or not at all, answered with every reason,
// undone and done again; nothing of it needs a network.
#include "engine/live_server.h"

#include <gtest/gtest.h>

#include <cmath>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <limits>
#include <random>
#include <set>

#include "behaviors/loader.h"
#include "engine/live_clients.h"
#include "tests/support/no_measure.h"

namespace footfall::tests {
namespace {

using engine::LiveClients;
using footfall_lcm::answer_t;
using footfall_lcm::request_t;

constexpr std::int64_t kSession = 4711;

constexpr const char* kTuned = R"(
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

// A statechart of 1 kHz, its door, and a server at entrance 1.
struct Bench {
  Bench() {
    core::Diagnostics diagnostics;
    behavior = behaviors::load_behavior_text(kTuned, "chart.yaml", {}, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    signals = behavior->signals;
    machine = std::make_unique<behaviors::Machine>(*behavior, signals);
    door = std::make_unique<engine::EditDoor>(*behavior);
    machine->start(measure);
  }
  void tick() {
    door->apply(now, *machine);
    for (std::size_t i = 0; i < door->taken(); ++i) log.push_back(door->taken(i));
    machine->tick(now++, measure);
  }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  std::unique_ptr<behaviors::Machine> machine;
  std::unique_ptr<engine::EditDoor> door;
  NoMeasure measure;
  std::int64_t now = 0;
  std::vector<engine::EditOrder> log;
};

class Server : public testing::Test {
 protected:
  // One that changes what is given, as client 1 and the next of its sequence.
  request_t edit(const std::vector<std::pair<std::string, std::vector<double>>>& changes) {
    request_t request{};
    request.session = kSession;
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
  request_t ask(std::int8_t what) {
    request_t request = edit({});
    request.what = what;
    return request;
  }
  // The answers of a request that the tick, if it comes to that, handles at once.
  std::vector<answer_t> answers(const request_t& request) {
    std::vector<answer_t> all;
    server.request(request, all);
    bench.tick();
    server.poll(all);
    return all;
  }
  answer_t answer(const request_t& request) {
    const auto all = answers(request);
    EXPECT_EQ(all.size(), 1U);
    return all.empty() ? answer_t{} : all.front();
  }
  std::string reasons(const request_t& request) {
    const answer_t a = answer(request);
    EXPECT_FALSE(a.accepted);
    EXPECT_EQ(a.tick, -1);
    EXPECT_EQ(static_cast<std::size_t>(a.reason_count), a.reasons.size());
    std::string text;
    for (const std::string& reason : a.reasons) text += reason + "\n";
    return text;
  }
  footfall_lcm::values_t values() {
    std::vector<double> targets(bench.machine->parameters().size());
    bench.door->copy_targets(bench.machine->parameters(), targets);
    footfall_lcm::values_t out{};
    server.fill_values({bench.now, bench.door->revision(), bench.machine->parameters(), targets},
                       out);
    return out;
  }

  Bench bench;
  engine::LiveServer server{*bench.behavior, bench.door->entrance(1), {kSession, true}};
  std::int64_t sequence = 0;
};

using LiveServer = Server;

TEST_F(LiveServer, AnEditIsAnsweredByTheTickThatAppliedItInWords) {
  request_t request = edit({{"lift_time", {0.15}}, {"goal", {1.0, -2.5}}});
  request.over = 0.1;
  request.events = {"go"};
  std::vector<answer_t> all;
  server.request(request, all);
  server.poll(all);
  EXPECT_TRUE(all.empty());
  bench.now = 30;
  bench.tick();
  server.poll(all);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_TRUE(all[0].accepted);
  EXPECT_EQ(all[0].session, kSession);
  EXPECT_EQ(all[0].client, 1);
  EXPECT_EQ(all[0].sequence, 1);
  EXPECT_EQ(all[0].who, "ann@bench");
  EXPECT_EQ(all[0].tick, 30);
  EXPECT_EQ(all[0].revision, 1);
  EXPECT_EQ(all[0].text, "lift_time = 150 ms, goal = [1 m, -2.5 m] over 100 ms, raise go");
  EXPECT_EQ(all[0].reason_count, 0);
  EXPECT_EQ(server.counters().applied, 1);
}

TEST_F(LiveServer, ValuesAreToldInTheCataloguesOrderWithWhereTheyAreGoing) {
  footfall_lcm::catalogue_t catalogue{};
  server.fill_catalogue(catalogue);
  ASSERT_EQ(catalogue.parameter_count, 2);
  EXPECT_EQ(catalogue.parameters[0].name, "lift_time");
  EXPECT_EQ(catalogue.parameters[0].unit, "s");
  EXPECT_EQ(catalogue.parameters[0].doc, "of a swing");
  EXPECT_TRUE(catalogue.parameters[0].has_range);
  EXPECT_EQ(catalogue.parameters[0].max, 0.4);
  EXPECT_EQ(catalogue.parameters[1].first, 1);
  EXPECT_EQ(catalogue.parameters[1].size, 2);
  EXPECT_EQ(catalogue.values, (std::vector<double>{0.145, 0.0, 0.0}));
  EXPECT_EQ(catalogue.events, (std::vector<std::string>{"go", "stop"}));
  EXPECT_EQ(catalogue.rate, 1000.0);
  EXPECT_EQ(catalogue.states, (std::vector<std::string>{"machine", "idle", "gone"}));
  EXPECT_TRUE(catalogue.keyed);
  EXPECT_TRUE(server.changed());  // nobody was told yet
  EXPECT_EQ(values().now, catalogue.values);
  EXPECT_FALSE(server.changed());
  request_t request = edit({{"goal.y", {4.0}}});
  request.over = 4e-3;
  EXPECT_EQ(answer(request).text, "goal.y = 4 m over 4 ms");
  EXPECT_TRUE(server.changed());
  bench.tick();
  const footfall_lcm::values_t told = values();
  EXPECT_EQ(told.now, (std::vector<double>{0.145, 0.0, 1.0}));
  EXPECT_EQ(told.target, (std::vector<double>{0.145, 0.0, 4.0}));
  EXPECT_EQ(told.revision, 1);
  EXPECT_EQ(told.undo_count, 1);
  EXPECT_EQ(told.count, 3);
}

TEST_F(LiveServer, EveryReasonIsToldAtOnceAndNothingIsDone) {
  request_t request = edit({{"lift_tme", {0.1}},
                            {"lift_time", {0.5}},
                            {"goal", {1.0}},
                            {"goal.x", {std::nan("")}},
                            {"fixed", {2.0}}});
  request.changes[2].component = 7;
  request.events = {"goo", "error.execution"};
  request.over = std::numeric_limits<double>::infinity();
  request.revision = 3;
  EXPECT_EQ(reasons(request),
            "no parameter 'lift_tme' (did you mean 'lift_time'?)\n"
            "no event 'goo' (did you mean 'go'?)\n"
            "revision 3 was expected, 0 is in force: read it again\n"
            "lift_time: 0.5 s is out of its range, 0.08 s to 0.4 s\n"
            "goal: no component 7, it has 2 values\n"
            "goal[0]: nan is not a finite number\n"
            "fixed: not live; give it a range and 'live: true'\n"
            "error.execution: raised by the engine only\n"
            "over: inf s is out of its range, 0 s to 1e+06 s\n");
  EXPECT_EQ(server.revision(), 0);
  EXPECT_EQ(values().now, (std::vector<double>{0.145, 0.0, 0.0}));
  EXPECT_EQ(server.counters().refused, 1);
}

TEST_F(LiveServer, WhatCannotBeMeantIsRefused) {
  EXPECT_EQ(reasons(edit({})), "nothing is changed or raised\n");
  EXPECT_EQ(reasons(ask(7)), "what: 0 (edit), 1 (undo) or 2 (redo) was expected, got 7\n");
  request_t request = edit({{"goal", {1.0, 1.0}}});
  request.revision = -2;
  EXPECT_EQ(reasons(request), "revision -2: -1 or more was expected\n");
  request = ask(request_t::UNDO);
  request.events = {"go"};
  EXPECT_EQ(reasons(request), "undo: takes no changes or events\nthere is nothing to undo\n");
  EXPECT_EQ(reasons(ask(request_t::REDO)), "there is nothing to redo\n");
  request = edit({{"lift_time", {0.1}}, {"lift_time", {0.2}}});
  EXPECT_EQ(reasons(request), "lift_time: given twice\n");
  request = edit({});
  request.changes.resize(1000);
  EXPECT_EQ(reasons(request), "1000 changes: at most 32 in one edit\n");
  request = edit({});
  request.events.resize(1000);
  EXPECT_EQ(reasons(request), "1000 events: at most 16 in one edit\n");
  request = edit({{"goal.x", {1.0}}});
  request.changes[0].component = 0;
  EXPECT_EQ(reasons(request), "goal.x: is one value\n");
  request = edit({{std::string(5000, '\x1b'), {1.0}}});
  EXPECT_EQ(reasons(request), "no parameter '" + std::string(96, '?') + "'\n");
}

TEST_F(LiveServer, ARepeatedRequestIsAnsweredTheSameAndNotDoneAgain) {
  const request_t request = edit({{"lift_time", {0.15}}});
  const answer_t first = answer(request);
  EXPECT_TRUE(first.accepted);
  answer(edit({{"lift_time", {0.2}}}));
  const answer_t again = answer(request);
  EXPECT_EQ(again.tick, first.tick);
  EXPECT_EQ(again.text, first.text);
  EXPECT_EQ(again.revision, 1);
  EXPECT_EQ(values().now[0], 0.2);
  EXPECT_EQ(server.revision(), 2);
  const request_t wrong = edit({{"lift_time", {9.0}}});
  EXPECT_EQ(reasons(wrong), reasons(wrong));
  EXPECT_EQ(server.counters().repeated, 2);
  EXPECT_EQ(server.counters().refused, 1);
}

TEST_F(LiveServer, ARepetitionBeforeTheFirstAnswerIsSilent) {
  const request_t request = edit({{"lift_time", {0.15}}});
  std::vector<answer_t> all;
  for (int k = 0; k < 5; ++k) server.request(request, all);
  bench.tick();
  server.poll(all);
  EXPECT_EQ(all.size(), 1U);
  EXPECT_EQ(server.revision(), 1);
}

TEST_F(LiveServer, RequestsMayOvertakeEachOtherButOldOnesAreNotDoneAgain) {
  const request_t late = edit({{"goal.x", {1.0}}});
  const request_t old = edit({{"goal.y", {2.0}}});
  const request_t later = edit({{"goal.y", {3.0}}});
  EXPECT_TRUE(answer(later).accepted);
  EXPECT_TRUE(answer(late).accepted);
  sequence += LiveClients::kWindow;
  EXPECT_TRUE(answer(edit({{"lift_time", {0.2}}})).accepted);
  for (const request_t& request : {old, late}) {
    EXPECT_EQ(reasons(request), "sequence " + std::to_string(request.sequence) +
                                    " is too old: newer ones of this client were seen\n");
  }
  EXPECT_EQ(values().now, (std::vector<double>{0.2, 1.0, 3.0}));
  request_t zero = edit({{"goal.x", {0.0}}});
  zero.sequence = 0;
  EXPECT_EQ(reasons(zero), "sequence: a client counts its requests from 1\n");
}

TEST_F(LiveServer, AnotherSessionsRequestIsRefused) {
  request_t request = edit({{"lift_time", {0.15}}});
  request.session = kSession + 1;
  EXPECT_EQ(reasons(request), "the session is another one: read the catalogue again\n");
  request.session = kSession;
  EXPECT_TRUE(answer(request).accepted);  // it was not counted as seen
}

TEST_F(LiveServer, OfTwoThatExpectOneRevisionTheSecondIsToldAndCanTryAgain) {
  request_t ann = edit({{"lift_time", {0.15}}});
  request_t bob = edit({{"lift_time", {0.16}}});
  bob.client = 2;
  bob.who = "bob";
  ann.revision = bob.revision = 0;
  std::vector<answer_t> all;
  server.request(ann, all);
  server.request(bob, all);  // nothing is applied yet: the tick decides
  bench.tick();
  server.poll(all);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_TRUE(all[0].accepted);
  EXPECT_FALSE(all[1].accepted);
  EXPECT_EQ(all[1].reasons, std::vector<std::string>{
                                "revision 1 is in force, another was expected: read it again"});
  EXPECT_EQ(values().now[0], 0.15);
  ++bob.sequence;
  bob.revision = 1;
  EXPECT_TRUE(answer(bob).accepted);
}

TEST_F(LiveServer, AnUndoWaitsForWhatIsOnItsWay) {
  std::vector<answer_t> all;
  server.request(edit({{"lift_time", {0.15}}}), all);
  server.request(ask(request_t::UNDO), all);
  server.request(edit({{"goal.x", {2.0}}}), all);  // after the undo, as it was asked
  for (int k = 0; k < 3; ++k) {
    bench.tick();
    server.poll(all);
  }
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[1].text, "undo: lift_time = 145 ms");
  EXPECT_EQ(all[2].sequence, 3);
  EXPECT_EQ(values().now, (std::vector<double>{0.145, 2.0, 0.0}));
  EXPECT_EQ(values().undo_count, 1);
  EXPECT_EQ(values().redo_count, 0);  // something new was done
}

TEST_F(LiveServer, RequestsThatWaitAreBounded) {
  std::vector<answer_t> all;
  server.request(edit({{"lift_time", {0.15}}}), all);
  for (int k = 0; k < 64; ++k) server.request(ask(request_t::UNDO), all);
  EXPECT_TRUE(all.empty());
  server.request(edit({{"goal.x", {2.0}}}), all);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].reasons, std::vector<std::string>{"64 requests wait already: try again"});
  for (int k = 0; k < 3; ++k) {
    bench.tick();
    server.poll(all);
  }
  EXPECT_EQ(all.size(), 66U);  // one undo was possible, 63 found nothing
  EXPECT_EQ(server.counters().applied, 2);
}

TEST_F(LiveServer, AnUndoGoesBackToWhereValuesWereGoingAndRaisesNothing) {
  request_t slow = edit({{"goal", {4.0, 4.0}}});
  slow.over = 1.0;
  EXPECT_TRUE(answer(slow).accepted);
  request_t interrupting = edit({{"goal", {1.0, 1.0}}});
  interrupting.events = {"go"};
  EXPECT_TRUE(answer(interrupting).accepted);
  EXPECT_TRUE(answer(ask(request_t::UNDO)).accepted);
  EXPECT_EQ(values().now[1], 4.0);
  EXPECT_TRUE(answer(ask(request_t::UNDO)).accepted);
  EXPECT_EQ(values().now[1], 0.0);
  request_t redo = ask(request_t::REDO);
  redo.over = 2e-3;
  EXPECT_EQ(answer(redo).text, "redo: goal = [4 m, 4 m] over 2 ms");
  EXPECT_EQ(values().target[1], 4.0);
  EXPECT_EQ(bench.log.back().note.view(), "redo");
  EXPECT_EQ(bench.log.back().event_count, 0U);
}

TEST_F(LiveServer, EventsAloneCannotBeUndone) {
  request_t go = edit({});
  go.events = {"go"};
  EXPECT_EQ(answer(go).text, "raise go");
  EXPECT_EQ(reasons(ask(request_t::UNDO)), "there is nothing to undo\n");
}

TEST_F(LiveServer, TheLogHearsWhoAskedForWhatAndWhatWasRefused) {
  request_t request = edit({{"lift_time", {0.15}}});
  request.who =
      "a\x1b[2J\xff"
      "b\u00e9" +
      std::string(100, 'x');
  const answer_t told = answer(request);
  const std::string shown = "a?[2J?b\u00e9" + std::string(39, 'x');  // 48 bytes
  EXPECT_EQ(told.who, shown);
  EXPECT_EQ(bench.log.back().who.view(), shown);
  answer(edit({{"lift_time", {9.0}}}));
  EXPECT_EQ(bench.log.back().outcome, engine::EditOutcome::refused);
  EXPECT_EQ(bench.log.back().note.view(), "lift_time: 9 s is out of its range, 0.08 s to 0.4 s");
}

TEST_F(LiveServer, AReloadRefusesWhatWaitsForgetsWhatCouldBeUndoneAndCountsOn) {
  EXPECT_TRUE(answer(edit({{"lift_time", {0.15}}})).accepted);
  std::vector<answer_t> all;
  server.request(edit({{"lift_time", {0.16}}}), all);
  bench.tick();  // applied, its answer not taken
  server.request(edit({{"lift_time", {0.17}}}), all);
  const request_t undo = ask(request_t::UNDO);
  server.request(undo, all);
  Bench other;
  server.rebind(*other.behavior, other.door->entrance(1), "the behavior was reloaded", all);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_TRUE(all[0].accepted);
  EXPECT_EQ(all[0].revision, 2);
  for (const answer_t& refused : {all[1], all[2]}) {
    EXPECT_EQ(refused.reasons, std::vector<std::string>{"the behavior was reloaded"});
    EXPECT_EQ(refused.revision, 3);
    EXPECT_EQ(refused.text, "");
  }
  EXPECT_EQ(server.generation(), 1);
  EXPECT_EQ(server.revision(), 3);
  all.clear();
  server.request(undo, all);  // again: the same answer
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].revision, 3);
  all.clear();
  server.request(ask(request_t::UNDO), all);
  EXPECT_EQ(all[0].reasons, std::vector<std::string>{"there is nothing to undo"});
  all.clear();
  request_t request = edit({{"lift_time", {0.2}}});
  request.revision = 2;
  server.request(request, all);
  EXPECT_EQ(all[0].reasons,
            std::vector<std::string>{"revision 2 was expected, 3 is in force: read it again"});
  all.clear();
  ++request.sequence, request.revision = 3;
  server.request(request, all);
  other.tick();
  server.poll(all);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_TRUE(all[0].accepted);
  EXPECT_EQ(all[0].revision, 4);
}

// --- Against a naive model: a list of value lists and a place in it. ---
TEST_F(LiveServer, AnySequenceOfEditsUndosAndRedosIsThatOfANaiveStack) {
  std::mt19937_64 random(11);
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  std::vector<std::vector<double>> states = {{0.145, 0.0, 0.0}};
  std::size_t place = 0;
  std::vector<std::pair<request_t, bool>> asked;  // and whether the model says it can be done
  std::vector<answer_t> all;
  for (int k = 0; k < 3000; ++k) {
    const auto dice = random() % 10;
    request_t request = ask(dice < 3   ? request_t::UNDO
                            : dice < 5 ? request_t::REDO
                                       : request_t::EDIT);
    bool possible = true;
    if (request.what == request_t::UNDO) {
      possible = place > 0;
      place -= possible ? 1 : 0;
    } else if (request.what == request_t::REDO) {
      possible = place + 1 < states.size();
      place += possible ? 1 : 0;
    } else {
      std::vector<double> next = states[place];
      next[0] = uniform(0.08, 0.4);
      const std::size_t y = random() % 2;
      next[1 + y] = uniform(-5.0, 5.0);
      possible = random() % 4 != 0;  // else one of the two is out of range
      --sequence;
      request = edit({{"lift_time", {next[0]}},
                      {y == 0 ? "goal.x" : "goal.y", {possible ? next[1 + y] : 6.0}}});
      if (possible) {
        states.resize(place + 1);
        states.push_back(next);
        ++place;
      }
    }
    request.over = random() % 3 == 0 ? 5e-3 : 0.0;
    asked.emplace_back(request, possible);
    server.request(request, all);
    if (random() % 3 == 0) bench.tick();
    server.poll(all);
    if (random() % 20 != 0 && k < 2999) continue;
    for (int t = 0; t < 80; ++t) {  // until all is answered
      bench.tick();
      server.poll(all);
    }
    ASSERT_EQ(values().target, states[place]) << k;
    ASSERT_EQ(values().now, states[place]) << k;
    ASSERT_EQ(values().undo_count, static_cast<int>(place));
    ASSERT_EQ(values().redo_count, static_cast<int>(states.size() - 1 - place));
  }
  // Each was answered exactly once, refused where the model could not.
  std::set<std::int64_t> sequences;
  for (const answer_t& a : all) {
    const auto& [request, possible] = asked[static_cast<std::size_t>(a.sequence - 1)];
    EXPECT_EQ(a.accepted != 0, possible) << a.sequence;
    sequences.insert(a.sequence);
  }
  EXPECT_EQ(all.size(), asked.size());
  EXPECT_EQ(sequences.size(), asked.size());
}

TEST(LiveClients, MemoryIsBoundedAndWhatWasForgottenIsTooOld) {
  using Verdict = LiveClients::Verdict;
  LiveClients clients(2, 3);
  const auto done = [&](std::int64_t client, std::int64_t sequence) {
    EXPECT_EQ(clients.look(client, sequence), Verdict::fresh);
    EXPECT_EQ(clients.look(client, sequence), Verdict::pending);
    answer_t answer{};
    answer.client = client;
    answer.sequence = sequence;
    clients.keep(answer);
  };
  done(-5, 1);
  done(-5, 2);
  done(7, 1);
  EXPECT_EQ(clients.look(-5, 1), Verdict::answered);
  EXPECT_EQ(clients.answer().sequence, 1);
  done(7, 2);
  EXPECT_EQ(clients.look(-5, 1), Verdict::too_old);
  EXPECT_EQ(clients.look(-5, 2), Verdict::answered);
  EXPECT_EQ(clients.look(8, 1), Verdict::too_many);
  done(7, std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(clients.look(7, 3), Verdict::too_old);
}

}  // namespace
}  // namespace footfall::tests
