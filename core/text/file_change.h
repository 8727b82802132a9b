// Files that change together: shown as a diff first, then written, all of them or none.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

// A file's whole content, before and after.
struct FileChange {
  std::string path;
  std::string before, after;
  bool is_new = false;  // there must be no such file yet
};

// What changes in the lines of a text, as `diff -u` shows it, with three lines of context; empty if
// they are equal. `path` stands in both heads; the old one of a new file is /dev/null.
std::string unified_diff(const std::string& path, std::string_view before, std::string_view after,
                         bool is_new = false);

// Writes all files or none: each beside its place and flushed, then all are renamed. A symbolic
// link stays one, a file keeps its mode and, where that is allowed, its owner. Refused if a file
// does not hold `before` any more. Returns the reasons against it (`path: what`); none: it is done.
std::vector<std::string> write_changes(const std::vector<FileChange>& changes);

}  // namespace footfall::core
