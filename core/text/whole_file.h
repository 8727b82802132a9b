// Reads and writes complete files: a reader sees either the old or the new content, never a part.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace footfall::core {

// The absolute path with all symbolic links resolved; its last part need not exist.
std::string real_path(const std::string& path);

// Whether the path names something that is no file but takes text: a device, a pipe, a socket.
bool is_stream(const std::string& path);

// The complete new content of a file, flushed to disk beside it (`TARGET.PID.part`, in the same
// folder, so that the rename is atomic). The destructor removes it unless it was put in place.
// Throws MachineError without the path: `cannot write: No space left on device`.
class StagedFile {
 public:
  // `target`: a real path. Keeps the mode of an existing file and, where permitted, its owner.
  // What is there and is no file, a device or a pipe, is refused.
  StagedFile(std::string target, std::string_view text);
  ~StagedFile();
  StagedFile(const StagedFile&) = delete;
  StagedFile& operator=(const StagedFile&) = delete;

  // Renames it to the target, replacing an existing file.
  void replace();
  // Renames it to the target; fails if the target exists.
  void create();

 private:
  void flush_folder() const;

  std::string target_, part_;  // part_ empty: nothing to remove
};

// Replaces or creates the file; a symbolic link is kept, its target is replaced. Throws
// MachineError with the path and the reason; then the old file is unchanged and no temporary
// file remains. A device or a pipe stays what it is: the text is written into it.
void write_whole_file(const std::string& path, std::string_view text);

// The beginning of a file (of stdin for `-`), at least `limit` bytes if it has as many; nullopt and
// the system's reason if it cannot be read. What a pipe or a terminal said is kept: it comes only
// once, and who reads it again gets the same.
std::optional<std::string> read_file(const std::string& path, std::size_t limit,
                                     std::string& problem);
// The whole content of a file, of stdin for `-`. Throws std::runtime_error with the path and the
// reason.
std::string read_whole_file(const std::string& path);

}  // namespace footfall::core
