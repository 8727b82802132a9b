// A loop in another's place: what an equal file leaves as it was bit for bit, what of a changed one
// comes in force and how, what is refused, and that it costs nothing in the tick.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "behaviors/compiled/take_over_map.h"
#include "core/index.h"
#include "engine/tick/control_loop.h"
#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

using engine::ControlLoop;
using engine::ValueChange;

constexpr int kRampTicks = 150;  // 100 ms at 1500 Hz

std::string stand(const std::string& kp, const std::string& after = "1 s",
                  const std::string& more = "") {
  return R"(
behavior: 1
robot: hume
parameters:
  stiff: {value: )" +
         kp + R"(, range: [0 1/s^2, 900 1/s^2], live: true}
  soft: {value: 10 1/s, range: [0 1/s, 100 1/s], live: true}
  count: {value: 0}
events: {go: "told to"}
gains: {stand: {hold: {kp: $stiff, ki: 5, kd: $soft}}}
machine:
  reload: ok
  states:
    wait: {stack: stand, on_entry: [{set: {count: "= $count + 1"}}], after: )" +
         after + R"(, to: later, transitions: [{on: go, to: later}]}
    later: {stack: stand}
)" + more +
         R"(
stacks:
  stand:
    contacts: []
    gains: stand
    tasks: {hold: {type: joint_posture, reference: 0.2}}
)";
}

// A second behavior over the same hardware, ready to take over from a rig's.
struct Successor {
  std::unique_ptr<behaviors::Behavior> behavior;
  behaviors::TakeOverMap map;
  std::unique_ptr<ControlLoop> loop;

  Successor(const behaviors::Behavior& from, hal::Hardware& hardware,
            std::unique_ptr<behaviors::Behavior> to)
      : behavior(std::move(to)),
        map(behaviors::map_take_over(from, *behavior)),
        loop(std::make_unique<ControlLoop>(*behavior, hardware, engine::LoopSettings{})) {}
  Successor(StubRig& rig, const std::string& text)
      : Successor(*rig.behavior, *rig.hardware, load_inline(text)) {}

  std::vector<std::string> reasons(const behaviors::Behavior& from) const {
    return behaviors::reasons_against_take_over(from, *behavior, map);
  }
  double value(const char* name) const {
    const int p = behavior->find_parameter(name);
    return loop->machine().parameters()[at(behavior->parameters[at(p)].slot)];
  }
};

void ticks(ControlLoop& loop, int count) {
  for (int k = 0; k < count; ++k) loop.tick();
}

std::string state_of(const ControlLoop& loop) {
  return loop.behavior().states[at(loop.machine().active_atomic().front())].path;
}

void edit(ControlLoop& loop, const char* name, double value) {
  engine::EditBatch batch;
  const int parameter = loop.behavior().find_parameter(name);
  batch.values.push_back({loop.behavior().parameters[at(parameter)].slot, value});
  ASSERT_TRUE(loop.edits().submit(batch).accepted());
}

// The library's stepping on MuJoCo, with and without a reload of its own file on the way.
std::vector<double> torques_of_steps(bool reload) {
  Rig rig("balance_best");
  Rig same("balance_best");  // only its behavior is used
  Successor next(*rig.behavior, *rig.backend, std::move(same.behavior));
  EXPECT_TRUE(next.reasons(*rig.behavior).empty());
  rig.loop->start();
  ControlLoop* now = rig.loop.get();
  std::vector<double> torques;
  while (now->ticks() < 2700) {
    const bool may = next.loop->may_take_over(*now, next.map);
    if (reload && now != next.loop.get() && now->ticks() > 1500 && may) {
      next.loop->take_over(*now, next.map, ValueChange::ramped);
      now = next.loop.get();
    }
    now->tick();
    for (int j = 0; j < rig.behavior->robot.joint_count(); ++j) {
      torques.push_back(now->commands().tau[at(j)]);
    }
  }
  EXPECT_EQ(now == next.loop.get(), reload);
  EXPECT_GT(now->signals()[now->signals().find("steps")], 3.0);
  return torques;
}

TEST(TakeOver, OfAnEqualFileChangesNoBitOfAnyTorque) {
  const std::vector<double> with = torques_of_steps(true);
  const std::vector<double> without = torques_of_steps(false);
  ASSERT_EQ(with.size(), without.size());
  EXPECT_EQ(std::memcmp(with.data(), without.data(), with.size() * sizeof(double)), 0);
}

TEST(TakeOver, KeepsIntegralsClocksAndTheSignalsOfTheLastTick) {
  StubRig twin(stand("100 1/s^2"));
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("100 1/s^2"));
  twin.loop->start();
  rig.loop->start();
  ticks(*twin.loop, 1499);
  ticks(*rig.loop, 700);
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  EXPECT_EQ(next.loop->ticks(), 700);
  ticks(*next.loop, 799);
  for (int j = 0; j < rig.behavior->robot.joint_count(); ++j) {
    EXPECT_EQ(next.loop->commands().tau[at(j)], twin.loop->commands().tau[at(j)]);
  }
  EXPECT_EQ(state_of(*next.loop), "wait");
  next.loop->tick();  // 1 s at 1500 Hz
  next.loop->tick();
  EXPECT_EQ(state_of(*next.loop), "later");
}

TEST(TakeOver, RampsAValueThatTheFileChanged) {
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("250 1/s^2"));
  rig.loop->start();
  ticks(*rig.loop, 10);
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  for (int k = 0; k <= kRampTicks; ++k) {
    next.loop->tick();
    EXPECT_DOUBLE_EQ(next.value("stiff"), 100.0 + 150.0 * k / kRampTicks);
  }
  next.loop->tick();
  EXPECT_EQ(next.value("stiff"), 250.0);
}

TEST(TakeOver, LeavesAnEditedValueWhereTheFileSaysTheSame) {
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("250 1/s^2"));
  rig.loop->start();
  edit(*rig.loop, "stiff", 300.0);
  edit(*rig.loop, "soft", 33.0);
  ticks(*rig.loop, 1000);
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  ticks(*next.loop, kRampTicks + 2);
  EXPECT_EQ(next.value("soft"), 33.0);
  EXPECT_EQ(next.value("stiff"), 250.0);  // the file's change wins
  EXPECT_EQ(next.value("count"), 1.0);    // what the behavior counted
}

TEST(TakeOver, RefusesWhatAskedForTheOldValuesRevision) {
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("100 1/s^2"));
  rig.loop->start();
  rig.loop->tick();
  edit(*rig.loop, "soft", 33.0);
  const std::uint64_t revision = rig.loop->edits().revision();
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  engine::EditAnswer answer;
  ASSERT_TRUE(rig.loop->edits().take_answer(answer));
  EXPECT_NE(answer.outcome, engine::EditOutcome::applied);
  EXPECT_EQ(next.loop->edits().revision(), revision + 1);
  next.loop->tick();
  EXPECT_EQ(next.value("soft"), 10.0);
}

TEST(TakeOver, CountsAChangedTimeFromTheEntry) {
  StubRig rig(stand("100 1/s^2", "1 s"));
  Successor next(rig, stand("100 1/s^2", "20 ms"));
  rig.loop->start();
  ticks(*rig.loop, 10);
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  ticks(*next.loop, 20);  // the tick with number 29
  EXPECT_EQ(state_of(*next.loop), "wait");
  next.loop->tick();  // 20 ms are 30 ticks
  EXPECT_EQ(state_of(*next.loop), "later");
}

TEST(TakeOver, HandsOnEventsThatWait) {
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("100 1/s^2"));
  rig.loop->start();
  ticks(*rig.loop, 3);
  rig.loop->machine().raise(rig.behavior->find_event("go"));
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  next.loop->tick();
  EXPECT_EQ(state_of(*next.loop), "later");
}

TEST(TakeOver, AllocatesNothingNorDoesTheTickAfterIt) {
  if (!AllocationGuard::counts()) GTEST_SKIP();
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("250 1/s^2", "1 s", "    third: {}"));
  const behaviors::TakeOverMap back = behaviors::map_take_over(*next.behavior, *rig.behavior);
  rig.loop->start();
  ticks(*rig.loop, 10);
  const AllocationGuard guard;
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  next.loop->tick();
  rig.loop->take_over(*next.loop, back, ValueChange::at_once);
  rig.loop->tick();
  EXPECT_EQ(guard.allocations(), 0);
}

TEST(TakeOver, IsRefusedWhereItsMomentIsNotInTheNewFile) {
  StubRig rig(
      R"({behavior: 1, robot: hume, machine: {states: {hang: {reload: ok, contacts: []}}}})");
  Successor next(
      rig, R"({behavior: 1, robot: hume, machine: {states: {hangs: {reload: ok, contacts: []}}}})");
  const std::vector<std::string> reasons = next.reasons(*rig.behavior);
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_EQ(reasons.front(),
            "the states in which it may be done are not in the file any more: 'hang' (did you mean "
            "'hangs'?)");
  rig.loop->start();
  rig.loop->tick();
  EXPECT_FALSE(next.loop->may_take_over(*rig.loop, next.map));
}

TEST(TakeOver, IsRefusedWhereNoStatePermitsIt) {
  const char* text = R"({behavior: 1, robot: hume, machine: {states: {hang: {contacts: []}}}})";
  StubRig rig(text);
  Successor next(rig, text);
  const std::vector<std::string> reasons = next.reasons(*rig.behavior);
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_NE(reasons.front().find("`reload: ok`"), std::string::npos) << reasons.front();
}

TEST(TakeOver, IsRefusedForAnotherRobot) {
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("100 1/s^2"));
  next.behavior->robot.joints.front().torque_limit += 1.0;
  const std::vector<std::string> reasons = next.reasons(*rig.behavior);
  ASSERT_EQ(reasons.size(), 1U);
  EXPECT_NE(reasons.front().find("other joints"), std::string::npos) << reasons.front();
}

TEST(TakeOver, OfAParallelStateNeedsTheSameRegions) {
  const std::string two =
      R"({behavior: 1, robot: hume, machine: {reload: ok, states: {both: {type: parallel,
    states: {a: {states: {x: {}}}, b: {states: {y: {}}}}}}}})";
  const std::string three =
      R"({behavior: 1, robot: hume, machine: {reload: ok, states: {both: {type: parallel,
    states: {a: {states: {x: {}}}, b: {states: {y: {}}}, c: {states: {z: {}}}}}}}})";
  StubRig rig(two);
  Successor equal(rig, two), more(rig, three);
  rig.loop->start();
  rig.loop->tick();
  EXPECT_TRUE(equal.loop->may_take_over(*rig.loop, equal.map));
  EXPECT_FALSE(more.loop->may_take_over(*rig.loop, more.map));
}

TEST(TakeOver, BackAfterAFaultOnProbationHasTheFormerValuesAtOnceAndNoReaction) {
  StubRig rig(stand("100 1/s^2"));
  Successor next(rig, stand("250 1/s^2"));
  const behaviors::TakeOverMap back = behaviors::map_take_over(*next.behavior, *rig.behavior);
  rig.loop->start();
  edit(*rig.loop, "stiff", 120.0);
  ticks(*rig.loop, 5);
  next.loop->take_over(*rig.loop, next.map, ValueChange::ramped);
  next.loop->set_probation(true);
  ticks(*next.loop, kRampTicks / 2);
  EXPECT_EQ(next.loop->failed_by(), core::Fault::count);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t) { sensors.backend_fault = true; };
  next.loop->sense();
  next.loop->compute();
  EXPECT_EQ(next.loop->failed_by(), core::Fault::simulator_warning);
  EXPECT_EQ(next.loop->state(), engine::LoopState::running);
  rig.hardware->spoil = nullptr;
  rig.loop->take_over(*next.loop, back, ValueChange::at_once);
  rig.loop->compute();
  const int slot = rig.behavior->parameters[at(rig.behavior->find_parameter("stiff"))].slot;
  EXPECT_EQ(rig.loop->machine().parameters()[at(slot)], 120.0);
  // The fault is there still in what was read, and now it counts.
  EXPECT_EQ(rig.loop->state(), engine::LoopState::fallen);
}

TEST(TakeOver, BackIntoAConfigurationThatIsNotThereStartsWhereItWas) {
  StubRig rig(stand("100 1/s^2"));
  rig.loop->start();
  ticks(*rig.loop, 5);
  Successor far(rig, R"(
behavior: 1
robot: hume
machine:
  reload: ok
  states:
    wait: {contacts: [], after: 4 ms, to: elsewhere}
    elsewhere: {contacts: []}
)");
  far.loop->take_over(*rig.loop, far.map, ValueChange::ramped);
  ticks(*far.loop, 20);
  ASSERT_EQ(state_of(*far.loop), "elsewhere");
  const behaviors::TakeOverMap home = behaviors::map_take_over(*far.behavior, *rig.behavior);
  rig.loop->take_over(*far.loop, home, ValueChange::at_once);
  ticks(*rig.loop, 1);
  EXPECT_EQ(state_of(*rig.loop), "wait");
  ticks(*rig.loop, 1498);  // its clock has begun anew, with tick 24, the last one
  EXPECT_EQ(state_of(*rig.loop), "wait");
  ticks(*rig.loop, 1);
  EXPECT_EQ(state_of(*rig.loop), "later");
}

}  // namespace
}  // namespace footfall::tests
