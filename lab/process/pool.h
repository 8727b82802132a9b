// Runs many programs in parallel and collects their results: exit status, output, time. A child
// that crashes, hangs, floods its output or leaves children behind is a result, not an error of the
// caller. POSIX processes; one thread, which runs only the pool until all are done.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace footfall::lab {

struct Command {
  std::vector<std::string> arguments;  // the first one is the program: a path, or a name on PATH
  double timeout = 0.0;                // s of wall time; 0: none
};

enum class ProcessEnd {
  exited,       // exited normally, with exit_code
  signalled,    // died of `signal`
  timed_out,    // killed after Command::timeout
  cancelled,    // killed, or never started, because the caller stopped the pool
  not_started,  // program not found, or out of resources: see `error`
};

struct ProcessResult {
  ProcessEnd end = ProcessEnd::cancelled;
  int exit_code = -1;
  int signal = 0;
  std::string error;       // why it could not be started
  std::string out, err;    // the last bytes of stdout and stderr, see PoolSettings
  bool truncated = false;  // more output was written than is kept
  double wall_time = 0.0;  // s
  double cpu_time = 0.0;   // s, user and system
  long max_resident = 0;   // kB
};

struct PoolSettings {
  int jobs = 1;                                  // maximum number of parallel children
  const std::atomic<bool>* stop = nullptr;       // set by Ctrl-C: kills all children, starts none
  std::size_t keep_out = std::size_t{4} << 20;   // bytes of stdout kept
  std::size_t keep_err = std::size_t{64} << 10;  // bytes of stderr kept
  double grace = 2.0;                            // s from SIGTERM to SIGKILL
  std::size_t memory = 0;                    // bytes of address space of each child; 0: no limit
  std::function<void(std::size_t)> started;  // index of the command; may be empty
  // Called once a command, in the order in which they end. If it throws, all children are killed.
  std::function<void(std::size_t, const ProcessResult&)> done;
};

// Returns when every command has a result. Every child leads its own process group, which is killed
// as a whole; its stdin is empty and it writes no core file.
void run_processes(const std::vector<Command>& commands, const PoolSettings& settings);

// Children started from now on can die with this process, however it ends; see die_with_parent().
void announce_to_children();
// To be called first in the child: the kernel kills it when its parent dies. No effect unless the
// parent called announce_to_children().
void die_with_parent();

// Number of processors of this machine, at least 1.
int processor_count();
// `died of SIGSEGV (Segmentation fault)`, `exit code 2`, `no end after 60 s`, ...
std::string describe(const ProcessResult& result);
// An argument list as a shell command line, quoted where needed.
std::string shell_line(const std::vector<std::string>& arguments);

}  // namespace footfall::lab
