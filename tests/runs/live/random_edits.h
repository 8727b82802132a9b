// Edits at random, as a person or a broken tool might send them.
#pragma once

#include <footfall_lcm/catalogue_t.hpp>
#include <footfall_lcm/request_t.hpp>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace footfall::tests {

class RandomEdits {
 public:
  // Valid values are within +-20 % of those of the catalogue, and within their ranges.
  RandomEdits(const footfall_lcm::catalogue_t& catalogue, std::uint64_t seed);

  // One to four parameters to new values, to be ramped.
  footfall_lcm::request_t valid();
  // Wrong in one of kWays ways, with something valid beside it where that can be. Revision 0 was
  // in force before anything else was changed.
  static constexpr int kWays = 18;
  footfall_lcm::request_t invalid(int way);
  int below(int count);  // 0 ... count - 1

 private:
  double part();  // 0 to 1
  footfall_lcm::change_t change(std::size_t parameter);
  std::size_t ranged();  // a parameter that has a range
  footfall_lcm::change_t out_of_range(bool above);

  const footfall_lcm::catalogue_t& catalogue_;
  std::mt19937_64 random_;
};

}  // namespace footfall::tests
