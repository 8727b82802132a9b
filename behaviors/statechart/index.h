// Lookup tables of the statechart for the tick, derived from a Chart once at load: per state the
// transitions to be tested, without those that can never be enabled, and sets of states as bits.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "behaviors/compiled/chart.h"

namespace footfall::behaviors {

// A set of states, by index; iterated forwards or backwards in document order. Sized at
// construction.
class StateSet {
 public:
  explicit StateSet(std::size_t states) : words_((states + 63) / 64) {}
  void insert(int s) noexcept { words_[word(s)] |= bit(s); }
  void erase(int s) noexcept { words_[word(s)] &= ~bit(s); }
  bool contains(int s) const noexcept { return (words_[word(s)] & bit(s)) != 0; }
  void clear() noexcept {
    for (std::uint64_t& w : words_) w = 0;
  }
  // Whether it contains one of first .. end-1.
  bool any_in(int first, int end) const noexcept {
    for (std::size_t k = word(first); first < end && k <= word(end - 1); ++k) {
      if ((words_[k] & mask(k, first, end)) != 0) return true;
    }
    return false;
  }
  // Adds the members of `other` among first .. end-1.
  void insert_range(const StateSet& other, int first, int end) noexcept {
    for (std::size_t k = word(first); first < end && k <= word(end - 1); ++k) {
      words_[k] |= other.words_[k] & mask(k, first, end);
    }
  }
  template <typename Function>
  void for_each(Function function) const noexcept {
    for (std::size_t k = 0; k < words_.size(); ++k) {
      for (std::uint64_t w = words_[k]; w != 0; w &= w - 1) {
        function(static_cast<int>(64 * k) + std::countr_zero(w));
      }
    }
  }
  template <typename Function>
  void for_each_reverse(Function function) const noexcept {
    for (std::size_t k = words_.size(); k-- > 0;) {
      for (std::uint64_t w = words_[k]; w != 0;) {
        const int high = 63 - std::countl_zero(w);
        w &= ~(std::uint64_t{1} << static_cast<unsigned>(high));
        function(static_cast<int>(64 * k) + high);
      }
    }
  }

 private:
  static std::size_t word(int s) noexcept { return static_cast<std::size_t>(s) / 64; }
  static std::uint64_t bit(int s) noexcept {
    return std::uint64_t{1} << (static_cast<unsigned>(s) % 64U);
  }
  // The bits of first .. end-1 in word k.
  static std::uint64_t mask(std::size_t k, int first, int end) noexcept {
    std::uint64_t m = ~std::uint64_t{0};
    if (k == word(first)) m &= m << (static_cast<unsigned>(first) % 64U);
    if (k == word(end - 1)) m &= ~std::uint64_t{0} >> (63U - static_cast<unsigned>(end - 1) % 64U);
    return m;
  }
  std::vector<std::uint64_t> words_;
};

// The part of a transition that selection needs.
struct Trigger {
  int transition = 0;
  int guard = -1;
  bool timed = false;
};

struct ChartIndex {
  explicit ChartIndex(const Chart& chart);

  std::vector<Trigger> triggers;
  std::vector<Range> eventless, on_event;  // by state: indices into triggers, in document order
  // By state: itself or the nearest ancestor that has event-less transitions (with `on`); -1: none.
  std::vector<int> first_eventless, first_on_event;
  std::vector<int> timers;           // transitions with `after`
  std::vector<Range> state_timers;   // by state: indices into timers
  std::vector<int> histories;        // history states
  std::vector<Range> own_histories;  // by state: indices into histories, of its children
};

}  // namespace footfall::behaviors
