// A sweep: one behavior or scenario, run with many values of its parameters, in several worlds,
// with faults and seeds. Its description (SweepDescription) and the runs that follow from it: a run
// is identified by its number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/diagnostics/diagnostics.h"

namespace footfall::lab {

// One value of a parameter, in the notation of `--set`.
struct SweepValue {
  std::string text;              // `150 ms`, `[220, 237, 400]`
  std::optional<double> number;  // number in `text`, in its unit; nullopt for a list
  core::Mark mark;
};

// A value of the behavior, the scenario or the world that is varied.
struct SweepAxis {
  std::string name;  // `lift_time`, `gains.single.swing.kp`, `script.1.push.force`, `world.KEY`
  core::Mark mark;
  std::vector<SweepValue> values;
  std::string unit;      // common unit of all values, as text; may be empty
  bool spelled = false;  // values are listed individually: check each of them
};

// Axes that vary together: one of `vary`, all of `zip`, all of `sample`.
struct SweepGroup {
  std::vector<std::size_t> axes;
  std::size_t size = 0;  // number of values of each of its axes
};

// An injected fault; the default is `none`.
struct SweepFault {
  std::string label = "none";  // unique in the sweep: `mocap.dropout`, `mocap.dropout@5 s`
  std::string fault;           // the scenario's keyword; empty: none
  std::string at = "2 s";
  std::string duration;  // empty: to the end of the run
};

struct SweepDescription {
  std::string path, name, doc;
  std::string behavior, scenario;   // paths; exactly one is set
  std::string robot;                // empty: the behavior's
  std::vector<std::string> worlds;  // names or paths; empty: the scenario's, or flat
  std::vector<core::Mark> world_marks;
  std::vector<SweepFault> faults = {SweepFault{}};
  std::vector<std::uint64_t> seeds;
  core::Mark seeds_mark;
  std::string duration;      // as written; empty: the scenario's
  double duration_s = 20.0;  // s
  double timeout = 0.0;      // s of wall time; 0: derived from the duration
  std::vector<SweepAxis> axes;
  std::vector<SweepGroup> groups;
  std::vector<std::string> figures;
};

// One run of a sweep.
struct SweepRun {
  std::size_t id = 0;  // from 0
  std::size_t world = 0, fault = 0;
  std::uint64_t seed = 0;
  std::vector<std::size_t> values;  // for each axis: index into its values
};

inline constexpr std::size_t kMostSweepRuns = 1'000'000;

std::size_t run_count(const SweepDescription& sweep);
// The run with a number. Worlds vary slowest, then faults, the groups in order, seeds fastest.
SweepRun run_of(const SweepDescription& sweep, std::size_t id);
std::string world_of(const SweepDescription& sweep, const SweepRun& run);
// Name and value text of every axis, in order.
std::vector<std::pair<std::string, std::string>> settings_of(const SweepDescription& sweep,
                                                             const SweepRun& run);
// Identifies a run across sweeps of the same behavior: equal settings give equal keys. A JSON
// object in one line.
std::string key_of(const SweepDescription& sweep, const SweepRun& run);

// FNV-1a, 64 bits, as 16 hexadecimal digits; not cryptographic.
std::string digest(const std::string& text);
// Digest of everything that determines the set of runs, their content and duration.
std::string plan_digest(const SweepDescription& sweep);

}  // namespace footfall::lab
