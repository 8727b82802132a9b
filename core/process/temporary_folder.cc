// mkdtemp, mkostemp; see temporary_folder.h.
#include "core/process/temporary_folder.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>  // NOLINT: mkdtemp is POSIX
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>

#include "core/process/machine_error.h"
namespace footfall::core {
namespace {

bool is_given(const char* variable) { return variable != nullptr && *variable != '\0'; }

std::string parent_folder() {
  const char* const variable = std::getenv("TMPDIR");
  return is_given(variable) ? variable : "/tmp";
}

[[noreturn]] void fail(const char* what) {
  const int error = errno;
  throw MachineError(fmt::format("cannot make a temporary {} in '{}'{}: {}", what, parent_folder(),
                                 is_given(std::getenv("TMPDIR")) ? " (TMPDIR)" : "",
                                 std::strerror(error)));
}

}  // namespace

TemporaryFolder::TemporaryFolder() : path_(parent_folder() + "/footfall-XXXXXX") {
  if (::mkdtemp(path_.data()) == nullptr) fail("folder");
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

FileDescriptor temporary_file() {
  std::string path = parent_folder() + "/footfall-XXXXXX";
  FileDescriptor file(::mkostemp(path.data(), O_CLOEXEC));
  if (!file.open()) fail("file");
  ::unlink(path.c_str());
  return file;
}

}  // namespace footfall::core
