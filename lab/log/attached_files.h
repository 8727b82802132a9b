// Unpacks the files embedded in a log to a temporary folder.
#pragma once

#include <string>
#include <vector>

#include "core/process/temporary_folder.h"
#include "lab/log/reader.h"

namespace footfall::lab {

// They are there as long as this. Throws std::runtime_error with the path.
class LogFolder {
 public:
  explicit LogFolder(const Log& log);

  // Path of the unpacked copy of a file of the log; relative references between files stay valid.
  std::string place_of(const std::string& path) const;
  // Folders of bases and robots that were found by name, for LoadOptions::search.
  const std::vector<std::string>& search() const { return search_; }

 private:
  void put(const LoggedFile& file) const;

  core::TemporaryFolder folder_;
  std::vector<std::string> search_;
};

}  // namespace footfall::lab
