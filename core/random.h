// Numbers of a seed, the same with every standard library: the output of std::mt19937_64 is
// standardized, that of the distributions of <random> is not. Nothing allocates.
#pragma once

#include <cmath>
#include <random>

namespace footfall::core {

// Uniform, 0 <= u < 1. Equal bit for bit to std::uniform_real_distribution of libstdc++, with which
// the first seeds were drawn.
inline double uniform(std::mt19937_64& engine) {
  const double u = static_cast<double>(engine()) * 0x1p-64;
  return u < 1.0 ? u : std::nextafter(1.0, 0.0);  // the largest numbers are rounded up
}

// Normal with deviation 1, by Marsaglia's polar method; equal to std::normal_distribution of
// libstdc++ likewise. Numbers come in pairs: the second is kept for the next call. Another engine
// has a function uniform() beside it.
class Normal {
 public:
  template <typename Engine>
  double operator()(Engine& engine) {
    if (kept_) {
      kept_ = false;
      return second_;
    }
    double x = 0.0, y = 0.0, square = 0.0;
    do {
      x = 2.0 * uniform(engine) - 1.0;
      y = 2.0 * uniform(engine) - 1.0;
      square = x * x + y * y;
    } while (square > 1.0 || square == 0.0);
    const double scale = std::sqrt(-2.0 * std::log(square) / square);
    second_ = x * scale;
    kept_ = true;
    return y * scale;
  }

 private:
  double second_ = 0.0;
  bool kept_ = false;
};

}  // namespace footfall::core
