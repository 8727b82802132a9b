// The factors of a sweep for its report and tables: what differs between runs, as countable levels.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/results/statistics.h"
#include "lab/sweep/results/store.h"

namespace footfall::lab {

// A parameter, the world, or the fault; each run has one of its levels.
struct SweepFactor {
  std::string name, unit;           // unit of `number`; may be empty
  bool parameter = false;           // an axis, not the world or the fault
  bool binned = false;              // levels are ranges of many values
  std::vector<std::string> levels;  // in plan order, or by size
  std::vector<int> level;           // level of each row of the table; -1: none
  std::vector<double> number;       // of each row, in `unit`; index of the level if not numeric
};

// All factors with at least two levels.
std::vector<SweepFactor> sweep_factors(const SweepTable& table);
// Number of passed runs, among those that passed or failed and satisfy `keep` (by row).
template <typename Keep>
Share share_of(const SweepTable& table, Keep keep) {
  Share share;
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const SweepStatus status = table.rows[r].result.status;
    if ((status != SweepStatus::passed && status != SweepStatus::failed) || !keep(r)) continue;
    ++share.of;
    if (status == SweepStatus::passed) ++share.good;
  }
  return share;
}
// The figures of merit: those that the sweep names, else a default selection.
std::vector<std::string> figures_of_merit(const SweepTable& table);
// SI unit, derived from the name; may be empty.
std::string figure_unit(const std::string& name);

}  // namespace footfall::lab
