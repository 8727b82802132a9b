// Bounded single-producer, single-consumer queue, wait-free on both sides, with entries allocated
// at load: edits and events into the tick, answers out of it. Nothing is dropped: the producer
// learns when the queue is full.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace footfall::core {

template <typename T>
class Ring {
 public:
  // All entries are copies of `prototype`, so that memory that they own is allocated here.
  explicit Ring(std::size_t capacity, const T& prototype = T()) : entries_(capacity, prototype) {}

  std::size_t capacity() const noexcept { return entries_.size(); }

  // Producer: the entry to fill, nullptr if the queue is full; publish() passes it to the consumer.
  T* next() noexcept {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == entries_.size()) return nullptr;
    return &entries_[written % entries_.size()];
  }
  void publish() noexcept { written_.fetch_add(1, std::memory_order_release); }

  // Consumer: number of waiting entries, the i-th of them (0: the oldest), release of the oldest
  // `count`.
  std::size_t waiting() const noexcept {
    return static_cast<std::size_t>(written_.load(std::memory_order_acquire) -
                                    read_.load(std::memory_order_relaxed));
  }
  T& at(std::size_t i) noexcept {
    return entries_[(read_.load(std::memory_order_relaxed) + i) % entries_.size()];
  }
  const T& at(std::size_t i) const noexcept {
    return entries_[(read_.load(std::memory_order_relaxed) + i) % entries_.size()];
  }
  void release(std::size_t count) noexcept { read_.fetch_add(count, std::memory_order_release); }

 private:
  std::vector<T> entries_;
  std::atomic<std::uint64_t> written_{0}, read_{0};
};

}  // namespace footfall::core
