// All of a text into a file descriptor.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <string_view>

namespace footfall::core {

// Goes on where a signal or a full pipe interrupted it; false with errno if it could not.
inline bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace footfall::core
