// What of the behaviors a suite's runs reached: states entered, transitions taken, guards that came
// out true and false. Merged over runs, by the behavior's file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "behaviors/compiled/chart.h"

namespace footfall::lab {

// What there is to reach, in document order.
struct CoverageMap {
  struct Item {
    std::string text;       // path of a state; `source -> targets` of a transition
    std::string place;      // file:line
    bool reachable = true;  // false: a history state, which stands for others
    bool guarded = false;   // a transition with a condition
  };
  std::string behavior;  // path of its file
  std::vector<Item> states, transitions;
};
// files: by core::Mark::file.
CoverageMap coverage_map(const behaviors::Chart& chart, const std::string& path,
                         const std::vector<std::string>& files);

struct CoverageFigure {
  std::size_t reached = 0, of = 0;
  double percent() const {
    return of == 0 ? 100.0 : 100.0 * static_cast<double>(reached) / static_cast<double>(of);
  }
};

class Coverage {
 public:
  // `run`: the coverage of one run, {"states": [PATH, ...], "transitions": [{"index", "taken"},
  // ...], "guards": [{"index", "true", "false"}, ...]} with counts or truth values; index: into
  // Chart::transitions. What is malformed in it is passed over.
  void add(const std::shared_ptr<const CoverageMap>& map, const nlohmann::json& run);

  bool empty() const { return behaviors_.empty(); }
  CoverageFigure states() const;
  CoverageFigure transitions() const;
  CoverageFigure guard_outcomes() const;  // two of each guard
  // Percentages, and what no run reached: `file:line: ...` a line.
  std::string text() const;
  nlohmann::ordered_json to_json() const;

 private:
  struct Reached {
    std::shared_ptr<const CoverageMap> map;
    std::vector<std::uint8_t> states, transitions, when_true, when_false;
  };
  struct Gap {
    const char* kind;  // "state", "transition", "guard"
    std::string place, text;
  };
  static std::vector<Gap> gaps(const Reached& reached);
  static CoverageFigure states_of(const Reached& reached);
  static CoverageFigure transitions_of(const Reached& reached);
  static CoverageFigure guards_of(const Reached& reached);

  std::map<std::string, Reached> behaviors_;  // by file
};

}  // namespace footfall::lab
