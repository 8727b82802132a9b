// Spawns a program between two temporary files; see external_program.h.
#include "apps/shared/external_program.h"

#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <memory>
#include <stdexcept>

#include "core/text/write_all.h"

namespace footfall::apps {
namespace {

[[noreturn]] void fail(const std::string& path, const char* what) {
  throw std::runtime_error(fmt::format("{}: {}: {}", path, what, std::strerror(errno)));
}

std::string read_all(std::FILE* file) {
  std::string text;
  std::array<char, 1 << 14> block{};
  std::size_t count = 0;
  while ((count = std::fread(block.data(), 1, block.size(), file)) > 0) {
    text.append(block.data(), count);
  }
  return text;
}

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

}  // namespace

std::string run_program(const std::string& program, const std::string& argument,
                        std::string_view input, const std::string& package) {
  // Temporary files, because with two pipes both processes could block.
  const File in(std::tmpfile(), &std::fclose), out(std::tmpfile(), &std::fclose);
  if (!in || !out) fail(program, "cannot make a temporary file");
  if (!core::write_all(::fileno(in.get()), input)) fail(program, "cannot write its input");
  ::lseek(::fileno(in.get()), 0, SEEK_SET);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(in.get()), STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(out.get()), STDOUT_FILENO);
  std::string name = program, option = argument;
  std::array<char*, 3> arguments{name.data(), option.data(), nullptr};
  pid_t child = 0;
  const int problem =
      ::posix_spawnp(&child, name.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) {
    throw std::runtime_error(fmt::format("cannot run '{}': {} (Debian package {})", program,
                                         std::strerror(problem), package));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    throw std::runtime_error(fmt::format("'{} {}' failed", program, argument));
  }
  std::rewind(out.get());
  return read_all(out.get());
}

}  // namespace footfall::apps
