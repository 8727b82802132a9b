// A sweep: one behavior or scenario, run with many values of its parameters, in worlds, with faults
// and seeds. Here is what it says (SweepDescription) and which runs follow from that: they are
// numbered, and a number is enough to know a run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.h"

namespace footfall::lab {

// One value of a parameter, as `--set` takes it.
struct SweepValue {
  std::string text;              // `150 ms`, `[220, 237, 400]`
  std::optional<double> number;  // of `text`, in the unit written there; none for a list
  core::Mark mark;
};

// A value of the behavior, the scenario or the world that differs from run to run.
struct SweepAxis {
  std::string name;  // `lift_time`, `gains.single.swing.kp`, `script.1.push.force`, `world.KEY`
  core::Mark mark;
  std::vector<SweepValue> values;
  std::string unit;      // that all values are written with, as text; may be empty
  bool spelled = false;  // each value was written by hand: each is checked
};

// Axes that advance together: one of `vary`, all of `zip`, all of `sample`.
struct SweepGroup {
  std::vector<std::size_t> axes;
  std::size_t size = 0;  // values of each of its axes
};

// What fails; `none` is empty.
struct SweepFault {
  std::string label = "none";  // unique in the sweep: `mocap.dropout`, `mocap.dropout@5 s`
  std::string fault;           // the scenario's word, empty: nothing
  std::string at = "2 s";
  std::string duration;  // empty: to the end
};

struct SweepDescription {
  std::string path, name, doc;
  std::string behavior, scenario;   // paths; one of them
  std::string robot;                // empty: the behavior's
  std::vector<std::string> worlds;  // names or paths; empty: the scenario's, or flat
  std::vector<core::Mark> world_marks;
  std::vector<SweepFault> faults = {SweepFault{}};
  std::vector<std::uint64_t> seeds;
  std::string duration;      // as written; empty: the scenario's
  double duration_s = 20.0;  // s
  double timeout = 0.0;      // s of wall time; 0: from the duration
  std::vector<SweepAxis> axes;
  std::vector<SweepGroup> groups;
  std::vector<std::string> figures;
};

// One run of a sweep.
struct SweepRun {
  std::size_t id = 0;  // from 0
  std::size_t world = 0, fault = 0;
  std::uint64_t seed = 0;
  std::vector<std::size_t> values;  // of each axis: index into its values
};

inline constexpr std::size_t kMostSweepRuns = 1'000'000;

std::size_t run_count(const SweepDescription& sweep);
// Worlds vary slowest, then faults, the groups in their order, seeds fastest.
SweepRun run_of(const SweepDescription& sweep, std::size_t id);
std::string world_of(const SweepDescription& sweep, const SweepRun& run);
// Name and text of every axis, in their order.
std::vector<std::pair<std::string, std::string>> settings_of(const SweepDescription& sweep,
                                                             const SweepRun& run);
// The same for the same run of any sweep of the same behavior: a JSON object in one line.
std::string key_of(const SweepDescription& sweep, const SweepRun& run);

// FNV-1a, 64 bits, as 16 hexadecimal digits: tells texts apart, no more.
std::string digest(const std::string& text);
// Of everything that decides which runs there are, and what is run for how long.
std::string plan_digest(const SweepDescription& sweep);

}  // namespace footfall::lab
