// Writes output files and calls programs; see output_file.h.
#include "apps/shared/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
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

void write_whole_file(const std::string& path, std::string_view text) {
  // A symbolic link is kept: its target is replaced.
  std::error_code ignored;
  const std::filesystem::path real = std::filesystem::weakly_canonical(path, ignored);
  const std::string target = ignored || real.empty() ? path : real.string();
  if (std::filesystem::is_directory(target, ignored)) {
    errno = EISDIR;
    fail(path, "cannot write");
  }
  struct stat old {};
  const bool there = ::stat(target.c_str(), &old) == 0;
  if (there && ::access(target.c_str(), W_OK) != 0) fail(path, "cannot write");
  const std::string temporary = fmt::format("{}.{}.part", target, ::getpid());
  const int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) fail(path, "cannot write");
  bool good = core::write_all(file, text);
  if (good && there) good = ::fchmod(file, old.st_mode & 07777) == 0;
  if (good) good = ::fsync(file) == 0;
  int reason = errno;
  if (::close(file) != 0 && good) {
    good = false;
    reason = errno;
  }
  if (good && std::rename(temporary.c_str(), target.c_str()) == 0) return;
  if (good) reason = errno;
  ::unlink(temporary.c_str());
  errno = reason;
  fail(path, "cannot write");
}

std::string read_whole_file(const std::string& path) {
  if (path == "-") return read_all(stdin);
  errno = 0;
  const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) fail(path, "cannot read");
  std::string text = read_all(file.get());
  if (std::ferror(file.get()) != 0) fail(path, "cannot read");
  return text;
}

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
