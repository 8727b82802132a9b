// Tells when files on the disk have changed, from a thread of its own. It polls, so it works on
// every file system; an editor that writes in several steps is waited for until nothing has moved
// from one look to the next.
#pragma once

#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace footfall::engine {

class FileWatch {
 public:
  // `changed` is called from the watching thread, each time after the content of one of `files` has
  // become another (or there, or gone) and has stayed so from one look to the next, `interval` s
  // apart (an empty file, which an editor may be about to fill, for eight looks); it returns the
  // files to watch from then on. `each_look`, if there is one, is called from the same thread after
  // each look. What they throw ends the watch.
  FileWatch(const std::vector<std::string>& files, double interval,
            std::function<std::vector<std::string>()> changed,
            std::function<void()> each_look = nullptr);
  // Waits for `changed` to return.
  ~FileWatch();
  FileWatch(const FileWatch&) = delete;
  FileWatch& operator=(const FileWatch&) = delete;

 private:
  struct Stamp {
    bool there = false;
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    std::uint64_t digest = 0;  // of the content
    bool operator==(const Stamp&) const = default;
  };
  using Stamps = std::map<std::string, Stamp>;

  static Stamp look(const std::string& path, const Stamp& last);
  static bool same_content(const Stamps& a, const Stamps& b);
  Stamps look_at_all(const Stamps& last) const;
  void watch_from_now_on(const std::vector<std::string>& files);
  bool settled(const Stamps& now, const Stamps& last);
  void work();

  double interval_;
  std::function<std::vector<std::string>()> changed_;
  std::function<void()> each_look_;
  Stamps known_;  // as `changed` was told last
  std::mutex mutex_;
  std::condition_variable wake_;
  int empty_looks_ = 0;  // in a row in which nothing but an empty file was new
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace footfall::engine
