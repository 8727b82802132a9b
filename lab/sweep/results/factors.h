// What differs from run to run, as the report and its tables use it: levels that can be counted.
#pragma once

#include <string>
#include <vector>

#include "lab/sweep/results/statistics.h"
#include "lab/sweep/results/store.h"

namespace footfall::lab {

// A parameter, the world, the fault, or the seed's absence: one of a few levels for each run.
struct SweepFactor {
  std::string name, unit;           // unit of numbers; may be empty
  bool parameter = false;           // an axis, not world or fault
  bool binned = false;              // levels are ranges of many values
  std::vector<std::string> levels;  // in the order of the plan, or of size
  std::vector<int> level;           // of each row of the table; -1: none
  std::vector<double> number;       // of each row, in `unit`; index of the level for what is none
};

// Those with two levels at least.
std::vector<SweepFactor> sweep_factors(const SweepTable& table);
// Runs that passed, of those that passed or failed and fulfil `keep` (by row).
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
// The figures of merit: those that the sweep names, else a few that runs have.
std::vector<std::string> figures_of_merit(const SweepTable& table);
// SI, by the name; may be empty.
std::string figure_unit(const std::string& name);

}  // namespace footfall::lab
