// Children under posix_spawn and poll; see pool.h.
#include "lab/process/pool.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <utility>

#include "core/process/file_descriptor.h"

extern char** environ;  // NOLINT: POSIX gives it no header

namespace footfall::lab {
namespace {

using core::FileDescriptor;
using Clock = std::chrono::steady_clock;

// Longest delay until a child is noticed that closed its pipes but keeps running.
constexpr int kPollPeriodMs = 20;

constexpr const char* kParent = "FOOTFALL_PARENT";

double since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Output of a pipe, of which only the end is kept.
struct Stream {
  FileDescriptor fd;
  std::string* text = nullptr;
  std::size_t keep = 0;

  // Reads the available data; true if something was discarded.
  bool drain() {
    std::array<char, 65536> buffer;
    bool cut = false;
    while (fd.open()) {
      const ssize_t count = ::read(fd.get(), buffer.data(), buffer.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0 && errno == EAGAIN) break;
      if (count <= 0) {
        fd.close();
        break;
      }
      text->append(buffer.data(), static_cast<std::size_t>(count));
      // Discard half at once: discarding a little each time would copy the whole buffer each time.
      if (text->size() > 2 * keep) {
        text->erase(0, text->size() - keep);
        cut = true;
        break;  // a child that floods its output must not delay the others
      }
    }
    return cut;
  }
};

struct Child {
  std::size_t index = 0;
  pid_t pid = -1;
  Clock::time_point start, terminated;
  Stream out, err;
  bool terminating = false, killed = false;
  ProcessEnd why = ProcessEnd::exited;  // why we killed it, if we did
  ProcessResult result;
};

void make_pipe(FileDescriptor& read_end, FileDescriptor& write_end) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
  read_end = FileDescriptor(ends[0]);
  write_end = FileDescriptor(ends[1]);
  ::fcntl(ends[0], F_SETFL, O_NONBLOCK);
}

void limit(pid_t pid, __rlimit_resource resource, rlim_t value) {
  const rlimit both = {value, value};
  ::prlimit(pid, resource, &both, nullptr);
}

// Returns 0, or the error number of the failed call.
int spawn(const Command& command, int out, int err, pid_t& pid) {
  std::vector<char*> arguments;
  for (const std::string& argument : command.arguments) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t files;
  posix_spawn_file_actions_init(&files);
  posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&files, err, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none, defaults;
  sigemptyset(&none);
  sigemptyset(&defaults);
  for (const int number : {SIGINT, SIGTERM, SIGPIPE}) sigaddset(&defaults, number);
  posix_spawnattr_setsigmask(&attributes, &none);
  posix_spawnattr_setsigdefault(&attributes, &defaults);
  posix_spawnattr_setpgroup(&attributes, 0);
  posix_spawnattr_setflags(&attributes,
                           POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
  const int error =
      ::posix_spawnp(&pid, arguments[0], &files, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error;
}

class Pool {
 public:
  Pool(const std::vector<Command>& commands, const PoolSettings& settings)
      : commands_(commands), settings_(settings) {}

  // Children remain only after an exception.
  ~Pool() {
    for (const auto& child : running_) {
      ::kill(-child->pid, SIGKILL);
      ::waitpid(child->pid, nullptr, 0);
    }
  }

  void run() {
    std::size_t next = 0;
    while (next < commands_.size() || !running_.empty()) {
      if (stopping()) {
        for (; next < commands_.size(); ++next) settings_done(next, ProcessResult{});
        for (const auto& child : running_) terminate(*child, ProcessEnd::cancelled);
      }
      while (next < commands_.size() && static_cast<int>(running_.size()) < jobs()) start(next++);
      if (running_.empty()) continue;
      wait_for_output();
      for (const auto& child : running_) enforce_limits(*child);
      reap();
    }
  }

 private:
  bool stopping() const { return settings_.stop != nullptr && settings_.stop->load(); }
  int jobs() const { return std::max(settings_.jobs, 1); }

  void settings_done(std::size_t index, const ProcessResult& result) const {
    if (settings_.done) settings_.done(index, result);
  }

  void start(std::size_t index) {
    auto child = std::make_unique<Child>();
    child->index = index;
    child->out = {FileDescriptor(), &child->result.out, settings_.keep_out};
    child->err = {FileDescriptor(), &child->result.err, settings_.keep_err};
    child->start = Clock::now();
    int error = commands_[index].arguments.empty() ? ENOENT : 0;
    if (error == 0) {
      FileDescriptor out, err;
      try {
        make_pipe(child->out.fd, out);
        make_pipe(child->err.fd, err);
        error = spawn(commands_[index], out.get(), err.get(), child->pid);
      } catch (const std::runtime_error&) {
        error = errno;
      }
    }
    if (error != 0) {
      child->result.end = ProcessEnd::not_started;
      child->result.error = std::strerror(error);
      settings_done(index, child->result);
      return;
    }
    limit(child->pid, RLIMIT_CORE, 0);
    if (settings_.memory > 0) limit(child->pid, RLIMIT_AS, settings_.memory);
    running_.push_back(std::move(child));
    if (settings_.started) settings_.started(index);
  }

  void wait_for_output() {
    polled_.clear();
    for (const auto& child : running_) {
      for (const Stream* stream : {&child->out, &child->err}) {
        if (stream->fd.open()) polled_.push_back({stream->fd.get(), POLLIN, 0});
      }
    }
    // Both pipes are closed, so the child exits within microseconds.
    const bool ending = std::ranges::any_of(
        running_, [](const auto& child) { return !child->out.fd.open() && !child->err.fd.open(); });
    ::poll(polled_.data(), polled_.size(), ending ? 1 : kPollPeriodMs);
    for (const auto& child : running_) {
      for (Stream* stream : {&child->out, &child->err}) {
        if (stream->drain()) child->result.truncated = true;
      }
    }
  }

  void terminate(Child& child, ProcessEnd why) const {
    if (child.terminating) return;
    child.terminating = true;
    child.terminated = Clock::now();
    child.why = why;
    ::kill(-child.pid, SIGTERM);
  }

  void enforce_limits(Child& child) const {
    const double timeout = commands_[child.index].timeout;
    if (timeout > 0.0 && since(child.start) > timeout) terminate(child, ProcessEnd::timed_out);
    if (child.terminating && !child.killed && since(child.terminated) > settings_.grace) {
      child.killed = true;
      ::kill(-child.pid, SIGKILL);
    }
  }

  void reap() {
    for (std::size_t i = 0; i < running_.size();) {
      Child& child = *running_[i];
      int status = 0;
      rusage usage{};
      // The process stays a zombie until its group is killed, so that its id cannot be reused.
      siginfo_t info{};
      if (::waitid(P_PID, static_cast<id_t>(child.pid), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
          info.si_pid == 0) {
        ++i;
        continue;
      }
      ::kill(-child.pid, SIGKILL);
      ::wait4(child.pid, &status, 0, &usage);
      finish(child, status, usage);
      const std::unique_ptr<Child> ended = std::move(running_[i]);
      running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(i));
      settings_done(ended->index, ended->result);
    }
  }

  void finish(Child& child, int status, const rusage& usage) const {
    ProcessResult& result = child.result;
    for (Stream* stream : {&child.out, &child.err}) {
      // Bounded: a grandchild that left the process group may write forever.
      for (int reads = 0; reads < 8 && stream->drain(); ++reads) result.truncated = true;
      if (stream->text->size() > stream->keep) {
        stream->text->erase(0, stream->text->size() - stream->keep);
        result.truncated = true;
      }
    }
    const auto seconds = [](const timeval& t) {
      return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    result.wall_time = since(child.start);
    result.cpu_time = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    result.max_resident = usage.ru_maxrss;
    if (WIFEXITED(status)) {
      result.end = ProcessEnd::exited;
      result.exit_code = WEXITSTATUS(status);
    } else {
      result.end = ProcessEnd::signalled;
      result.signal = WTERMSIG(status);
    }
    if (child.terminating) result.end = child.why;
  }

  const std::vector<Command>& commands_;
  const PoolSettings& settings_;
  std::vector<std::unique_ptr<Child>> running_;
  std::vector<pollfd> polled_;
};

}  // namespace

void run_processes(const std::vector<Command>& commands, const PoolSettings& settings) {
  Pool(commands, settings).run();
}

int processor_count() { return static_cast<int>(std::max(::sysconf(_SC_NPROCESSORS_ONLN), 1L)); }

std::string describe(const ProcessResult& result) {
  switch (result.end) {
    case ProcessEnd::exited:
      return fmt::format("exit code {}", result.exit_code);
    case ProcessEnd::signalled:
      return fmt::format("died of SIG{} ({})", ::sigabbrev_np(result.signal),
                         ::strsignal(result.signal));
    case ProcessEnd::timed_out:
      return fmt::format("no end after {:.3g} s: killed", result.wall_time);
    case ProcessEnd::cancelled:
      return "stopped";
    case ProcessEnd::not_started:
      return "could not be started: " + result.error;
  }
  return "";
}

void announce_to_children() { ::setenv(kParent, std::to_string(::getpid()).c_str(), 1); }

void die_with_parent() {
  const char* text = std::getenv(kParent);
  if (text == nullptr) return;
  const long parent = std::atol(text);
  ::unsetenv(kParent);  // not inherited by its own children
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != static_cast<pid_t>(parent)) std::_Exit(1);  // the parent died before prctl
}

std::string shell_line(const std::vector<std::string>& arguments) {
  std::string line;
  for (const std::string& argument : arguments) {
    const bool plain = !argument.empty() && std::ranges::all_of(argument, [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
             std::strchr("_-./=:,+@%", c) != nullptr;
    });
    if (!line.empty()) line += ' ';
    if (plain) {
      line += argument;
      continue;
    }
    line += '\'';
    for (const char c : argument) line += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += '\'';
  }
  return line;
}

}  // namespace footfall::lab
