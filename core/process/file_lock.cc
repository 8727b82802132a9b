// flock on a file that goes with its owner; see file_lock.h.
#include "core/process/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/process/machine_error.h"
namespace footfall::core {
namespace {

// Whether the open file still has this name: its former owner removes it.
bool still_there(int file, const std::string& path) {
  struct stat opened {
  }, named{};
  return ::fstat(file, &opened) == 0 && ::stat(path.c_str(), &named) == 0 &&
         opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
}

}  // namespace

FileLock::FileLock(const std::string& path) : path_(path) {
  for (;;) {
    FileDescriptor file(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
    if (!file.open()) {
      throw MachineError(fmt::format("cannot write '{}': {}", path, std::strerror(errno)));
    }
    if (::flock(file.get(), LOCK_EX | LOCK_NB) != 0) return;
    if (!still_there(file.get(), path)) continue;
    file_ = std::move(file);
    return;
  }
}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  if (this == &other) return *this;
  release();
  path_ = std::move(other.path_);
  file_ = std::move(other.file_);
  return *this;
}

FileLock::~FileLock() { release(); }

void FileLock::release() {
  if (!file_.open()) return;
  ::unlink(path_.c_str());
  file_.close();
}

}  // namespace footfall::core
