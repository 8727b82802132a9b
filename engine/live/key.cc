// Key files; see key.h.
#include "engine/live/key.h"

#include <fcntl.h>
#include <sodium.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string_view>

#include "core/process/file_descriptor.h"
#include "core/process/machine_error.h"

namespace footfall::engine {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 2 * std::tuple_size_v<LiveKey>;

[[noreturn]] void fail(const std::string& path, const std::string& text) {
  throw std::runtime_error(path + ": error: " + text);
}

std::string cause() { return std::strerror(errno); }

// Somebody else's file, most often root's: nothing that the command line could mend.
[[noreturn]] void refuse_file(const std::string& path, const std::string& what) {
  const bool denied = errno == EACCES || errno == EPERM;
  throw core::MachineError(
      path + ": error: " + what + ": " + cause() +
      (denied ? "; was it made by root? Remove it, or name another file with --lcm-key" : ""));
}

// What root makes in a user's home (`sudo footfall run --lcm`) belongs to that user.
void give_to_owner_of_folder(const fs::path& made) {
  struct stat facts {};
  if (::geteuid() != 0 || ::stat(made.parent_path().c_str(), &facts) != 0) return;
  if (::lchown(made.c_str(), facts.st_uid, facts.st_gid) != 0)
    refuse_file(made, "cannot give it away");
}

void make_folders(const std::string& path) {
  const fs::path folder = fs::path(path).parent_path();
  if (folder.empty()) return;
  std::error_code error;
  if (fs::exists(folder, error)) return;
  make_folders(folder.string());
  if (::mkdir(folder.c_str(), 0700) == 0) {
    give_to_owner_of_folder(folder);
  } else if (errno != EEXIST) {
    refuse_file(path, "cannot make the folder '" + folder.string() + "'");
  }
}

// False if the file exists already. Written under a temporary name and hard-linked to its own,
// which never replaces a file: no reader sees half a key, and of several writers one wins.
bool write_new_key(const std::string& path) {
  if (sodium_init() < 0) fail(path, "this machine gives no random numbers");
  LiveKey key;
  randombytes_buf(key.data(), key.size());
  std::array<char, kDigits + 1> text{};
  sodium_bin2hex(text.data(), text.size(), key.data(), key.size());
  text[kDigits] = '\n';
  std::string temporary = path + ".XXXXXX";
  const core::FileDescriptor file(::mkstemp(temporary.data()));  // mode 0600
  if (!file.open()) refuse_file(path, "cannot write it");
  const bool written =
      ::write(file.get(), text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
      ::fsync(file.get()) == 0;
  std::string problem = written ? "" : cause();
  const bool linked = written && ::link(temporary.c_str(), path.c_str()) == 0;
  const bool taken = written && !linked && errno == EEXIST;
  if (written && !linked && !taken) problem = cause();
  ::unlink(temporary.c_str());
  sodium_memzero(key.data(), key.size());
  sodium_memzero(text.data(), text.size());
  if (!problem.empty()) throw core::MachineError(path + ": error: cannot write it: " + problem);
  if (linked) give_to_owner_of_folder(path);
  return linked;
}

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

}  // namespace

std::string default_key_path() {
  if (const std::string run = variable("XDG_RUNTIME_DIR"); !run.empty()) {
    return run + "/footfall/lcm.key";
  }
  const std::string home = variable("HOME");
  if (home.empty()) {
    throw core::MachineError(
        "there is no place for the key of live tuning: neither XDG_RUNTIME_DIR nor HOME is set; "
        "name a file with --lcm-key");
  }
  return home + "/.config/footfall/lcm.key";
}

LiveKey read_key(const std::string& path) {
  const core::FileDescriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (!file.open() && errno == ENOENT) {
    fail(path, "no such file; `footfall tune key " + path + "` makes a key");
  }
  if (!file.open()) refuse_file(path, "cannot read it");
  struct stat facts {};
  if (::fstat(file.get(), &facts) != 0) fail(path, "cannot read it: " + cause());
  if (!S_ISREG(facts.st_mode)) fail(path, "expected a file with a key");
  if ((facts.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    fail(path, "others than its owner may read or write this key: chmod 600 '" + path + "'");
  }
  std::array<char, kDigits + 2> text{};
  const ssize_t size = ::read(file.get(), text.data(), text.size());
  LiveKey key;
  std::size_t bytes = 0;
  const bool ends = size == static_cast<ssize_t>(kDigits) ||
                    (size == static_cast<ssize_t>(kDigits) + 1 && text[kDigits] == '\n');
  const bool good = ends && sodium_hex2bin(key.data(), key.size(), text.data(), kDigits, nullptr,
                                           &bytes, nullptr) == 0;
  sodium_memzero(text.data(), text.size());
  if (!good || bytes != key.size()) {
    fail(path, "expected a key of " + std::to_string(kDigits) +
                   " hexadecimal digits; `footfall tune key FILE` makes one");
  }
  return key;
}

void make_key(const std::string& path) {
  make_folders(path);
  if (!write_new_key(path)) fail(path, "there is a file of that name; it is not overwritten");
}

LiveKey default_key() {
  const std::string path = default_key_path();
  struct stat facts {};
  if (::stat(path.c_str(), &facts) != 0 && errno == ENOENT) {
    make_folders(path);
    write_new_key(path);
  }
  return read_key(path);
}

}  // namespace footfall::engine
