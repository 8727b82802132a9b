// Temporary file, flush, rename; see whole_file.h.
#include "core/text/whole_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "core/process/file_descriptor.h"
#include "core/process/machine_error.h"
#include "core/process/write_all.h"

namespace footfall::core {
namespace {

[[noreturn]] void fail(const char* what, int error) {
  throw MachineError(fmt::format("{}: {}", what, std::strerror(error)));
}

// Writes the text; returns the failed operation with errno set, nullptr on success.
const char* fill(FileDescriptor& file, const std::string& target, std::string_view text) {
  struct stat old {};
  if (::stat(target.c_str(), &old) == 0) {
    const int owned = ::fchown(file.get(), old.st_uid, old.st_gid);
    static_cast<void>(owned);  // denied to most users: the file is the writer's then
    if (::fchmod(file.get(), old.st_mode & 07777) != 0) return "cannot keep its mode";
  }
  const bool written = write_all(file.get(), text) && ::fsync(file.get()) == 0 && file.close();
  return written ? "" : "cannot write";
}

void write_stream(const std::string& path, std::string_view text) {
  FileDescriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (!file.open() || !write_all(file.get(), text) || !file.close()) fail("cannot write", errno);
}

}  // namespace

std::string real_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  return error || real.empty() ? path : real.string();
}

bool is_stream(const std::string& path) {
  struct stat facts {};
  return ::stat(path.c_str(), &facts) == 0 && !S_ISREG(facts.st_mode) && !S_ISDIR(facts.st_mode);
}

StagedFile::StagedFile(std::string target, std::string_view text) : target_(std::move(target)) {
  std::error_code ignored;
  if (std::filesystem::is_directory(target_, ignored)) fail("cannot write", EISDIR);
  // A rename would put a file in the place of the device or the pipe.
  if (is_stream(target_)) throw MachineError("cannot write: it is a device or a pipe, not a file");
  if (::access(target_.c_str(), W_OK) != 0 && errno != ENOENT) fail("cannot write", errno);
  const std::string part = fmt::format("{}.{}.part", target_, ::getpid());
  FileDescriptor file(::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.open()) fail("cannot write", errno);
  if (const char* problem = fill(file, target_, text); *problem != '\0') {
    const int error = errno;
    ::unlink(part.c_str());
    fail(problem, error);
  }
  part_ = part;
}

StagedFile::~StagedFile() {
  if (!part_.empty()) ::unlink(part_.c_str());
}

void StagedFile::replace() {
  if (std::rename(part_.c_str(), target_.c_str()) != 0) fail("cannot write", errno);
  part_.clear();
  flush_folder();
}

void StagedFile::create() {
  if (::link(part_.c_str(), target_.c_str()) != 0) fail("cannot write", errno);
  ::unlink(std::exchange(part_, {}).c_str());
  flush_folder();
}

// Without this the new name reaches the disk a little later.
void StagedFile::flush_folder() const {
  const std::string folder = std::filesystem::path(target_).parent_path().string();
  const FileDescriptor open_folder(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (open_folder.open()) ::fsync(open_folder.get());
}

void write_whole_file(const std::string& path, std::string_view text) {
  try {
    if (is_stream(path)) return write_stream(path, text);
    StagedFile(real_path(path), text).replace();
  } catch (const std::runtime_error& error) {
    throw MachineError(fmt::format("{}: {}", path, error.what()));
  }
}

std::optional<std::string> read_file(const std::string& path, std::size_t limit,
                                     std::string& problem) {
  static std::mutex mutex;
  static std::map<std::string, std::string> from_pipes;  // by path
  struct stat facts {};
  const bool pipe = path == "-" || (::stat(path.c_str(), &facts) == 0 &&
                                    (S_ISFIFO(facts.st_mode) || S_ISCHR(facts.st_mode)));
  const std::lock_guard lock(mutex);
  if (const auto known = from_pipes.find(path); pipe && known != from_pipes.end()) {
    return known->second;
  }
  errno = 0;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> opened(
      path == "-" ? nullptr : std::fopen(path.c_str(), "rb"),
      [](std::FILE* f) { return f == nullptr ? 0 : std::fclose(f); });
  std::FILE* const file = path == "-" ? stdin : opened.get();
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  std::size_t count = 0;
  while (file != nullptr && text.size() < limit &&
         (count = std::fread(block.data(), 1, block.size(), file)) > 0) {
    text.append(block.data(), count);
  }
  if (file == nullptr || std::ferror(file) != 0) {
    problem = errno != 0 ? std::strerror(errno) : "unknown reason";
    return std::nullopt;
  }
  if (pipe) from_pipes[path] = text;
  return text;
}

std::string read_whole_file(const std::string& path) {
  std::string problem;
  auto text = read_file(path, std::string::npos, problem);
  if (!text) throw std::runtime_error(fmt::format("{}: cannot read: {}", path, problem));
  return std::move(*text);
}

}  // namespace footfall::core
