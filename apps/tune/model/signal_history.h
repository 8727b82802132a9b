// History of all signals, and a plot of one as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace footfall::apps {

// A ring buffer of rows: a time and one number a signal.
class SignalHistory {
 public:
  // Clears all rows; capacity for `capacity` rows of `signals` numbers.
  void reset(std::size_t signals, std::size_t capacity);
  // Ignores a row of another length. Clears the history if time runs backwards.
  void add(double time, std::span<const float> row);

  std::size_t size() const { return size_; }
  // Row `i`, 0 the oldest.
  double time(std::size_t i) const { return times_[slot(i)]; }
  float value(std::size_t i, std::size_t signal) const {
    return rows_[slot(i) * signals_ + signal];
  }

 private:
  std::size_t slot(std::size_t i) const {
    return (next_ + times_.size() - size_ + i) % times_.size();
  }

  std::vector<double> times_;
  std::vector<float> rows_;
  std::size_t signals_ = 0, next_ = 0, size_ = 0;
};

// A curve drawn with characters.
struct TextPlot {
  std::vector<std::string> rows;  // top to bottom, each of the requested width
  double low = 0.0, high = 0.0;   // limits of the vertical axis
  bool empty = true;              // no value in the time window
};

// The last `window` seconds of a signal in width x height characters: Braille dots, two across and
// four down in a character, else `*`. Values of neighbouring columns are connected.
TextPlot plot_signal(const SignalHistory& history, std::size_t signal, double window, int width,
                     int height, bool braille);

}  // namespace footfall::apps
