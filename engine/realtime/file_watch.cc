// Polling of files; see file_watch.h.
#include "engine/realtime/file_watch.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace footfall::engine {

namespace fs = std::filesystem;

namespace {
constexpr int kEmptyLooks = 8;
}  // namespace

FileWatch::FileWatch(const std::vector<std::string>& files, double interval,
                     std::function<std::vector<std::string>()> changed,
                     std::function<void()> each_look)
    : interval_(interval), changed_(std::move(changed)), each_look_(std::move(each_look)) {
  watch_from_now_on(files);
  thread_ = std::thread([this] { work(); });
}

FileWatch::~FileWatch() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

// The content is read only where time or size have changed.
FileWatch::Stamp FileWatch::look(const std::string& path, const Stamp& last) {
  Stamp stamp;
  std::error_code error;
  stamp.time = fs::last_write_time(path, error);
  if (error) return {};
  stamp.size = fs::file_size(path, error);
  if (error) return {};
  stamp.there = true;
  stamp.digest = last.digest;
  if (last.there && last.time == stamp.time && last.size == stamp.size) return stamp;
  std::ifstream in(path, std::ios::binary);
  const std::string content{std::istreambuf_iterator<char>(in), {}};
  stamp.digest = std::hash<std::string>{}(content);
  return stamp;
}

FileWatch::Stamps FileWatch::look_at_all(const Stamps& last) const {
  Stamps now;
  for (const auto& [path, stamp] : last) now[path] = look(path, stamp);
  return now;
}

bool FileWatch::same_content(const Stamps& a, const Stamps& b) {
  for (const auto& [path, stamp] : a) {
    const auto other = b.find(path);
    if (other == b.end() || stamp.there != other->second.there) return false;
    if (stamp.digest != other->second.digest) return false;
  }
  return true;
}

void FileWatch::watch_from_now_on(const std::vector<std::string>& files) {
  Stamps stamps;
  for (const std::string& path : files) {
    const auto found = known_.find(path);
    stamps[path] = found != known_.end() ? found->second : look(path, {});
  }
  known_ = std::move(stamps);
}

bool FileWatch::settled(const Stamps& now, const Stamps& last) {
  if (now != last) {
    empty_looks_ = 0;
    return false;
  }
  const bool empty = std::ranges::any_of(
      now, [](const auto& entry) { return entry.second.there && entry.second.size == 0; });
  return !empty || ++empty_looks_ >= kEmptyLooks;
}

void FileWatch::work() {
  Stamps last = known_;
  std::unique_lock lock(mutex_);
  while (
      !wake_.wait_for(lock, std::chrono::duration<double>(interval_), [this] { return stop_; })) {
    lock.unlock();
    Stamps now = look_at_all(last);
    const bool still = settled(now, last);
    last = std::move(now);
    try {
      if (still && !same_content(last, known_)) {
        known_ = last;
        watch_from_now_on(changed_());
        // A file that is new here was read a moment ago; the others are compared with what was
        // told.
        last = known_;
      }
      if (each_look_) each_look_();
    } catch (const std::exception&) {
      return;
    }
    lock.lock();
  }
}

}  // namespace footfall::engine
