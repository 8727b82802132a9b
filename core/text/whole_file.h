// Files read and written as a whole: a reader sees the old content or the new, never a part.
#pragma once

#include <string>
#include <string_view>

namespace footfall::core {

// The absolute path behind all symbolic links; its last part need not exist.
std::string real_path(const std::string& path);

// The new content of a file, complete and flushed to disk beside it (`TARGET.PID.part`, in the same
// folder, so that the rename is atomic). The destructor removes it unless it was put in place.
// Errors are std::runtime_error without the path: `cannot write: No space left on device`.
class StagedFile {
 public:
  // `target`: a real path. The mode of a file that exists there is kept, its owner where the
  // system allows that.
  StagedFile(std::string target, std::string_view text);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  // Takes the place of the file that exists, if any.
  void replace();
  // Refuses to take the place of another file.
  void create();

 private:
  void flush_folder() const;

  std::string target_, part_;  // part_ empty: nothing to remove
};

// Replaces or creates the file; a symbolic link stays one, its target is replaced. Throws
// std::runtime_error with the path and the reason; the old file then is intact, nothing is left
// beside it.
void write_whole_file(const std::string& path, std::string_view text);

// The bytes of a file, of stdin for `-`. Throws std::runtime_error with the path and the reason.
std::string read_whole_file(const std::string& path);

}  // namespace footfall::core
