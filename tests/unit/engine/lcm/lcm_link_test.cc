// An engine and its clients on the network of live tuning, each test on a port of its own that
// leaves the host by no way. Skipped where LCM has no network.
#include "tests/unit/engine/lcm/lcm_rig.h"

namespace footfall::tests {
namespace {

TEST_F(LcmLink, AnEditIsAnsweredAndThenInForce) {
  begin();
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  EXPECT_EQ(ann->catalogue().robot, "hume");
  EXPECT_TRUE(ann->catalogue().keyed);
  const int goal = ann->find_parameter("goal");
  ASSERT_GE(goal, 0);
  const auto first =
      static_cast<std::size_t>(ann->catalogue().parameters[static_cast<std::size_t>(goal)].first);
  const auto answer = ann->ask(set("goal", {1.0, 2.0}), 20.0);
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->accepted) << testing::PrintToString(answer->reasons);
  EXPECT_EQ(answer->revision, 1);
  EXPECT_GE(answer->tick, 0);
  EXPECT_TRUE(wait_for([&] {
    ann->poll(0.1);
    return ann->values().now[first + 1] == 2.0;  // ramped there
  }));
  EXPECT_EQ(ann->values().target[first], 1.0);
  const auto refused = ann->ask(set("goal", {9.0, 2.0}), 20.0);
  ASSERT_TRUE(refused);
  EXPECT_FALSE(refused->accepted);
  EXPECT_THAT(refused->reasons, ElementsAre(HasSubstr("out of its range")));
  end();
  EXPECT_EQ(link->counters().requests.applied, 1);
  EXPECT_EQ(link->counters().requests.refused, 1);
  EXPECT_EQ(link->counters().rejected_in_all(), 0);
}

TEST_F(LcmLink, TelemetryTellsWhatIsActive) {
  begin();
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  footfall_lcm::request_t go{};
  go.revision = -1;
  go.events = {"go"};
  ASSERT_TRUE(ann->ask(go, 20.0));
  EXPECT_TRUE(wait_for([&] {
    ann->poll(0.1);
    const auto& t = ann->telemetry();
    return t.active.size() == 1 &&
           ann->catalogue().states[static_cast<std::size_t>(t.active[0])] == "gone";
  }));
  const auto& t = ann->telemetry();
  ASSERT_EQ(t.tasks.size(), 1U);
  EXPECT_EQ(ann->catalogue().tasks[static_cast<std::size_t>(t.tasks[0].name)], "rest");
  EXPECT_EQ(t.condition, footfall_lcm::telemetry_t::RUNNING);
  const int time = ann->find_signal("time");
  ASSERT_GE(time, 0);
  EXPECT_FLOAT_EQ(t.signals[static_cast<std::size_t>(time)], static_cast<float>(t.time));
  EXPECT_FLOAT_EQ(t.tick_us, 1.0F);
}

// A client may show values beside signals only if it knows that they are of one tick.
TEST_F(LcmLink, EachTelemetryDuringARampFollowsTheValuesOfItsTick) {
  begin();
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  auto request = set("goal", {1.0, 2.0});
  request.over = 0.2;
  const auto answer = ann->ask(request, 20.0);
  ASSERT_TRUE(answer && answer->accepted);
  std::vector<std::int64_t> rows, values;
  EXPECT_TRUE(wait_for([&] {
    ann->poll(0.1);
    for (const auto& told : ann->take_values()) values.push_back(told.tick);
    for (const auto& told : ann->take_telemetry()) rows.push_back(told.tick);
    return !rows.empty() && rows.back() > answer->tick + 250;  // the ramp has 300 ticks
  }));
  std::erase_if(rows, [&](auto tick) { return tick <= answer->tick || tick > answer->tick + 250; });
  EXPECT_GT(rows.size(), 10U);
  EXPECT_THAT(values, testing::IsSupersetOf(rows));
}

TEST_F(LcmLink, TheLastTelemetryTellsThatTheRunHasEnded) {
  begin();
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  EXPECT_TRUE(wait_for([&] { return ann->poll(0.1) > 0 && ann->telemetry().tick > 0; }));
  end();
  EXPECT_TRUE(wait_for([&] {
    ann->poll(0.1);
    return ann->telemetry().condition == footfall_lcm::telemetry_t::ENDED;
  }));
}

TEST_F(LcmLink, WithoutTheKeyNothingIsBelieved) {
  begin();
  const auto eve = client(key_of(2), "eve");
  EXPECT_FALSE(eve->connect(0.4));
  EXPECT_THAT(eve->why_not(), HasSubstr("its key is another one"));
  auto request = set("speed", {2.0});
  request.sequence = 1;
  for (const LiveKey& key : {key_of(2), key_of(0)}) {
    strange->publish("FOOTFALL_REQUEST", engine::encode(request, &key));
  }
  strange->publish("FOOTFALL_REQUEST", engine::encode(request, nullptr));
  EXPECT_TRUE(wait_for([&] { return rejected(PacketProblem::not_authentic) == 3; }));
  end();
  EXPECT_EQ(rig.loop->edits().revision(), 0U);
  strange->poll(0);
  EXPECT_TRUE(overheard.empty());
}

TEST_F(LcmLink, DamagedPacketsAreCountedAndTheNextEditIsAnswered) {
  begin();
  RandomMessages random(5);
  const LiveKey key = key_of(1);
  footfall_lcm::request_t request;
  int unreadable = 0;
  for (int k = 0; k < 300; ++k) {
    const auto packet =
        random.damaged(engine::encode(random.some<footfall_lcm::request_t>(), &key));
    unreadable += engine::decode(packet, &key, request) != PacketProblem::none ? 1 : 0;
    strange->publish("FOOTFALL_REQUEST", packet);
    if (k % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  const auto answer = ann->ask(set("speed", {2.0}), 20.0);
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->accepted);
  end();
  EXPECT_GT(unreadable, 100);
  EXPECT_LE(link->counters().rejected_in_all(), unreadable);  // the network may lose some
  EXPECT_GT(link->counters().rejected_in_all(), unreadable / 2);
}

TEST_F(LcmLink, ARepeatedRequestIsAnsweredTheSameAndNotDoneAgain) {
  begin();
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  auto request = set("speed", {2.0});
  request.session = ann->catalogue().session;
  request.client = 77;
  request.sequence = 1;
  const LiveKey key = key_of(1);
  const auto packet = engine::encode(request, &key);
  for (std::size_t k = 1; k <= 3; ++k) {
    strange->publish("FOOTFALL_REQUEST", packet);
    ASSERT_TRUE(wait_for([&] {
      strange->poll(10);
      return overheard.size() >= k;
    }));
  }
  EXPECT_EQ(overheard[0], overheard[1]);
  EXPECT_EQ(overheard[0], overheard[2]);
  end();
  EXPECT_EQ(rig.loop->edits().revision(), 1U);
  EXPECT_EQ(link->counters().requests.repeated, 2);
}

TEST_F(LcmLink, TwoClientsHearOfEachOther) {
  begin();
  const auto ann = client(key_of(1), "ann"), bob = client(key_of(1), "bob");
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  ASSERT_TRUE(bob->connect(20.0)) << bob->why_not();
  ASSERT_TRUE(ann->ask(set("speed", {3.0}), 20.0));
  std::vector<footfall_lcm::answer_t> heard;
  EXPECT_TRUE(wait_for([&] {
    bob->poll(0.1);
    const auto answers = bob->take_answers();
    heard.insert(heard.end(), answers.begin(), answers.end());
    return !heard.empty();
  }));
  EXPECT_EQ(heard[0].who, "ann");
  EXPECT_EQ(heard[0].client, ann->client());
  // Of two who read the same revision the later one is told.
  auto late = set("speed", {4.0});
  late.revision = 0;
  const auto answer = bob->ask(late, 20.0);
  ASSERT_TRUE(answer);
  EXPECT_FALSE(answer->accepted);
  EXPECT_THAT(answer->reasons, ElementsAre(HasSubstr("revision 0 was expected, 1 is in force")));
}

TEST_F(LcmLink, WhatWaitsWhenTheRunEndsIsRefused) {
  rig.loop->start();
  link->start();
  tick();  // the values; no more after it
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  ann->send(set("speed", {2.0}));
  ASSERT_TRUE(wait_for([&] { return link->counters().requests.requests == 1; }));
  link->stop();
  EXPECT_TRUE(wait_for([&] {
    ann->poll(0.1);
    return ann->waiting() == 0;
  }));
  const auto answers = ann->take_answers();
  ASSERT_EQ(answers.size(), 1U);
  EXPECT_FALSE(answers[0].accepted);
  EXPECT_THAT(answers[0].reasons, ElementsAre("the run has ended"));
}

TEST_F(LcmLink, AReloadedBehaviorTakesTheEdits) {
  rig.loop->start();
  link->start();
  tick();
  const auto ann = client(key_of(1));
  ASSERT_TRUE(ann->connect(20.0)) << ann->why_not();
  StubRig next(kTuned);
  next.loop->start();
  link->rebind(link->prepare(*next.loop));
  ASSERT_TRUE(wait_for([&] { return link->rebound(); }));
  std::swap(rig.loop, next.loop);
  ticking = std::thread([this] {
    while (!done.load()) {
      tick();
      std::this_thread::sleep_for(std::chrono::microseconds(300));
    }
  });
  EXPECT_TRUE(wait_for([&] {
    ann->poll(0.1);
    return ann->connected() && ann->catalogue().generation == 1;
  }));
  const auto answer = ann->ask(set("speed", {2.0}), 20.0);
  ASSERT_TRUE(answer);
  EXPECT_TRUE(answer->accepted);
  end();
  EXPECT_EQ(rig.loop->edits().revision(), 1U);
  std::swap(rig.loop, next.loop);
}

TEST_F(LcmLink, TheTickAllocatesNothingForIt) {
  rig.loop->start();
  link->start();
  tick();
  const AllocationGuard guard;
  for (int k = 0; k < 500; ++k) {
    rig.loop->sense();
    rig.loop->compute();
    link->post(*rig.loop, 1000);
    rig.loop->actuate();
  }
  EXPECT_EQ(guard.allocations(), 0);
}

// 1500 ticks a second, 50 telemetry messages: one in 30 ticks.
TEST(LiveFeed, WhatIsDueIsCopiedAndAFullQueueDrops) {
  StubRig rig(kTuned);
  rig.loop->start();
  engine::LiveFeed feed(*rig.loop, 50.0);
  int taken = 0;
  const auto run = [&](int ticks, bool take) {
    for (int k = 0; k < ticks; ++k) {
      rig.loop->sense();
      rig.loop->compute();
      feed.post(*rig.loop, k);
      rig.loop->actuate();
      for (; take && feed.front() != nullptr; feed.pop()) ++taken;
    }
  };
  run(1500, true);
  EXPECT_EQ(taken, 50);
  EXPECT_EQ(feed.dropped(), 0);
  run(3000, false);
  EXPECT_EQ(feed.dropped(), 100 - 64);
}

TEST(LiveUrl, WhatCannotBeIsRefusedWithAReason) {
  const auto problem = [](const std::string& url) -> std::string {
    try {
      engine::parse_live_url(url);
    } catch (const std::invalid_argument& error) {
      return error.what();
    }
    return "";
  };
  const std::string expected = "; expected a URL such as 'udpm://239.255.76.67:7667?ttl=0'";
  EXPECT_EQ(problem("tcpq://here"),
            "'tcpq://here' is of no network that live tuning can use" + expected);
  EXPECT_EQ(problem("udpm://10.0.0.1:7667"),
            "'udpm://10.0.0.1:7667' names '10.0.0.1', no multicast address (224.0.0.0 to "
            "239.255.255.255)" +
                expected);
  EXPECT_THAT(problem("udpm://239.255.76.67:0"), HasSubstr("has the port '0'"));
  EXPECT_THAT(problem("udpm://239.255.76.67:70000"), HasSubstr("has the port '70000'"));
  EXPECT_THAT(problem("udpm://239.255.76.67:"), HasSubstr("has the port ''"));
  EXPECT_THAT(problem("udpm://:7667?ttl=256"), HasSubstr("has the ttl '256'"));
  EXPECT_THAT(problem("udpm://:7667?tll=1"), HasSubstr("has the option 'tll'"));
  EXPECT_THAT(problem("udpm://:7667?ttl"), HasSubstr("has the ttl ''"));
  EXPECT_EQ(problem("udpm://"), "");
  EXPECT_EQ(engine::parse_live_url("udpm://239.1.2.3:99?ttl=1&recv_buf_size=9").ttl, 1);
  EXPECT_THROW(engine::check_live_prefix("A.*"), std::invalid_argument);
  EXPECT_THROW(engine::check_live_prefix(""), std::invalid_argument);
  EXPECT_THROW(engine::check_live_prefix(std::string(41, 'A')), std::invalid_argument);
  EXPECT_NO_THROW(engine::check_live_prefix("HUME_2"));
}

}  // namespace
}  // namespace footfall::tests
