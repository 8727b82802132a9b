// Unpacks the files embedded in a log; see attached_files.h.
#include "lab/log/attached_files.h"

#include <filesystem>
#include <fstream>

#include "core/process/machine_error.h"

namespace footfall::lab {

namespace fs = std::filesystem;

LogFolder::LogFolder(const Log& log) {
  for (const LoggedFile& file : log.files) {
    put(file);
    const std::size_t at_library = file.path.rfind("/behaviors/library/");
    if (at_library == std::string::npos) continue;
    search_.push_back(place_of(file.path.substr(0, at_library)));
  }
}

std::string LogFolder::place_of(const std::string& path) const {
  return (folder_.path() / fs::path("/" + path).lexically_normal().relative_path()).string();
}

void LogFolder::put(const LoggedFile& file) const {
  const fs::path to = place_of(file.path);
  fs::create_directories(to.parent_path());
  std::ofstream out(to, std::ios::binary);
  out << file.content;
  if (!out.flush()) throw core::MachineError("cannot write '" + to.string() + "'");
}

}  // namespace footfall::lab
