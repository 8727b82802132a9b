// Starts a program between two temporary files; see external_program.h.
#include "apps/shared/external_program.h"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "core/process/file_descriptor.h"
#include "core/process/machine_error.h"
#include "core/process/temporary_folder.h"
#include "core/process/write_all.h"

namespace footfall::apps {
namespace {

constexpr int kNotFound = 127;  // exit code of a child without a program, as the shell's

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw core::MachineError(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

std::string read_all(int file) {
  ::lseek(file, 0, SEEK_SET);
  std::string text;
  std::array<char, 1 << 14> block{};
  for (;;) {
    const ssize_t count = ::read(file, block.data(), block.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(block.data(), static_cast<std::size_t>(count));
  }
}

// In the child: only calls that are allowed between fork() and exec(). Returns if there is no such
// program.
void become(std::array<char*, 3>& arguments, int in, int out, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // it never outlives this program
  if (::getppid() != parent) return;
  std::signal(SIGPIPE, SIG_DFL);
  ::dup2(in, STDIN_FILENO);
  ::dup2(out, STDOUT_FILENO);
  ::execvp(arguments[0], arguments.data());
}

}  // namespace

std::string run_program(const std::string& program, const std::string& argument,
                        std::string_view input, const std::string& package) {
  // Files, because with two pipes both processes could block.
  const core::FileDescriptor in = core::temporary_file(), out = core::temporary_file();
  if (!core::write_all(in.get(), input)) fail(program, "cannot write its input");
  ::lseek(in.get(), 0, SEEK_SET);
  std::string name = program, option = argument;
  std::array<char*, 3> arguments{name.data(), option.data(), nullptr};
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) fail(program, "cannot be started");
  if (child == 0) {
    become(arguments, in.get(), out.get(), parent);
    ::_exit(kNotFound);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == kNotFound) {
    throw core::MachineError(
        fmt::format("cannot run '{}': install the Debian package {}", program, package));
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw core::MachineError(fmt::format("'{} {}' failed", program, argument));
  }
  return read_all(out.get());
}

}  // namespace footfall::apps
