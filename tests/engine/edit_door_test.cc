// Live edits: checked whole, applied whole at the start of a tick, answered, ramped, and free of
// allocations in the tick.
#include "engine/edit_door.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "behaviors/loader.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/no_measure.h"

namespace footfall::tests {
namespace {

using engine::EditAnswer;
using engine::EditBatch;
using engine::EditOutcome;
using engine::EditSource;

constexpr const char* kEdited = R"(
behavior: 1
parameters:
  speed: {value: 1 m/s, range: [0 m/s, 10 m/s], live: true}
  goal: {value: [0 m, 0 m], range: [-5 m, 5 m], live: true}
  fixed: {value: 2 s, range: [1 s, 3 s]}
  counted: {value: 0, range: [0, 5]}
events: {go: "from outside", stop: "from outside"}
machine:
  on_entry: [{set: {counted: 1}}]
  states:
    idle:
      transitions:
        - {on: parameter.changed.speed, to: changed}
        - {on: go, to: gone}
    changed: {transitions: [{on: go, to: both}]}
    gone: {transitions: [{on: stop, to: idle}]}
    both: {}
)";

// A statechart of 1 kHz with its door.
class Doored : public testing::Test {
 protected:
  Doored() {
    core::Diagnostics diagnostics;
    behavior = behaviors::load_behavior_text(kEdited, "chart.yaml", {}, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    signals = behavior->signals;
    machine = std::make_unique<behaviors::Machine>(*behavior, signals);
    door = std::make_unique<engine::EditDoor>(*behavior, 4);
    machine->start(measure);
  }
  void tick() {
    door->apply(now, *machine);
    machine->tick(now++, measure);
  }
  int parameter(const char* name) const { return behavior->find_parameter(name); }
  double value(const char* name, int component = 0) const {
    const auto& info = behavior->parameters[static_cast<std::size_t>(parameter(name))];
    return machine->parameters()[static_cast<std::size_t>(info.slot + component)];
  }
  EditBatch edit(const char* name, std::vector<double> values, double over = 0.0) const {
    EditBatch batch;
    batch.values.push_back({parameter(name), -1, std::move(values)});
    batch.over = over;
    return batch;
  }
  std::string refusal(const EditBatch& batch) const {
    std::string text;
    for (const std::string& reason : engine::reasons_against(*behavior, batch, 0)) {
      text += reason + "\n";
    }
    return text;
  }
  std::string state() const {
    return behavior->states[static_cast<std::size_t>(machine->active_atomic().front())].name;
  }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  std::unique_ptr<behaviors::Machine> machine;
  std::unique_ptr<engine::EditDoor> door;
  NoMeasure measure;
  std::int64_t now = 0;
};

using EditDoor = Doored;

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
  batch.values.push_back({parameter("goal"), -1, {1.0}});
  batch.values.push_back({parameter("goal"), 1, {std::nan("")}});
  batch.values.push_back({parameter("fixed"), -1, {2.0}});
  batch.values.push_back({parameter("counted"), -1, {2.0}});
  batch.values.push_back({99, -1, {2.0}});
  batch.values.push_back({parameter("goal"), 2, {2.0}});
  batch.events = {behavior->find_event("parameter.changed.speed"), 12345};
  batch.over = -1.0;
  batch.revision = 3;
  const auto count = behavior->parameters.size();
  EXPECT_EQ(refusal(batch),
            "speed: 11 m/s is out of its range, 0 m/s to 10 m/s\n"
            "goal: expected 2 values, got 1\n"
            "goal[1]: nan is not a finite number\n"
            "fixed: not live; give it a range and 'live: true'\n"
            "counted: not live, the behavior's actions set it\n"
            "no parameter 99: the behavior has " +
                std::to_string(count) +
                "\n"
                "goal: no component 2, it has 2 values\n"
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
  EXPECT_EQ(refusal({}), "nothing is changed or raised\n");
}

TEST_F(EditDoor, AScenariosSetMayWriteWhatIsNotLiveButOnlyInItsRange) {
  EditBatch batch = edit("fixed", {2.5});
  batch.source = EditSource::set;
  EXPECT_EQ(refusal(batch), "");
  batch.values[0].values[0] = 3.5;
  EXPECT_EQ(refusal(batch), "fixed: 3.5 s is out of its range, 1 s to 3 s\n");
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
  later.values.push_back({parameter("goal"), 0, {0.0}});
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
  again.start(measure);
  for (int k = 0; k < 8; ++k) {
    if (k == 0) {
      ASSERT_TRUE(other.resubmit(recorded[0]));
    }
    if (k == 2) {
      ASSERT_TRUE(other.resubmit(recorded[1]));
    }
    other.apply(k, again);
    again.tick(k, measure);
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

TEST_F(EditDoor, EntrancesAreTakenInTheirOrderAndEachHasItsOwnAnswersAndRoom) {
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

TEST_F(EditDoor, FormerValuesAndTargetsAreWhereARampWasGoing) {
  engine::EditEntrance& entrance = door->entrance(1);
  ASSERT_TRUE(entrance.submit(edit("goal", {4.0, -4.0}, 4e-3)).accepted());
  tick();
  tick();
  std::vector<double> targets(behavior->values.size());
  door->copy_targets(machine->parameters(), targets);
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

TEST_F(EditDoor, ARefusalIsShownToTheLogInItsTurnAndChangesNothing) {
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

TEST_F(EditDoor, OnlyLiveAndScenarioEditsOfValuesCountAsMovingThem) {
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
TEST_F(EditDoor, TwoThreadsSubmitAtOnceAndNothingIsLost) {
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
      batch.values.push_back({parameter("goal"), static_cast<int>(who), {1e-3 * (submitted + 1)}});
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
