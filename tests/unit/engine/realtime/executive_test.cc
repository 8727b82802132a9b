// The executive: how a run ends, that the robot is stopped however it ends, what late ticks do, and
// what it hands to the live port and to a loop that takes over.
#include "engine/realtime/executive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <functional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "core/process/stop_signals.h"
#include "tests/support/allocation_guard.h"
#include "tests/unit/engine/realtime/executive_rig.h"

namespace footfall::tests {
namespace {

using core::Fault;
using engine::ControlLoop;
using engine::Executive;
using engine::ExecutiveEnd;
using engine::ExecutiveSettings;
using testing::HasSubstr;

TEST(Executive, TicksUntilAnObserverEndsTheRunAndStopsTheRobot) {
  Robot robot;
  Executive executive(robot.loop, {});
  Watcher watcher(10);
  executive.attach(watcher);
  EXPECT_EQ(executive.run(), ExecutiveEnd::observer);
  EXPECT_EQ(robot.hardware.writes, 10);
  EXPECT_EQ(robot.hardware.stops, 1);
  EXPECT_EQ(watcher.before, 10);
  EXPECT_EQ(watcher.after, 10);
  EXPECT_EQ(watcher.done, "start ");
  EXPECT_EQ(executive.tick_time().count(), 10);
}

TEST(Executive, EndsWithTheLoopsOwnEnd) {
  Robot robot;
  Executive executive(robot.loop, {});
  Watcher watcher(100);
  executive.attach(watcher);
  robot.rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    sensors.backend_fault = tick == 5;
  };
  EXPECT_EQ(executive.run(), ExecutiveEnd::loop);
  EXPECT_EQ(robot.loop.state(), engine::LoopState::fallen);
  EXPECT_EQ(robot.loop.ticks(), 6);
  EXPECT_EQ(robot.hardware.stops, 1);
}

TEST(Executive, ASignalOfTheProcessEndsTheRunAfterTheTickInWhichItCame) {
  Robot robot;
  ExecutiveSettings settings;
  settings.stop = core::stop_on_signals();
  Executive executive(robot.loop, settings);
  Watcher watcher(100);
  watcher.at_tick = [](ControlLoop& loop) {
    if (loop.ticks() == 3) std::raise(SIGTERM);
  };
  executive.attach(watcher);
  EXPECT_EQ(executive.run(), ExecutiveEnd::asked);
  EXPECT_EQ(robot.loop.ticks(), 4);
  EXPECT_EQ(robot.hardware.stops, 1);
  std::signal(SIGTERM, SIG_DFL);
}

// Runs until something throws; the hardware must have been stopped, once, after so many ticks.
void expect_interrupted(Robot& robot, Executive& executive, const char* why, std::int64_t ticks) {
  try {
    executive.run();
    ADD_FAILURE() << "nothing was thrown";
  } catch (const engine::RunInterrupted& error) {
    EXPECT_THAT(error.what(), HasSubstr(why));
    EXPECT_THAT(error.what(), HasSubstr("the robot was stopped at 0.00"));
  }
  EXPECT_EQ(robot.hardware.stops, 1);
  EXPECT_EQ(robot.hardware.writes, ticks);
}

TEST(Executive, AnExceptionOfAnObserverBeforeATickStopsTheRobot) {
  Robot robot;
  Executive executive(robot.loop, {});
  Watcher watcher(100);
  watcher.at_tick = [](ControlLoop& loop) {
    if (loop.ticks() == 3) throw std::runtime_error("error: the disk is full");
  };
  executive.attach(watcher);
  expect_interrupted(robot, executive, "the disk is full", 3);
}

TEST(Executive, AnExceptionOfAnObserverWithinATickStopsTheRobot) {
  Robot robot;
  Executive executive(robot.loop, {});
  Watcher watcher(100);
  watcher.at_compute = [](ControlLoop& loop) {
    if (loop.ticks() == 3) throw 42;
  };
  executive.attach(watcher);
  expect_interrupted(robot, executive, "unknown type", 3);
}

TEST(Executive, AnExceptionOfAReloadStopsTheRobotAndTheLivePort) {
  Robot robot;
  FakePort port;
  Exchange exchange(robot.loop, load_inline(kHang), robot.hardware, &port, 1);
  exchange.broken = true;
  Executive executive(robot.loop, {.live = &port, .exchange = &exchange});
  expect_interrupted(robot, executive, "the reload broke", 0);
  EXPECT_EQ(port.calls, "start stop ");
}

TEST(Executive, WhatCannotStartIsToldAsItIsWithTheRobotStopped) {
  Robot robot;
  FakePort port;
  port.broken = true;
  Executive executive(robot.loop, {.live = &port});
  EXPECT_THROW(
      {
        try {
          executive.run();
        } catch (const std::runtime_error& error) {
          EXPECT_STREQ(error.what(), "no network");
          throw;
        }
      },
      std::runtime_error);
  EXPECT_EQ(robot.hardware.stops, 1);
  EXPECT_EQ(robot.hardware.writes, 0);
  Robot absent;
  absent.hardware.broken = true;
  EXPECT_THROW(Executive(absent.loop, {}).run(), std::runtime_error);
  EXPECT_EQ(absent.hardware.stops, 1);
}

// Late from tick `from` on, for `count` ticks.
std::function<void(ControlLoop&)> sleeper(std::int64_t from, int count) {
  return [from, count](ControlLoop& loop) {
    if (loop.ticks() < from || loop.ticks() >= from + count) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(1.5 * loop.period()));
  };
}

TEST(Executive, ALateTickIsCountedAndTheRunGoesOn) {
  Robot robot;
  robot.rig.behavior->robot.reactions[static_cast<std::size_t>(Fault::tick_overrun)] =
      core::Reaction::safe_stop;
  robot.rig.behavior->robot.overruns = 1'000'000;
  Executive executive(robot.loop, {.paced = true});
  Watcher watcher(20);
  watcher.at_tick = sleeper(5, 4);
  executive.attach(watcher);
  EXPECT_EQ(executive.run(), ExecutiveEnd::observer);
  EXPECT_GE(robot.loop.faults().of(Fault::tick_overrun), 4);
}

TEST(Executive, TooManyLateTicksInARowHaveTheirReaction) {
  Robot robot;
  robot.rig.behavior->robot.reactions[static_cast<std::size_t>(Fault::tick_overrun)] =
      core::Reaction::safe_stop;
  robot.rig.behavior->robot.overruns = 3;
  Executive executive(robot.loop, {.paced = true});
  Watcher watcher(10'000);
  watcher.at_tick = sleeper(0, 10'000);
  executive.attach(watcher);
  EXPECT_EQ(executive.run(), ExecutiveEnd::loop);
  EXPECT_EQ(robot.loop.state(), engine::LoopState::stopped);
  EXPECT_EQ(robot.loop.ended_by(), Fault::tick_overrun);
  // The first tick is on time; the third late one after it is done, and no other.
  EXPECT_EQ(robot.loop.ticks(), 4);
  EXPECT_EQ(robot.loop.faults().of(Fault::tick_overrun), 3);
}

TEST(Late, OnlyTicksInARowAreTheFault) {
  Robot robot;
  robot.rig.behavior->robot.reactions[static_cast<std::size_t>(Fault::tick_overrun)] =
      core::Reaction::safe_state;
  robot.rig.behavior->robot.overruns = 3;
  robot.loop.start();
  for (const bool late : {true, true, false, true, true, false}) {
    robot.loop.late(late);
    robot.loop.tick();
  }
  EXPECT_EQ(robot.loop.faults().of(Fault::tick_overrun), 4);
  EXPECT_EQ(robot.loop.signals()[robot.rig.behavior->layout.tick_late], 4.0);  // `tick.late`
  const auto state = [&] {
    const auto active = robot.loop.machine().active_atomic();
    return robot.rig.behavior->states[static_cast<std::size_t>(active.front())].path;
  };
  EXPECT_EQ(state(), "hang");
  for (int k = 0; k < 3; ++k) {
    robot.loop.late(true);
    robot.loop.tick();
    EXPECT_EQ(state(), k < 2 ? "hang" : "limp");
  }
}

TEST(Executive, HandsEachTickToTheLivePort) {
  Robot robot;
  FakePort port;
  Executive executive(robot.loop, {.live = &port});
  Watcher watcher(10);
  executive.attach(watcher);
  executive.run();
  EXPECT_EQ(port.posts, 10);
  EXPECT_EQ(port.last, &robot.loop);
  EXPECT_EQ(port.calls, "start stop ");
}

TEST(Executive, GoesOnWithALoopThatTookOverAndBackWhenItFails) {
  Robot robot;
  FakePort port;
  Exchange exchange(robot.loop, load_inline(kHang), robot.hardware, &port, 4);
  Executive executive(robot.loop, {.live = &port, .exchange = &exchange});
  Watcher watcher(12);
  std::vector<const ControlLoop*> loops;
  watcher.at_compute = [&](ControlLoop& loop) {
    loops.push_back(&loop);
    port.free = port.free || loop.ticks() == 10;  // it lets go late
  };
  robot.rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    sensors.backend_fault = tick == 7;
  };
  executive.attach(watcher);
  EXPECT_EQ(executive.run(), ExecutiveEnd::loop);  // the fault stays, and now it counts
  EXPECT_EQ(executive.exchanges(), 2);
  EXPECT_EQ(watcher.done, "start exchanged withdrawn exchanged ");
  std::vector<const ControlLoop*> expected(8, &robot.loop);
  for (std::size_t tick : {4, 5, 6}) expected[tick] = &exchange.next();
  EXPECT_EQ(loops, expected);
  EXPECT_EQ(&executive.loop(), &robot.loop);
  EXPECT_EQ(robot.hardware.writes, 8);  // the failed tick's commands never came there
  // The port was still bound anew to the first successor: it is not given the former loop.
  EXPECT_EQ(static_cast<FakePort::Binding*>(port.bound.get())->loop, &exchange.next());
}

TEST(Executive, ItsOwnPartOfATickAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  Robot robot;
  Exchange exchange(robot.loop, load_inline(kHang), robot.hardware, nullptr, 50);
  Executive executive(robot.loop, {.exchange = &exchange});
  Watcher watcher(200);
  std::int64_t before = 0;
  watcher.at_tick = [&](ControlLoop& loop) {
    if (loop.ticks() != 20) return;
    before = core::allocation_count();
    core::arm_allocation_count(true);
  };
  executive.attach(watcher);
  Watcher last(1'000);
  last.at_compute = [](ControlLoop& loop) {
    if (loop.ticks() == 199) core::arm_allocation_count(false);
  };
  executive.attach(last);
  executive.run();
  EXPECT_EQ(executive.exchanges(), 1);
  EXPECT_EQ(core::allocation_count() - before, 0);
}

}  // namespace
}  // namespace footfall::tests
