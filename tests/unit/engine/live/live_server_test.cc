// Requests of people in, answers out: done once, whole or not at all, answered with every reason,
// undone and done again; nothing of it needs a network.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <footfall_lcm/answer_t.hpp>
#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <footfall_lcm/values_t.hpp>
#include <limits>

#include "engine/live/answered_requests.h"
#include "engine/live/server.h"
#include "tests/unit/engine/live/live_rig.h"

namespace footfall::tests {
namespace {

using engine::LiveClients;
using footfall_lcm::answer_t;
using footfall_lcm::request_t;

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
  EXPECT_EQ(all[0].session, kTunedSession);
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
            "goal: no component 7, it has 2 values\n"
            "no event 'goo' (did you mean 'go'?)\n"
            "revision 3 was expected, 0 is in force: read it again\n"
            "lift_time: 0.5 s is out of its range, 0.08 s to 0.4 s\n"
            "goal.x: nan is not a finite number\n"
            "fixed: not live, because the file does not say so: give it 'live: true'\n"
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

TEST_F(LiveServer, AnotherSessionsRequestIsLeftToThatEngine) {
  request_t request = edit({{"lift_time", {0.15}}});
  request.session = kTunedSession + 1;
  std::vector<footfall_lcm::answer_t> answers;
  server.request(request, answers);
  server.poll(answers);
  EXPECT_TRUE(answers.empty());
  EXPECT_EQ(server.counters().refused, 1);
  request.session = kTunedSession;
  EXPECT_TRUE(answer(request).accepted);  // it was not counted as seen
}

TEST_F(LiveServer, AnUndoTakesAsLongAsTheEditDid) {
  request_t ramp = edit({{"lift_time", {0.2}}});
  ramp.over = 2.0;
  EXPECT_THAT(answer(ramp).text, testing::EndsWith("over 2 s"));
  EXPECT_THAT(answer(ask(request_t::UNDO)).text, testing::EndsWith("over 2 s"));
  request_t redo = ask(request_t::REDO);
  redo.over = 0.5;
  EXPECT_THAT(answer(redo).text, testing::EndsWith("over 500 ms"));
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
  EXPECT_EQ(answer(ask(request_t::UNDO)).text, "undo: goal = [0 m, 0 m] over 1 s");
  EXPECT_EQ(values().target[1], 0.0);  // as slowly as it was changed
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
  LoggedChart other;
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

}  // namespace
}  // namespace footfall::tests
