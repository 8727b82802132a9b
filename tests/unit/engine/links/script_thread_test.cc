// The scripts' thread of a paced run: its priority, when a call of it is stuck, and that the run's
// thread never waits for it.
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/stat.h>
#include <sys/syscall.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <functional>
#include <random>
#include <set>
#include <thread>

#include "tests/support/allocation_guard.h"
#include "tests/unit/engine/links/scripted.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;

constexpr double kPeriod = 1e-3;  // s, of a tick
const std::string kCallsF = "machine: {states: {one: {transitions: [{on: a, do: [{call: f}]}]}}}\n";

bool comes(const std::function<bool()>& what) {
  for (int k = 0; k < 20000; ++k) {
    if (what()) return true;
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  return false;
}

std::set<pid_t> threads() {
  std::set<pid_t> all;
  for (const auto& entry : fs::directory_iterator("/proc/self/task")) {
    all.insert(std::stoi(entry.path().filename().string()));
  }
  return all;
}

// A link and the id of its thread.
class WithThread {
 public:
  WithThread(const std::string& lua, const behaviors::ScriptSettings& settings, bool paced = true)
      : before_(threads()), run(kCallsF, lua, settings, paced) {
    // The threads that made and loaded the script may take a moment to disappear.
    comes([this] { return others().size() == 1; });
    thread = *others().begin();
  }

 private:
  std::set<pid_t> others() const {
    std::set<pid_t> found = threads();
    for (const pid_t id : before_) found.erase(id);
    return found;
  }
  std::set<pid_t> before_;

 public:
  Scripted run;
  pid_t thread = 0;
};

TEST(ScriptThread, OfAPacedRunHasTheLowestPriority) {
  const WithThread paced("function f() end", {}), lockstep("function f() end", {}, false);
  EXPECT_TRUE(comes([&] { return sched_getscheduler(paced.thread) == SCHED_IDLE; }));
  EXPECT_EQ(sched_getscheduler(lockstep.thread), sched_getscheduler(0));
}

TEST(ScriptThread, DoesNotInheritARealtimeClass) {
  const int before = sched_getscheduler(0);
  sched_param priority{};
  priority.sched_priority = 1;
  if (sched_setscheduler(0, SCHED_FIFO, &priority) != 0) GTEST_SKIP() << "needs rights";
  const WithThread paced("function f() end", {});
  priority.sched_priority = 0;
  ASSERT_EQ(sched_setscheduler(0, before, &priority), 0);
  EXPECT_TRUE(comes([&] { return sched_getscheduler(paced.thread) == SCHED_IDLE; }));
}

void do_ticks(Scripted& run, int count) {
  for (int k = 0; k < count; ++k) run.tick(false);
}

// `f` blocks in C until somebody writes to the pipe `gate`, and uses no processor time. What it
// asks for when it comes back after all is not done: a reaction may be to go on.
TEST(ScriptThread, ACallThatUsesNoProcessorTimeIsGivenUpOnlyAtTheBoundInWallTime) {
  behaviors::ScriptSettings settings;
  settings.access.files = true;
  settings.limits.deadline = 0.2;  // s; the bound in wall time: 2 s
  const std::size_t before = threads().size();
  Scripted run(
      kCallsF,
      "function f() io.open(begun, 'w'):close() io.open(gate):close() footfall.set('x', 5) "
      "end\n" +
          ("begun, gate = '" + Scripted::place("begun") + "', '" + Scripted::place("gate") + "'\n"),
      settings);
  ASSERT_EQ(mkfifo(Scripted::place("gate").c_str(), 0600), 0);
  run.raise("a");
  run.tick(false);
  ASSERT_TRUE(comes([] { return fs::exists(Scripted::place("begun")); }));
  run.tick(false);
  do_ticks(run, 300);
  EXPECT_FALSE(run.link->stuck(kPeriod));
  do_ticks(run, 1600);
  EXPECT_FALSE(run.link->stuck(kPeriod));
  do_ticks(run, 200);
  EXPECT_TRUE(run.link->stuck(kPeriod));
  std::ofstream(Scripted::place("gate")) << "";  // ends the call
  EXPECT_TRUE(comes([&] { return threads().size() == before; }));
  run.raise("a");
  do_ticks(run, 3);
  EXPECT_TRUE(run.link->stuck(kPeriod));
  EXPECT_EQ(run.x(), 0.0);
}

// More than a second in one function of Lua's library, which counts no instructions.
TEST(ScriptThread, ACallThatBurnsIsStuckAtItsProcessorTime) {
  behaviors::ScriptSettings settings;
  settings.limits.deadline = 0.02;  // s; the bound in wall time: 1 s
  Scripted run(kCallsF, "function f() string.find(('a'):rep(300), '.-.-.-b') end", settings);
  run.raise("a");
  int ticks = 0;
  long allocations = 0;
  EXPECT_TRUE(comes([&] {
    const AllocationGuard guard;
    run.tick(false);
    ++ticks;
    const bool stuck = run.link->stuck(kPeriod);
    allocations += guard.allocations();
    return stuck;
  }));
  EXPECT_EQ(allocations, 0);
  EXPECT_GT(ticks, 20);
  EXPECT_LT(ticks, 1000);
}

// Some 15 ms each: 150 ms until the tick's answer.
TEST(ScriptThread, EachCallHasItsOwnProcessorTime) {
  behaviors::ScriptSettings settings;
  settings.limits.deadline = 0.06;  // s
  std::string calls;
  for (int k = 0; k < 10; ++k) calls += "{call: f}, ";
  Scripted run("machine: {states: {one: {transitions: [{on: a, do: [" + calls + "{call: g}]}]}}}\n",
               "function f() string.find(('a'):rep(100), '.-.-.-b') end\n"
               "function g() footfall.log('end') end",
               settings);
  run.raise("a");
  bool stuck = false;
  EXPECT_TRUE(comes([&] {
    run.tick(false);
    stuck = stuck || run.link->stuck(kPeriod);
    return !run.link->take_messages().empty();
  }));
  EXPECT_FALSE(stuck);
}

// Holds the thread that it interrupts, as the scheduler may hold one of low priority.
std::atomic<bool> g_held{false}, g_let_on{false}, g_too_long{false};

void hold(int) {
  g_held = true;
  for (int ms = 0; ms < 3000 && !g_let_on; ++ms) {
    const timespec time{0, 1'000'000};
    nanosleep(&time, nullptr);
  }
  if (!g_let_on) g_too_long = true;
  g_held = false;
}

// In one of three rounds or so the thread is held while it hands over its texts.
TEST(ScriptThread, TheRunsThreadNeverWaitsForIt) {
  // The thread may be held inside of malloc(), whose parts a sanitizer replaces by one of its own.
  if (!AllocationGuard::counts()) GTEST_SKIP() << "a sanitizer's heap has locks of its own";
  struct sigaction action {
  }, before{};
  action.sa_handler = hold;
  action.sa_flags = SA_RESTART;
  ASSERT_EQ(sigaction(SIGUSR1, &action, &before), 0);
  WithThread beside(
      "local text = ('x'):rep(900)\nfunction f() for k = 1, 900 do footfall.log(text .. k) end end",
      {}, false);
  std::mt19937 random(1);
  std::size_t texts = 0;
  for (int round = 0; round < 150 && !g_too_long; ++round) {
    g_let_on = false;
    beside.run.raise("a");
    beside.run.tick(false);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 1500));
    ASSERT_EQ(syscall(SYS_tgkill, getpid(), beside.thread, SIGUSR1), 0);
    ASSERT_TRUE(comes([] { return g_held.load(); }));
    for (int k = 0; k < 2; ++k) {
      beside.run.tick(false);
      texts += beside.run.link->take_messages().size();
    }
    g_let_on = true;
    ASSERT_TRUE(comes([] { return !g_held; }));
  }
  EXPECT_FALSE(g_too_long);
  EXPECT_GT(texts, 900U);
  sigaction(SIGUSR1, &before, nullptr);
}

TEST(ScriptThread, TextsThatNobodyTakesAreCounted) {
  Scripted run(kCallsF, "function f() footfall.log('one') footfall.log('two') end");
  for (int k = 0; k < 40; ++k) {
    run.raise("a");
    run.tick();
  }
  run.link->wait();
  EXPECT_EQ(run.link->take_messages().size(), 64U);
  run.raise("a");
  run.tick();
  run.link->wait();
  EXPECT_EQ(run.link->take_messages(),
            (std::vector<std::string>{"one", "two",
                                      "script error: 16 texts were lost: nobody took them"}));
}

}  // namespace
}  // namespace footfall::tests
