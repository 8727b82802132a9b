// Live edits: checked whole, applied whole at the start of a tick, answered, ramped, and free of
// allocations in the tick.
#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "engine/edits/door.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/engine/doored_chart.h"

namespace footfall::tests {
namespace {

using engine::EditAnswer;
using engine::EditBatch;
using engine::EditOutcome;
using engine::EditSource;

std::string refusal(const behaviors::Behavior& behavior, const EditBatch& batch) {
  std::string text;
  for (const std::string& reason : engine::reasons_against(behavior, batch, 0)) {
    text += reason + "\n";
  }
  return text;
}

TEST_F(EditDoor, AnEditIsAppliedAtTheStartOfTheNextTickAndAnswered) {
  EditBatch batch = edit("goal", {1.0, 2.0});
  batch.id = 77;
  EXPECT_EQ(door->submit(batch).id, 77U);
  EXPECT_EQ(value("goal"), 0.0);
  EditAnswer answer;
  EXPECT_FALSE(door->take_answer(answer));
  now = 5;
  tick();
  EXPECT_EQ(value("goal"), 1.0);
  EXPECT_EQ(value("goal", 1), 2.0);
  ASSERT_TRUE(door->take_answer(answer));
  EXPECT_EQ(answer.id, 77U);
  EXPECT_EQ(answer.tick, 5);
  EXPECT_EQ(answer.revision, 1U);
  EXPECT_EQ(answer.outcome, EditOutcome::applied);
  EXPECT_FALSE(door->take_answer(answer));
}

TEST_F(EditDoor, EveryReasonIsGivenAndNothingOfABadBatchIsApplied) {
  EditBatch batch = edit("speed", {11.0});
  batch.values.push_back({slot("goal") + 1, std::nan("")});
  batch.values.push_back({slot("fixed"), 2.0});
  batch.values.push_back({slot("counted"), 2.0});
  batch.values.push_back({99, 2.0});
  batch.values.push_back({slot("goal") + 1, 2.0});
  batch.events = {behavior->find_event("parameter.changed.speed"), 12345};
  batch.over = -1.0;
  batch.revision = 3;
  const auto count = behavior->values.size();
  EXPECT_EQ(refusal(*behavior, batch),
            "speed: 11 m/s is out of its range, 0 m/s to 10 m/s\n"
            "goal.y: nan is not a finite number\n"
            "fixed: not live, because the file does not say so: give it 'live: true'\n"
            "counted: not live, because the behavior's actions set it\n"
            "no value 99: the behavior has " +
                std::to_string(count) +
                "\n"
                "goal: given twice\n"
                "parameter.changed.speed: raised by the engine only\n"
                "no event 12345: the behavior has " +
                std::to_string(behavior->events.size()) +
                "\n"
                "over: -1 s is out of its range, 0 s to 1e+06 s\n"
                "revision 3 was expected, 0 is in force: read it again\n");
  EXPECT_FALSE(door->submit(batch).accepted());
  tick();
  EXPECT_EQ(door->taken(), 0U);
  EXPECT_EQ(value("speed"), 1.0);
  EXPECT_EQ(door->revision(), 0U);
  EXPECT_EQ(refusal(*behavior, {}), "nothing is changed or raised\n");
}

TEST_F(EditDoor, OnlyAsManyValuesAsAParameterHasAreAdded) {
  std::vector<behaviors::SlotValue> values;
  std::vector<std::string> reasons;
  const auto add = [&](const char* name, int component, const std::vector<double>& given) {
    engine::add_values(*behavior, {parameter(name), component}, given, values, reasons);
  };
  add("goal", -1, {1.0});
  add("goal", 2, {1.0});
  add("goal", 0, {});
  EXPECT_EQ(reasons, (std::vector<std::string>{"goal: expected 2 values, got 1",
                                               "goal: no component 2, it has 2 values",
                                               "goal: expected 1 value, got 0"}));
  EXPECT_TRUE(values.empty());
  add("goal", 1, {7.0});
  add("goal", -1, {8.0, 9.0});
  EXPECT_EQ(values, (std::vector<behaviors::SlotValue>{
                        {slot("goal") + 1, 7.0}, {slot("goal"), 8.0}, {slot("goal") + 1, 9.0}}));
}

TEST_F(EditDoor, AScenariosSetMayWriteWhatIsNotLiveButOnlyInItsRange) {
  EditBatch batch = edit("fixed", {2.5});
  batch.source = EditSource::set;
  EXPECT_EQ(refusal(*behavior, batch), "");
  batch.values[0].value = 3.5;
  EXPECT_EQ(refusal(*behavior, batch), "fixed: 3.5 s is out of its range, 1 s to 3 s\n");
}

TEST_F(EditDoor, ParameterChangesAreHeardBeforeOutsideEvents) {
  EditBatch batch = edit("speed", {2.0});
  batch.events = {behavior->find_event("go")};
  ASSERT_TRUE(door->submit(batch).accepted());
  tick();
  EXPECT_EQ(state(), "both");  // the other order would end in `gone`
}

// 4 ms at 1 kHz: from the tick that applies it, a quarter of the way a tick.
TEST_F(EditDoor, ARampMovesLinearlyAndEndsExactlyAtItsTarget) {
  ASSERT_TRUE(door->submit(edit("goal", {4.0, -4.0}, 4e-3)).accepted());
  for (const double expected : {0.0, 1.0, 2.0, 3.0, 4.0, 4.0}) {
    tick();
    EXPECT_DOUBLE_EQ(value("goal"), expected);
    EXPECT_DOUBLE_EQ(value("goal", 1), -expected);
  }
}

TEST_F(EditDoor, ALaterEditTakesItsSlotFromARampAndLeavesTheOthers) {
  ASSERT_TRUE(door->submit(edit("goal", {4.0, 4.0}, 4e-3)).accepted());
  tick();
  tick();
  EditBatch later;
  later.values.push_back({slot("goal"), 0.0});
  later.over = 2e-3;
  ASSERT_TRUE(door->submit(later).accepted());
  tick();  // the old ramp brought x to 2 in this tick; the new one starts there
  EXPECT_DOUBLE_EQ(value("goal"), 2.0);
  tick();
  EXPECT_DOUBLE_EQ(value("goal"), 1.0);
  tick();
  EXPECT_DOUBLE_EQ(value("goal"), 0.0);
  EXPECT_DOUBLE_EQ(value("goal", 1), 4.0);
  ASSERT_TRUE(door->submit(edit("goal", {1.0, 1.0})).accepted());
  tick();
  EXPECT_DOUBLE_EQ(value("goal"), 1.0);
}

TEST_F(EditDoor, AnEditForAnotherRevisionIsRefusedByTheTickAndSaysSo) {
  EditBatch first = edit("speed", {2.0});
  EditBatch second = edit("speed", {3.0});
  first.revision = second.revision = 0;
  ASSERT_TRUE(door->submit(first).accepted());
  ASSERT_TRUE(door->submit(second).accepted());  // nothing is applied yet
  tick();
  EXPECT_EQ(value("speed"), 2.0);
  EditAnswer answer;
  ASSERT_TRUE(door->take_answer(answer));
  EXPECT_EQ(answer.outcome, EditOutcome::applied);
  ASSERT_TRUE(door->take_answer(answer));
  EXPECT_EQ(answer.outcome, EditOutcome::stale_revision);
  EXPECT_EQ(answer.revision, 1U);
  ASSERT_EQ(door->taken(), 2U);
  EXPECT_EQ(door->taken(1).outcome, EditOutcome::stale_revision);
}

TEST_F(EditDoor, AFullQueueIsTold) {
  for (int k = 0; k < 4; ++k) EXPECT_TRUE(door->submit(edit("speed", {2.0})).accepted());
  EXPECT_EQ(door->submit(edit("speed", {2.0})).reasons,
            std::vector<std::string>{"the queue of edits is full: 4 of them wait"});
  tick();
  tick();
  EditAnswer answer;
  while (door->take_answer(answer)) {
  }
  EXPECT_TRUE(door->submit(edit("speed", {2.0})).accepted());
}

// The machine takes 128 outside events in a tick.
TEST_F(EditDoor, ABatchWhoseEventsFindNoRoomWaitsWhole) {
  for (int k = 0; k < 120; ++k) machine->raise(behavior->find_event("stop"));
  EditBatch batch = edit("speed", {2.0});
  batch.events.assign(engine::kMaxEditEvents, behavior->find_event("stop"));
  ASSERT_TRUE(door->submit(batch).accepted());
  tick();
  EXPECT_EQ(value("speed"), 1.0);
  tick();
  EXPECT_EQ(value("speed"), 2.0);
  EXPECT_EQ(machine->faults().of(core::Fault::event_overflow), 0);
}

TEST_F(EditDoor, WhatATickRecordedGivesTheSameRunAgain) {
  ASSERT_TRUE(door->submit(edit("goal", {4.0, 4.0}, 3e-3)).accepted());
  EditBatch batch = edit("speed", {7.0});
  batch.events = {behavior->find_event("go")};
  std::vector<engine::EditOrder> recorded;
  std::vector<std::vector<double>> first;
  for (int k = 0; k < 8; ++k) {
    if (k == 2) {
      ASSERT_TRUE(door->submit(batch).accepted());
    }
    tick();
    for (std::size_t i = 0; i < door->taken(); ++i) recorded.push_back(door->taken(i));
    first.emplace_back(machine->parameters().begin(), machine->parameters().end());
  }
  const std::string end = state();
  ASSERT_EQ(recorded.size(), 2U);
  behaviors::Machine again(*behavior, signals);
  engine::EditDoor other(*behavior, 4);
  again.start();
  for (int k = 0; k < 8; ++k) {
    if (k == 0) {
      ASSERT_TRUE(other.resubmit(recorded[0]));
    }
    if (k == 2) {
      ASSERT_TRUE(other.resubmit(recorded[1]));
    }
    other.apply(k, again);
    again.tick(k);
    const auto& expected = first[static_cast<std::size_t>(k)];
    EXPECT_TRUE(std::equal(expected.begin(), expected.end(), again.parameters().begin())) << k;
  }
  EXPECT_EQ(again.active_atomic().front(), machine->active_atomic().front()) << end;
  engine::EditOrder foreign = recorded[0];
  foreign.values[0].slot = 1000;
  EXPECT_FALSE(other.resubmit(foreign));
}

TEST_F(EditDoor, TheTickAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  EditBatch batch = edit("goal", {4.0, 4.0}, 4e-3);
  batch.events = {behavior->find_event("go")};
  ASSERT_TRUE(door->submit(batch).accepted());
  ASSERT_TRUE(door->submit(edit("goal", {2.0, 2.0})).accepted());
  const AllocationGuard guard;
  for (int k = 0; k < 10; ++k) tick();
  EXPECT_EQ(guard.allocations(), 0);
}

// One thread submits and takes answers while another ticks: each batch is applied once, in order.
TEST_F(EditDoor, NothingIsLostBetweenTwoThreads) {
  constexpr std::uint64_t kEdits = 2000;
  std::atomic<bool> done{false};
  std::thread ticking([&] {
    while (!done.load()) tick();
  });
  std::uint64_t submitted = 0, answered = 0;
  bool in_order = true;
  while (answered < kEdits) {
    EditAnswer answer;
    while (door->take_answer(answer)) in_order &= answer.revision == ++answered;
    EditBatch batch = edit("goal", {1.0, 1.0});
    if (submitted < kEdits && door->submit(batch).accepted()) ++submitted;
  }
  done = true;
  ticking.join();
  EXPECT_TRUE(in_order);
  EXPECT_EQ(door->revision(), kEdits);
}

}  // namespace
}  // namespace footfall::tests
