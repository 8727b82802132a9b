// Unpacks the files embedded in a log; see attached_files.h.
#include "lab/log/attached_files.h"

#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <system_error>

namespace footfall::lab {

namespace fs = std::filesystem;

LogFolder::LogFolder(const Log& log) {
  std::string name = (fs::temp_directory_path() / "footfall-log-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw std::runtime_error("cannot create the temporary folder '" + name + "'");
  }
  path_ = name;
  try {
    for (const LoggedFile& file : log.files) {
      put(file);
      const std::size_t at_library = file.path.rfind("/behaviors/library/");
      if (at_library == std::string::npos) continue;
      search_.push_back(place_of(file.path.substr(0, at_library)));
    }
  } catch (...) {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    throw;
  }
}

LogFolder::~LogFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string LogFolder::place_of(const std::string& path) const {
  return (path_ / fs::path("/" + path).lexically_normal().relative_path()).string();
}

void LogFolder::put(const LoggedFile& file) const {
  const fs::path to = place_of(file.path);
  fs::create_directories(to.parent_path());
  std::ofstream out(to, std::ios::binary);
  out << file.content;
  if (!out.flush()) throw std::runtime_error("cannot write '" + to.string() + "'");
}

}  // namespace footfall::lab
