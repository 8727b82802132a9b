// The files that a log holds, on the disk again for as long as they are needed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "lab/log/reader.h"

namespace footfall::lab {

// A temporary folder that is gone with its owner. Throws std::runtime_error with the path.
class LogFolder {
 public:
  explicit LogFolder(const Log& log);
  ~LogFolder();
  LogFolder(const LogFolder&) = delete;
  LogFolder& operator=(const LogFolder&) = delete;

  // Where a file of the log is here: files that name each other relatively still find each other.
  std::string place_of(const std::string& path) const;
  // Where bases and robots that were found by name are: for LoadOptions::search.
  const std::vector<std::string>& search() const { return search_; }

 private:
  void put(const LoggedFile& file) const;

  std::filesystem::path path_;
  std::vector<std::string> search_;
};

}  // namespace footfall::lab
