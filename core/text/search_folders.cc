// Folders above a file, names in folders; see search_folders.h.
#include "core/text/search_folders.h"

#include <algorithm>
#include <filesystem>
#include <set>

namespace footfall::core {

namespace fs = std::filesystem;

bool is_readable_source(const std::string& path) {
  std::error_code error;
  if (fs::is_regular_file(path, error)) return true;
  const bool opened =
      path.starts_with("/dev/fd/") || path.starts_with("/proc/self/fd/") || path == "/dev/stdin";
  return opened && fs::exists(path, error) && !fs::is_directory(path, error);
}

std::vector<std::string> search_from(const std::string& file,
                                     const std::vector<std::string>& search) {
  std::vector<std::string> folders;
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error).lexically_normal();
  if (!error) {
    for (fs::path folder = absolute.parent_path(); folder != folder.root_path();
         folder = folder.parent_path()) {
      folders.push_back(folder.string());
    }
  }
  folders.insert(folders.end(), search.begin(), search.end());
  return folders;
}

std::vector<std::string> names_in(const std::vector<std::string>& folders, const std::string& place,
                                  const std::string& inside) {
  std::set<std::string> names;
  for (const std::string& folder : folders) {
    std::error_code error;
    for (fs::directory_iterator entry(fs::path(folder) / place, error), end; !error && entry != end;
         entry.increment(error)) {
      std::error_code ignored;
      const fs::path& path = entry->path();
      const bool wanted = inside.empty() ? path.extension() == ".yaml"
                                         : fs::is_regular_file(path / inside, ignored);
      if (wanted) names.insert(inside.empty() ? path.stem().string() : path.filename().string());
    }
  }
  return {names.begin(), names.end()};
}

}  // namespace footfall::core
