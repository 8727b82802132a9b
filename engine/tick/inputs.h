// One tick's inputs and commands as a row of 64-bit words, every bit kept: what the log stores and
// a replay feeds back.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "hal/hardware.h"

namespace footfall::engine {

// Columns, in this order: commands (tau of each joint), time_ns, flags, qd, q, tau of each joint,
// gyro, accelerometer, force of each contact (x y z), v_WB, p_WB, q_WB, w_WB_B. time_ns and flags
// are integers, all else doubles.
class InputLayout {
 public:
  // Bits of `flags`; that of contact c is kContact << c.
  static constexpr std::uint64_t kFresh = 1, kTruth = 2, kBodyContact = 4, kBackendFault = 8,
                                 kImuFresh = 16, kMocapFresh = 32, kContact = 256;

  InputLayout(const std::vector<std::string>& joints, const std::vector<std::string>& contacts);

  int columns() const noexcept { return static_cast<int>(names_.size()); }
  const std::vector<std::string>& names() const noexcept { return names_; }
  // Pairs of columns, the second being the integral of the first.
  std::vector<std::pair<int, int>> integrals() const;
  int quaternion() const noexcept { return columns() - 7; }  // column of its w

  // fresh: whether the read that gave the sensors brought something new.
  void pack(const hal::Sensors& sensors, bool fresh, const hal::Commands& commands,
            std::uint64_t* row) const noexcept;
  // Returns fresh.
  bool unpack(const std::uint64_t* row, hal::Sensors& sensors,
              hal::Commands& commands) const noexcept;

 private:
  std::size_t joints_, contacts_;
  std::vector<std::string> names_;
};

// A digest of a table of doubles that changes with any bit of any of them.
std::uint64_t digest(const double* values, int count) noexcept;

}  // namespace footfall::engine
