// Scripts beside the tick: their answers come with the next one in lock-step, runs repeat, and a
// script that is stuck does not stop the tick.
#include <gtest/gtest.h>

#include "tests/support/allocation_guard.h"
#include "tests/unit/engine/links/scripted.h"

namespace footfall::tests {
namespace {

TEST(ScriptLink, ACalledFunctionAnswersWithTheNextTick) {
  Scripted run(
      R"(machine:
  states:
    one: {on_exit: [{call: f}], transitions: [{on: a, to: two}]}
    two: {transitions: [{on: b, to: three}]}
    three: {}
)",
      "function f() footfall.set('x', footfall.parameter('x') + 1) footfall.raise('b') end");
  run.tick();
  run.raise("a");
  run.tick();
  EXPECT_EQ(run.state(), "two");
  EXPECT_EQ(run.x(), 0.0);
  run.tick();
  EXPECT_EQ(run.state(), "three");
  EXPECT_EQ(run.x(), 1.0);
}

TEST(ScriptLink, HandlersHearInternalAndOutsideEventsInTheirOrder) {
  Scripted run("machine: {states: {one: {transitions: [{on: a, do: [{raise: b}]}]}}}\n",
               "footfall.on('*', function(event) footfall.log(event) end)");
  run.tick();
  run.raise("a");
  run.tick();
  run.link->wait();
  EXPECT_EQ(run.link->take_messages(), (std::vector<std::string>{"a", "b"}));
  EXPECT_TRUE(run.link->take_messages().empty());
}

TEST(ScriptLink, AScriptThatIsSlowNeverStopsTheTick) {
  Scripted run("machine: {states: {one: {transitions: [{on: a, do: [{call: slow}]}]}}}\n",
               "function slow() for i = 1, 100000 do end end");
  int dropped = 0;
  for (int k = 0; k < 1000; ++k) {
    run.raise("a");
    if (!run.tick(false)) ++dropped;
  }
  run.link->wait();  // ends: every request that was taken is answered
  EXPECT_LT(dropped, 1000);
}

TEST(ScriptLink, TheTicksSideAllocatesNothing) {
  Scripted run("machine: {states: {one: {transitions: [{on: a, do: [{call: f}]}]}}}\n",
               "function f() footfall.set('x', 1) footfall.raise('b') end");
  run.raise("a");
  run.tick();
  AllocationGuard guard;
  for (int k = 0; k < 50; ++k) {
    run.raise("a");
    run.tick();
  }
  EXPECT_EQ(guard.allocations(), 0);
  EXPECT_EQ(run.x(), 1.0);
}

TEST(ScriptLink, AFunctionThatNobodyDefinesIsFoundAtLoad) {
  try {
    Scripted run("machine: {on_entry: [{call: pik}]}\n", "function pick() end");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(
        std::string(error.what())
            .find("b.yaml:5:29: error: unknown function 'pik': no file of `scripts` defines it"),
        std::string::npos)
        << error.what();
  }
}

TEST(ScriptLink, AMistakeInTheFileIsFoundAtLoadWithItsLine) {
  try {
    Scripted run("machine: {}\n", "\nlocal = 3\n");
    FAIL();
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("s.lua:2:1: error: "), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace footfall::tests
