// Several engines, and programs of another version, at one address.
#include "tests/unit/engine/lcm/lcm_rig.h"

namespace footfall::tests {
namespace {

TEST_F(LcmLink, OfTwoEnginesAClientTalksToExactlyOne) {
  begin();
  StubRig second{kTuned};
  second.loop->start();
  engine::LcmLink other(*second.loop, {url, "FOOTFALL", key_of(1), 200.0});
  other.start();
  const auto work = [&] {
    second.loop->sense();
    second.loop->compute();
    other.post(*second.loop, 1000);
    second.loop->actuate();
  };
  std::atomic<bool> stop{false};
  std::thread ticks([&] {
    for (; !stop.load(); std::this_thread::sleep_for(std::chrono::microseconds(300))) work();
  });
  const auto ann = client(key_of(1));
  EXPECT_TRUE(ann->connect(20.0)) << ann->why_not();
  EXPECT_TRUE(wait_for([&] { return ann->look(0.2).size() == 2; }));
  for (const engine::EngineIdentity& one : ann->engines()) {
    engine::LiveClientSettings settings{url, "FOOTFALL", key_of(1), "bob", 0.1, 0};
    settings.session = engine::session_number(one.session);
    LiveClient bob(settings);
    EXPECT_TRUE(bob.connect(20.0)) << bob.why_not();
    EXPECT_EQ(bob.catalogue().session, one.session);
    EXPECT_EQ(one.pid, ::getpid());
    EXPECT_TRUE(bob.ask(set("speed", {2.0}), 20.0)->accepted);
    EXPECT_EQ(bob.catalogue().session, one.session);
  }
  stop = true;
  ticks.join();
  other.stop();
  end();
  EXPECT_EQ(rig.loop->edits().revision(), 1U);
  EXPECT_EQ(second.loop->edits().revision(), 1U);
}

TEST_F(LcmLink, AMessageOfAnotherVersionIsToldAsSuch) {
  end();
  link.reset();
  const auto ann = client(key_of(1));
  ann->poll(0.0);
  engine::PacketBytes old = engine::encode(footfall_lcm::hello_t{}, nullptr);
  old[9] ^= 1;  // the protocol
  strange->publish("FOOTFALL_CATALOGUE", old);
  EXPECT_FALSE(ann->connect(0.5));
  EXPECT_THAT(ann->why_not(), HasSubstr("an engine of another version"));
}

}  // namespace
}  // namespace footfall::tests
