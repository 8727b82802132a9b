// What becomes of children that end well, crash, hang, flood and leave children behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>

#include "lab/process/pool.h"

namespace footfall::lab {
namespace {

Command shell(const std::string& script, double timeout = 20.0) {
  return {{"sh", "-c", script}, timeout};
}

std::vector<ProcessResult> results_of(const std::vector<Command>& commands,
                                      PoolSettings settings = {}) {
  std::vector<ProcessResult> results(commands.size());
  std::vector<int> calls(commands.size());
  settings.done = [&](std::size_t i, const ProcessResult& result) {
    results[i] = result;
    ++calls[i];
  };
  run_processes(commands, settings);
  EXPECT_THAT(calls, testing::Each(1));
  return results;
}

TEST(ProcessPool, GivesStatusAndBothOutputs) {
  const auto results = results_of({shell("echo hello; echo oh >&2; exit 3")});
  EXPECT_EQ(results[0].end, ProcessEnd::exited);
  EXPECT_EQ(results[0].exit_code, 3);
  EXPECT_EQ(results[0].out, "hello\n");
  EXPECT_EQ(results[0].err, "oh\n");
  EXPECT_GT(results[0].max_resident, 0);
  EXPECT_EQ(describe(results[0]), "exit code 3");
}

TEST(ProcessPool, NamesTheSignalOfACrash) {
  const auto results = results_of({shell("kill -SEGV $$")});
  EXPECT_EQ(results[0].end, ProcessEnd::signalled);
  EXPECT_EQ(results[0].signal, SIGSEGV);
  EXPECT_THAT(describe(results[0]), testing::HasSubstr("SIGSEGV"));
}

TEST(ProcessPool, EndsWhoHangsAndWhoIgnoresThat) {
  PoolSettings settings;
  settings.jobs = 3;
  settings.grace = 0.1;
  const auto results =
      results_of({shell("sleep 60", 0.1), shell("trap '' TERM; sleep 60 & wait; sleep 60", 0.1),
                  shell("exec >&- 2>&-; sleep 60", 0.1)},
                 settings);
  for (const ProcessResult& result : results) {
    EXPECT_EQ(result.end, ProcessEnd::timed_out);
    EXPECT_LT(result.wall_time, 10.0);
  }
}

TEST(ProcessPool, KeepsTheEndOfAFlood) {
  PoolSettings settings;
  settings.keep_out = 1000;
  const auto results = results_of({shell("yes 123456789 | head -n 100000; echo last")}, settings);
  EXPECT_EQ(results[0].exit_code, 0);
  EXPECT_EQ(results[0].out.size(), 1000U);
  EXPECT_TRUE(results[0].truncated);
  EXPECT_TRUE(results[0].out.ends_with("\nlast\n"));
}

TEST(ProcessPool, DoesNotWaitForChildrenThatAreLeftBehind) {
  const auto results = results_of({shell("sleep 60 & echo done")});
  EXPECT_EQ(results[0].end, ProcessEnd::exited);
  EXPECT_EQ(results[0].out, "done\n");
  EXPECT_LT(results[0].wall_time, 10.0);
}

TEST(ProcessPool, TellsThatThereIsNoSuchProgram) {
  const auto results = results_of({{{"/no/such/program"}, 0.0}, {{}, 0.0}, shell("exit 0")});
  EXPECT_EQ(results[0].end, ProcessEnd::not_started);
  EXPECT_THAT(results[0].error, testing::HasSubstr("No such file"));
  EXPECT_EQ(results[1].end, ProcessEnd::not_started);
  EXPECT_EQ(results[2].exit_code, 0);
}

TEST(ProcessPool, RunsAsManyAtOnceAsItIsTold) {
  PoolSettings settings;
  settings.jobs = 2;
  int now = 0, most = 0;
  std::size_t next = 0;
  settings.started = [&](std::size_t i) {
    EXPECT_EQ(i, next++);
    most = std::max(most, ++now);
  };
  settings.done = [&](std::size_t, const ProcessResult&) { --now; };
  run_processes(std::vector<Command>(7, shell("sleep 0.05")), settings);
  EXPECT_EQ(most, 2);
  EXPECT_EQ(next, 7U);
}

TEST(ProcessPool, StopsAllWhenToldTo) {
  std::atomic<bool> stop{false};
  PoolSettings settings;
  settings.jobs = 2;
  settings.stop = &stop;
  settings.started = [&](std::size_t) { stop.store(true); };
  const auto results = results_of(std::vector<Command>(4, shell("sleep 60")), settings);
  for (const ProcessResult& result : results) EXPECT_EQ(result.end, ProcessEnd::cancelled);
}

TEST(ProcessPool, QuotesForAShell) {
  EXPECT_EQ(shell_line({"footfall", "run", "my file.yaml", "it's", ""}),
            R"(footfall run 'my file.yaml' 'it'\''s' '')");
}

}  // namespace
}  // namespace footfall::lab
