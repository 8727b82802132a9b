// Files that nobody needs afterwards: in $TMPDIR, else in /tmp, for their owner only.
#pragma once

#include <string>

#include "core/process/file_descriptor.h"

namespace footfall::core {

// Removed by the destructor.
class TemporaryFolder {
 public:
  // Throws MachineError that names $TMPDIR if no folder can be made there.
  TemporaryFolder();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

// A file without a name, gone when it is closed. Throws as above.
FileDescriptor temporary_file();

}  // namespace footfall::core
