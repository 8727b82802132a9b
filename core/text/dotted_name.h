// Names with parts separated by dots: `gains.single.swing.kp`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace footfall::core {

// The parts, in order; at least one.
inline std::vector<std::string> split_dots(std::string_view name) {
  std::vector<std::string> parts(1);
  for (const char c : name) {
    if (c == '.') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

}  // namespace footfall::core
