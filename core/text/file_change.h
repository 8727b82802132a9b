// Changes several files together: shown as a diff first, then either all are written or none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

// A file's whole content, before and after.
struct FileChange {
  std::string path;
  std::string before, after;
  bool is_new = false;  // the file must not exist yet
};

// Line differences as printed by `diff -u`, with three lines of context; empty if the texts are
// equal. `path` is in both header lines; for a new file the old one is /dev/null.
std::string unified_diff(const std::string& path, std::string_view before, std::string_view after,
                         bool is_new = false);

// Writes all files or none: each to a flushed temporary file beside its target, then all are
// renamed. Keeps symbolic links, modes and, where permitted, owners. Refuses if a file no longer
// holds `before`. Returns the reasons for refusal (`path: reason`); empty if everything was
// written.
std::vector<std::string> write_changes(const std::vector<FileChange>& changes);

}  // namespace footfall::core
