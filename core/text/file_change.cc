// Changes several files together; see file_change.h.
#include "core/text/file_change.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/process/file_descriptor.h"
#include "core/text/whole_file.h"

namespace footfall::core {
namespace {

std::string reason(const char* what) { return fmt::format("{}: {}", what, std::strerror(errno)); }

std::optional<std::string> read_all(int file) {
  std::string text;
  char block[1 << 14];
  while (true) {
    const ssize_t count = ::read(file, block, sizeof block);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return std::nullopt;
    if (count == 0) return text;
    text.append(block, static_cast<std::size_t>(count));
  }
}

// A staged change: the complete new content in a temporary file beside the target.
struct Staged {
  const FileChange* change = nullptr;
  std::string target;
  std::unique_ptr<StagedFile> file;
  bool in_place = false;
};

// Why the file no longer holds the content that the change was made for; empty if it does. The file
// is open and locked afterwards, so that of two programs that save at the same time the second one
// sees the text of the first. The file may be replaced while waiting for the lock, therefore the
// text is read again by name.
std::string check_target(const FileChange& change, const std::string& target,
                         std::vector<std::unique_ptr<FileDescriptor>>& locks) {
  if (change.is_new) {
    struct stat there {};
    return ::lstat(target.c_str(), &there) == 0 ? "there is such a file by now" : "";
  }
  locks.push_back(std::make_unique<FileDescriptor>(::open(target.c_str(), O_RDONLY | O_CLOEXEC)));
  if (!locks.back()->open()) return reason("cannot read");
  if (::flock(locks.back()->get(), LOCK_EX | LOCK_NB) != 0) return "somebody else is saving it";
  const FileDescriptor now(::open(target.c_str(), O_RDONLY | O_CLOEXEC));
  const auto text = now.open() ? read_all(now.get()) : std::nullopt;
  if (!text) return reason("cannot read");
  if (*text != change.before) return "it has changed meanwhile; nothing was written";
  if (::access(target.c_str(), W_OK) != 0) return reason("cannot write");
  return "";
}

// Stages the new content; returns the reason for a failure, else an empty text.
std::string stage(Staged& staged) {
  try {
    staged.file = std::make_unique<StagedFile>(staged.target, staged.change->after);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string put_in_place(Staged& staged) {
  try {
    // A new file must not replace one that was created in the meantime.
    staged.change->is_new ? staged.file->create() : staged.file->replace();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  staged.in_place = true;
  return "";
}

// Restores the old content of the files already renamed, after a later rename failed.
void take_back(std::vector<Staged>& all) {
  for (Staged& staged : all) {
    if (!staged.in_place) continue;
    if (staged.change->is_new) {
      ::unlink(staged.target.c_str());
      continue;
    }
    FileChange back = *staged.change;
    std::swap(back.before, back.after);
    Staged again{&back, staged.target, nullptr, false};
    if (stage(again).empty()) put_in_place(again);
  }
}

}  // namespace

std::vector<std::string> write_changes(const std::vector<FileChange>& changes) {
  std::vector<std::string> reasons;
  std::vector<Staged> all;
  std::vector<std::unique_ptr<FileDescriptor>> locks;
  const auto note = [&](const Staged& staged, const std::string& problem) {
    if (!problem.empty()) reasons.push_back(staged.change->path + ": " + problem);
  };
  for (const FileChange& change : changes) {
    all.push_back({&change, real_path(change.path), nullptr, false});
  }
  for (const Staged& staged : all) note(staged, check_target(*staged.change, staged.target, locks));
  for (Staged& staged : all) {
    if (reasons.empty()) note(staged, stage(staged));
  }
  for (Staged& staged : all) {
    if (reasons.empty()) note(staged, put_in_place(staged));
  }
  if (reasons.empty()) return reasons;
  take_back(all);
  return reasons;
}

}  // namespace footfall::core
