// Names, locks and leftovers of run folders; see run_folder.h.
#include "lab/run/run_folder.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <stdexcept>

#include "core/process/machine_error.h"
namespace footfall::lab {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLatest = "latest";
// What a run and its report write beside the log.
constexpr const char* kFiles[] = {"log.mcap",    "log.mcap.part", "summary.json", "timing.json",
                                  "result.json", "golden.csv",    "report.html",  "strip.png"};

std::string lock_file(const std::string& folder) { return folder + "/.lock"; }

void make_folder(const std::string& path) {
  std::error_code error;
  fs::create_directories(path, error);
  if (!error && fs::is_directory(path, error)) return;
  throw core::MachineError(
      fmt::format("cannot create the folder '{}': {}", path,
                  error ? error.message() : std::string("there is a file of that name")));
}

std::string local_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::localtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d_%H-%M-%S", &parts);
  return text;
}

// A folder that nobody had before: several runs may begin in one second.
std::string make_new_folder(const std::string& behavior) {
  make_folder(kRunsFolder);
  const std::string name = fmt::format("{}_{}", local_time(), behavior);
  for (int k = 1;; ++k) {
    const std::string path =
        fmt::format("{}/{}{}", kRunsFolder, name, k == 1 ? "" : fmt::format("-{}", k));
    std::error_code error;
    if (fs::create_directory(path, error)) return path;
    if (error) {
      throw core::MachineError(
          fmt::format("cannot create the folder '{}': {}", path, error.message()));
    }
  }
}

// The link is replaced in one step; a reader sees the old run or the new one.
void point_latest_to(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path(), target = fs::path(path).filename();
  const std::string part = (folder / fmt::format(".{}.{}", kLatest, ::getpid())).string();
  const std::string link = (folder / kLatest).string();
  if (::symlink(target.c_str(), part.c_str()) == 0 && ::rename(part.c_str(), link.c_str()) == 0) {
    return;
  }
  const int error = errno;
  ::unlink(part.c_str());
  throw core::MachineError(
      fmt::format("cannot make the link '{}': {}", link, std::strerror(error)));
}

// Old files would be mistaken for this run's.
void clear(const fs::path& folder) {
  std::error_code ignored;
  for (const char* file : kFiles) fs::remove(folder / file, ignored);
  for (int k = 1;; ++k) {
    const fs::path reload = folder / fmt::format("reload-{}", k);
    if (!fs::exists(reload, ignored)) return;
    for (const char* file : kFiles) fs::remove(reload / file, ignored);
    fs::remove(reload, ignored);  // unless it contains other files
  }
}

}  // namespace

RunFolder::RunFolder(const std::string& wanted, const std::string& behavior)
    : path_(wanted.empty() ? make_new_folder(behavior) : wanted) {
  make_folder(path_);
  lock_ = core::FileLock(lock_file(path_));
  if (!lock_.held()) {
    throw std::runtime_error(
        fmt::format("--log: error: another run writes to the folder '{}'", path_));
  }
  clear(path_);
  if (wanted.empty()) point_latest_to(path_);
}

std::string newest_run(const std::string& folder) {
  std::error_code ignored;
  const fs::path latest = fs::path(folder) / kLatest;
  return fs::is_symlink(latest, ignored) && fs::is_directory(latest, ignored) ? latest.string()
                                                                              : folder;
}

std::vector<std::string> run_names(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    std::error_code ignored;
    if (entry.is_symlink(ignored) || !entry.is_directory(ignored)) continue;
    const bool has_log = fs::exists(entry.path() / "log.mcap", ignored) ||
                         fs::exists(entry.path() / "log.mcap.part", ignored);
    if (has_log) names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

void mend_latest(const std::string& folder) {
  const fs::path latest = fs::path(folder) / kLatest;
  std::error_code ignored;
  if (!fs::is_symlink(latest, ignored) || fs::exists(latest, ignored)) return;
  const auto names = run_names(folder);
  if (names.empty()) {
    fs::remove(latest, ignored);
  } else {
    point_latest_to((fs::path(folder) / names.back()).string());
  }
}

bool is_in_use(const std::string& folder) {
  std::error_code ignored;
  return fs::exists(lock_file(folder), ignored) && !core::FileLock(lock_file(folder)).held();
}

}  // namespace footfall::lab
