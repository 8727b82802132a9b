// One writer at a time: a lock file beside what is written.
#pragma once

#include <string>

#include "core/process/file_descriptor.h"

namespace footfall::core {

// Held by this process (no child inherits it) until destruction, which removes the file. The system
// frees it however the process ends; a file that a kill left behind locks nothing.
class FileLock {
 public:
  FileLock() = default;  // nothing
  // Does not wait: held() is false if another process has it. Throws MachineError
  // (`cannot write 'PATH': Permission denied`) if the file cannot be made.
  explicit FileLock(const std::string& path);
  FileLock(FileLock&&) noexcept = default;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();

  bool held() const { return file_.open(); }

 private:
  void release();

  std::string path_;
  FileDescriptor file_;
};

}  // namespace footfall::core
