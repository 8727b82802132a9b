// Several threads at one door: each has its entrance, its answers and its room.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <thread>

#include "engine/edits/door.h"
#include "tests/unit/engine/doored_chart.h"

namespace footfall::tests {
namespace {

using engine::EditAnswer;
using engine::EditBatch;
using engine::EditOutcome;
using engine::EditSource;

using EditEntrance = EditDoor;

TEST_F(EditEntrance, EntrancesAreTakenInTheirOrderAndEachHasItsOwnAnswersAndRoom) {
  engine::EditEntrance& second = door->entrance(1);
  ASSERT_TRUE(second.submit(edit("goal", {2.0, 2.0})).accepted());
  ASSERT_TRUE(second.submit(edit("speed", {4.0})).accepted());
  ASSERT_TRUE(door->submit(edit("goal", {1.0, 1.0})).accepted());
  tick();
  EXPECT_EQ(value("goal"), 2.0);  // entrance 0 wrote first, though it was asked last
  ASSERT_EQ(door->taken(), 3U);
  EXPECT_EQ(door->taken(0).new_values()[0].value, 1.0);
  EXPECT_EQ(door->taken(2).new_values()[0].value, 4.0);
  EditAnswer answer;
  ASSERT_TRUE(door->take_answer(answer));
  EXPECT_EQ(answer.revision, 1U);
  EXPECT_FALSE(door->take_answer(answer));
  std::array<double, 2> former{};
  ASSERT_TRUE(second.take_answer(answer, former));
  EXPECT_EQ(answer.revision, 2U);
  EXPECT_EQ(former, (std::array<double, 2>{1.0, 1.0}));
  EXPECT_EQ(second.outstanding(), 1U);
  tick();  // gives the places of the last one back
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(door->submit(edit("speed", {2.0})).accepted());
  EXPECT_FALSE(door->submit(edit("speed", {2.0})).accepted());
  EXPECT_TRUE(second.submit(edit("speed", {2.0})).accepted());
}

TEST_F(EditEntrance, FormerValuesAndTargetsAreWhereARampWasGoing) {
  engine::EditEntrance& entrance = door->entrance(1);
  ASSERT_TRUE(entrance.submit(edit("goal", {4.0, -4.0}, 4e-3)).accepted());
  tick();
  tick();
  std::vector<double> targets(behavior->values.size());
  door->ramps().copy_targets(machine->parameters(), targets);
  const auto slot = static_cast<std::size_t>(
      behavior->parameters[static_cast<std::size_t>(parameter("goal"))].slot);
  EXPECT_EQ(targets[slot], 4.0);
  EXPECT_EQ(targets[slot + 1], -4.0);
  targets[slot] = value("goal"), targets[slot + 1] = value("goal", 1);
  EXPECT_TRUE(std::ranges::equal(targets, machine->parameters()));  // all others are at rest
  ASSERT_TRUE(entrance.submit(edit("goal", {0.0, 0.0})).accepted());
  tick();
  EditAnswer answer;
  std::array<double, 2> former{};
  ASSERT_TRUE(entrance.take_answer(answer, former));
  EXPECT_EQ(former, (std::array<double, 2>{0.0, 0.0}));
  ASSERT_TRUE(entrance.take_answer(answer, former));
  EXPECT_EQ(former, (std::array<double, 2>{4.0, -4.0}));
}

TEST_F(EditEntrance, ARefusalIsShownToTheLogInItsTurnAndChangesNothing) {
  engine::EditEntrance& entrance = door->entrance(1);
  ASSERT_TRUE(entrance.submit(edit("speed", {4.0})).accepted());
  EXPECT_TRUE(entrance.tell_refused(EditSource::live, "ann@bench", std::string(159, 'x') + "é!"));
  tick();
  ASSERT_EQ(door->taken(), 2U);
  EXPECT_EQ(door->taken(1).outcome, EditOutcome::refused);
  EXPECT_EQ(door->taken(1).who.view(), "ann@bench");
  EXPECT_EQ(door->taken(1).note.view(), std::string(159, 'x'));  // no half of a character
  EXPECT_EQ(door->revision(), 1U);
  EditAnswer answer;
  EXPECT_TRUE(entrance.take_answer(answer));
  EXPECT_FALSE(entrance.take_answer(answer));
}

TEST_F(EditEntrance, OnlyLiveAndScenarioEditsOfValuesCountAsMovingThem) {
  EditBatch event;
  event.events = {behavior->find_event("go")};
  for (const auto source : {EditSource::live, EditSource::scenario, EditSource::set,
                            EditSource::command, EditSource::replay}) {
    const bool counts = source == EditSource::live || source == EditSource::scenario;
    EditBatch batch = edit("goal", {4.0, 4.0}, 2e-3);
    batch.source = event.source = source;
    ASSERT_TRUE(door->submit(event).accepted());
    tick();
    EXPECT_FALSE(door->moved());
    ASSERT_TRUE(door->submit(batch).accepted());
    for (int k = 0; k <= 2; ++k) {  // applied, moved half the way, arrived
      tick();
      EXPECT_EQ(door->moved(), counts) << k;
    }
    tick();
    EXPECT_FALSE(door->moved());
    batch.over = 0.0;
    ASSERT_TRUE(door->submit(batch).accepted());
    tick();
    EXPECT_EQ(door->moved(), counts);
    EditAnswer answer;
    while (door->take_answer(answer)) {
    }
  }
}

// Two threads submit, each at its entrance and to a component of its own, while a third ticks.
TEST_F(EditEntrance, TwoThreadsSubmitAtOnceAndNothingIsLost) {
  constexpr int kEdits = 1000;
  std::atomic<bool> done{false};
  std::thread ticking([&] {
    while (!done.load()) tick();
  });
  std::array<bool, 2> good{};
  const auto submit_all = [&](std::size_t who) {
    engine::EditEntrance& entrance = door->entrance(who);
    int submitted = 0, answered = 0;
    std::uint64_t revision = 0;
    double last = 0.0;
    bool in_order = true;
    while (answered < kEdits) {
      EditAnswer answer;
      std::array<double, 1> former{};
      while (entrance.take_answer(answer, former)) {
        in_order &= answer.revision > revision && former[0] == last;
        revision = answer.revision;
        last = 1e-3 * ++answered;
      }
      EditBatch batch;
      batch.values.push_back({slot("goal") + static_cast<int>(who), 1e-3 * (submitted + 1)});
      if (submitted < kEdits && entrance.submit(batch).accepted()) ++submitted;
    }
    good[who] = in_order;
  };
  std::thread other([&] { submit_all(1); });
  submit_all(0);
  other.join();
  done = true;
  ticking.join();
  EXPECT_TRUE(good[0] && good[1]);
  EXPECT_EQ(door->revision(), 2U * kEdits);
  EXPECT_EQ(value("goal", 0), 1.0);
  EXPECT_EQ(value("goal", 1), 1.0);
}

}  // namespace
}  // namespace footfall::tests
