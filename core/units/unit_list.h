// Every unit allowed in files, for documents and editors.
#pragma once

#include <string_view>
#include <vector>

#include "core/units/units.h"

namespace footfall::core {

// A unit such as `ms`: factor 1e-3, a time.
struct UnitInfo {
  std::string_view name;
  double factor = 1.0;
  Dimension dimension;
};

// All units, sorted by dimension.
std::vector<UnitInfo> all_units();

}  // namespace footfall::core
