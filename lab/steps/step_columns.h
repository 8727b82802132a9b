// Names, units and meaning of a step's figures: the header of the CSV, the plots of the report and
// docs/log.md say the same, since all derive from this table.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/steps/step_table.h"

namespace footfall::lab {

struct StepColumn {
  std::string_view name;  // without unit
  std::string_view unit;  // SI; empty for a plain number
  std::string_view doc;
  double StepRow::*value;
  // Header in a CSV: `step_time_s`, `speed_m_s`.
  std::string header() const;
};

std::span<const StepColumn> step_columns();

// A table with a line of headers; the foot by its name behind the number. An empty field: not
// known.
std::string steps_csv(const std::vector<StepRow>& rows, const std::vector<std::string>& feet);

}  // namespace footfall::lab
