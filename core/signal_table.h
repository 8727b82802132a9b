// All signals (named numbers) of a run in one flat array, read by expressions, the log and the
// report. Names are registered at load; the tick only writes values by index.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "core/units/units.h"

namespace footfall::core {

// Description of one signal.
struct SignalInfo {
  std::string name;     // dotted, e.g. com.pos.z
  Dimension dimension;  // SI dimension of the value
  std::string doc;      // one line
};

// Registry (load time) and values (tick) of all signals.
class SignalTable {
 public:
  // Registers a signal and returns its index. Registering a name again returns its first index.
  int add(std::string name, Dimension dimension, std::string doc);
  // Index of a name, -1 if absent.
  int find(std::string_view name) const;
  int size() const { return static_cast<int>(infos_.size()); }
  const SignalInfo& info(int index) const { return infos_[static_cast<std::size_t>(index)]; }
  const std::vector<SignalInfo>& infos() const { return infos_; }

  double& operator[](int index) noexcept { return values_[static_cast<std::size_t>(index)]; }
  double operator[](int index) const noexcept { return values_[static_cast<std::size_t>(index)]; }
  const double* values() const noexcept { return values_.data(); }
  double* values() noexcept { return values_.data(); }

 private:
  std::vector<SignalInfo> infos_;
  std::vector<double> values_;
  std::unordered_map<std::string, int> index_;
};

}  // namespace footfall::core
