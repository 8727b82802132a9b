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

// What the columns are named after. Fields that only estimators need, or that are of external aids,
// have columns only where `estimation` and `aids` say so (hal::NumberField).
struct InputNames {
  std::vector<std::string> joints, contacts;
  std::vector<std::string> markers{};
  bool estimation = false;
  bool aids = false;
  bool operator==(const InputNames&) const = default;
};

// Columns, in this order: hal::kCommandFields, time_ns, flags, hal::kSensorFields. time_ns and
// flags (hal::kFreshBit, hal::kFlagFields) are integers, all others doubles.
class InputLayout {
 public:
  static constexpr std::string_view kTimeColumn = "time_ns", kFlagsColumn = "flags";

  explicit InputLayout(const InputNames& names);

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
  // Returns fresh. Fields without columns keep their values.
  bool unpack(const std::uint64_t* row, hal::Sensors& sensors,
              hal::Commands& commands) const noexcept;

 private:
  template <typename Field>
  bool has(const Field& field) const noexcept {
    return (!field.estimation || estimation_) && (!field.aids || aids_);
  }

  std::size_t joints_, contacts_, markers_;
  bool estimation_, aids_;
  std::vector<std::string> names_;
  std::vector<std::pair<int, int>> integrals_;
  std::vector<int> quaternions_;
};

// A digest of a table of doubles that changes with any bit of any of them.
std::uint64_t digest(const double* values, int count) noexcept;

}  // namespace footfall::engine
