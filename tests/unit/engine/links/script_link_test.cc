// Scripts beside the tick: their answers come with the next one in lock-step, runs repeat, and a
// script that is stuck does not stop the tick.
#include "engine/links/script_link.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "behaviors/loader.h"
#include "tests/support/allocation_guard.h"

namespace footfall::tests {
namespace {

// A statechart with a script beside it, in a folder of its own.
class Scripted {
 public:
  Scripted(const std::string& machine, const std::string& lua)
      : folder_(std::filesystem::temp_directory_path() /
                ("footfall-script-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "s.lua") << lua;
    core::Diagnostics diagnostics;
    behavior = behaviors::load_behavior_text(
        "behavior: 1\nscripts: s.lua\nparameters: {x: {value: 0, range: [-9, 9], live: true}}\n"
        "events: {a: '', b: ''}\n" +
            machine,
        (folder_ / "b.yaml").string(), {}, diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    signals = behavior->signals;
    machine_ = std::make_unique<behaviors::Machine>(*behavior, signals);
    link = std::make_unique<engine::ScriptLink>(*behavior, behaviors::ScriptSettings{});
    machine_->start();
  }
  ~Scripted() { std::filesystem::remove_all(folder_); }

  bool tick(bool wait = true) {
    if (wait) link->wait();
    link->deliver(*machine_);
    machine_->tick(now_++);
    return link->post(*machine_, signals.values(), 0.0);
  }
  void raise(const char* event) { machine_->raise(behavior->find_event(event)); }
  std::string state() const {
    return behavior->states[static_cast<std::size_t>(machine_->active_atomic().front())].name;
  }
  double x() const { return machine_->parameters()[0]; }

  std::unique_ptr<behaviors::Behavior> behavior;
  core::SignalTable signals;
  std::unique_ptr<engine::ScriptLink> link;

 private:
  std::filesystem::path folder_;
  std::unique_ptr<behaviors::Machine> machine_;
  std::int64_t now_ = 0;
};

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
