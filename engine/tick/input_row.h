// One tick's inputs and commands as a row of 64-bit words, every bit kept: what the log stores and
// a replay feeds back.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hal/hardware.h"

namespace footfall::engine {

// Columns, in this order: hal::kCommandFields, time_ns, flags, hal::kSensorFields. time_ns and
// flags (hal::kFreshBit, hal::kFlagFields) are integers, all others doubles.
class InputLayout {
 public:
  static constexpr std::string_view kTimeColumn = "time_ns", kFlagsColumn = "flags";

  InputLayout(const std::vector<std::string>& joints, const std::vector<std::string>& contacts);

  int columns() const noexcept { return static_cast<int>(names_.size()); }
  const std::vector<std::string>& names() const noexcept { return names_; }
  static bool is_integer(std::string_view column) noexcept {
    return column == kTimeColumn || column == kFlagsColumn;
  }
  // Pairs of columns, the second being the integral of the first.
  const std::vector<std::pair<int, int>>& integrals() const noexcept { return integrals_; }
  // The column of the w of each unit quaternion w x y z.
  const std::vector<int>& quaternions() const noexcept { return quaternions_; }

  // fresh: whether the read that gave the sensors brought something new.
  void pack(const hal::Sensors& sensors, bool fresh, const hal::Commands& commands,
            std::uint64_t* row) const noexcept;
  // Returns fresh.
  bool unpack(const std::uint64_t* row, hal::Sensors& sensors,
              hal::Commands& commands) const noexcept;

 private:
  std::size_t joints_, contacts_;
  std::vector<std::string> names_;
  std::vector<std::pair<int, int>> integrals_;
  std::vector<int> quaternions_;
};

// A digest of a table of doubles that changes with any bit of any of them.
std::uint64_t digest(const double* values, int count) noexcept;

}  // namespace footfall::engine
