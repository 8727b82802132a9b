// Timing shared by the benchmarks: parts measured in rounds, one part after the other.
#pragma once

#include <time.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace footfall::tests {

inline double now_us(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

struct Part {
  std::function<void(int)> call;
  int calls = 3000;            // of a round
  std::vector<double> rounds;  // us a call

  void round() {
    const double start = now_us(CLOCK_MONOTONIC);
    for (int i = 0; i < calls; ++i) call(i);
    rounds.push_back((now_us(CLOCK_MONOTONIC) - start) / calls);
  }
  double lowest() const { return *std::min_element(rounds.begin(), rounds.end()); }
  double median() const {
    std::vector<double> sorted = rounds;
    std::sort(sorted.begin(), sorted.end());
    return sorted[sorted.size() / 2];
  }
};

inline double rounded(double value) { return std::round(1000.0 * value) / 1000.0; }

}  // namespace footfall::tests
