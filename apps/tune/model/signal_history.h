// The past of all signals, and a plot of one as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace footfall::apps {

// A ring of rows: a time and one number a signal.
class SignalHistory {
 public:
  // Forgets all; room for `capacity` rows of `signals` numbers.
  void reset(std::size_t signals, std::size_t capacity);
  // A row of another length is left out. Time that runs backwards begins anew.
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

// A curve in characters.
struct TextPlot {
  std::vector<std::string> rows;  // from above, each of the width asked for
  double low = 0.0, high = 0.0;   // the edges of what is drawn
  bool empty = true;              // no value in the window
};

// The last `window` seconds of a signal in width x height characters: dots of Braille, two across
// and four down in a character, else `*`. Between values of neighbouring columns the line goes on.
TextPlot plot_signal(const SignalHistory& history, std::size_t signal, double window, int width,
                     int height, bool braille);

}  // namespace footfall::apps
