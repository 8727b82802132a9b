// The name of this machine, for people.
#pragma once

#include <unistd.h>

#include <array>
#include <string>

#include "core/text/printable.h"

namespace footfall::engine {

inline std::string host_name() {
  std::array<char, 64> host{};
  ::gethostname(host.data(), host.size() - 1);
  return core::on_one_line(host.data());
}

}  // namespace footfall::engine
