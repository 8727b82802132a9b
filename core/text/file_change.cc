// Changes several files together; see file_change.h.
#include "core/text/file_change.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include "core/text/write_all.h"

namespace footfall::core {
namespace {

std::string reason(const char* what) { return fmt::format("{}: {}", what, std::strerror(errno)); }

// A file descriptor, closed by the destructor.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int get() const { return number_; }
  bool good() const { return number_ >= 0; }

 private:
  int number_;
};

// Target of a symbolic link; it need not exist yet.
std::string real_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path real =
      std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  return error || real.empty() ? path : real.string();
}

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
  std::string target, part;
  bool renamed = false;
};

// Why the file no longer holds the content that the change was made for; empty if it does. The file
// is open and locked afterwards, so that of two programs that save at the same time the second one
// sees the text of the first. The file may be replaced while waiting for the lock, therefore the
// text is read again by name.
std::string check_target(const FileChange& change, const std::string& target,
                         std::vector<std::unique_ptr<Descriptor>>& locks) {
  if (change.is_new) {
    struct stat there {};
    return ::lstat(target.c_str(), &there) == 0 ? "there is such a file by now" : "";
  }
  locks.push_back(std::make_unique<Descriptor>(::open(target.c_str(), O_RDONLY | O_CLOEXEC)));
  if (!locks.back()->good()) return reason("cannot read");
  if (::flock(locks.back()->get(), LOCK_EX | LOCK_NB) != 0) return "somebody else is saving it";
  const Descriptor now(::open(target.c_str(), O_RDONLY | O_CLOEXEC));
  const auto text = now.good() ? read_all(now.get()) : std::nullopt;
  if (!text) return reason("cannot read");
  if (*text != change.before) return "it has changed meanwhile; nothing was written";
  if (::access(target.c_str(), W_OK) != 0) return reason("cannot write");
  return "";
}

// Writes the new content beside the target, with the target's mode and owner.
std::string stage(Staged& staged) {
  const std::string name = fmt::format("{}.{}.part", staged.target, ::getpid());
  const Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (!file.good()) return reason("cannot write");
  staged.part = name;
  if (!write_all(file.get(), staged.change->after)) return reason("cannot write");
  struct stat old {};
  if (!staged.change->is_new && ::stat(staged.target.c_str(), &old) == 0) {
    const int owned = ::fchown(file.get(), old.st_uid, old.st_gid);
    static_cast<void>(owned);  // needs privileges; else the writer owns the file
    if (::fchmod(file.get(), old.st_mode & 07777) != 0) return reason("cannot keep its mode");
  }
  return ::fsync(file.get()) == 0 ? "" : reason("cannot write");
}

std::string put_in_place(Staged& staged) {
  // A new file must not replace one that was created in the meantime.
  const bool done = staged.change->is_new
                        ? ::link(staged.part.c_str(), staged.target.c_str()) == 0
                        : std::rename(staged.part.c_str(), staged.target.c_str()) == 0;
  if (!done) return reason("cannot write");
  if (staged.change->is_new) ::unlink(staged.part.c_str());
  staged.renamed = true;
  const std::string folder = std::filesystem::path(staged.target).parent_path().string();
  const Descriptor open_folder(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (open_folder.good()) ::fsync(open_folder.get());  // else the name reaches the disk later
  return "";
}

// Restores the old content of the files already renamed, after a later rename failed.
void take_back(std::vector<Staged>& all) {
  for (Staged& staged : all) {
    if (!staged.renamed) continue;
    if (staged.change->is_new) {
      ::unlink(staged.target.c_str());
      continue;
    }
    FileChange back = *staged.change;
    std::swap(back.before, back.after);
    Staged again{&back, staged.target, {}, false};
    if (stage(again).empty()) put_in_place(again);
    if (!again.renamed && !again.part.empty()) ::unlink(again.part.c_str());
  }
}

}  // namespace

std::vector<std::string> write_changes(const std::vector<FileChange>& changes) {
  std::vector<std::string> reasons;
  std::vector<Staged> all;
  std::vector<std::unique_ptr<Descriptor>> locks;
  const auto note = [&](const Staged& staged, const std::string& problem) {
    if (!problem.empty()) reasons.push_back(staged.change->path + ": " + problem);
  };
  for (const FileChange& change : changes)
    all.push_back({&change, real_path(change.path), {}, false});
  for (const Staged& staged : all) note(staged, check_target(*staged.change, staged.target, locks));
  for (Staged& staged : all) {
    if (reasons.empty()) note(staged, stage(staged));
  }
  for (Staged& staged : all) {
    if (reasons.empty()) note(staged, put_in_place(staged));
  }
  if (reasons.empty()) return reasons;
  take_back(all);
  for (const Staged& staged : all) {
    if (!staged.renamed && !staged.part.empty()) ::unlink(staged.part.c_str());
  }
  return reasons;
}

}  // namespace footfall::core
