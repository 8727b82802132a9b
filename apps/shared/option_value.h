// What an option's value may be, with messages for people: CLI11's own ones print the limits of a
// double, and suggest nothing.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace footfall::apps {

// A whole number from `least` on; `what` is "a whole number above 0".
CLI::Validator at_least(std::int64_t least, const char* what);
inline CLI::Validator above_zero() { return at_least(1, "a whole number above 0"); }
// One of `words`; the message suggests the nearest one.
CLI::Validator one_of(std::vector<std::string> words);

}  // namespace footfall::apps
