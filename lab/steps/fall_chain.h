// How a fall came about: which figures of its last steps were out of bounds, and which first.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/log/reader.h"
#include "lab/steps/step_table.h"

namespace footfall::lab {

inline constexpr std::size_t kChainSteps = 8;  // before a fall that are looked at

// A figure of a step that is out of bounds beyond a limit. In the order of causes, which settles
// between figures that are first out of bounds in one step.
struct ChainLink {
  std::string_view id;      // as in JSON
  std::string_view text;    // "step of {} s"
  std::string_view reason;  // for the limit
  double limit = 0.0;
  bool below = false;                         // out of bounds below the limit, not above it
  double (*value)(const StepRow&) = nullptr;  // NaN: not known, never out of bounds

  bool out_of_bounds(const StepRow& row) const {
    return below ? value(row) < limit : value(row) > limit;
  }
};
std::span<const ChainLink> chain_links();

// The first step among the last ones in which a figure was out of bounds.
struct Crossing {
  const ChainLink* link = nullptr;
  std::size_t before_end = 0;  // steps before the last touchdown; 0: it was that one
  double value = 0.0;
};
// In order of time, then of causes.
std::vector<Crossing> fall_chain(std::span<const StepRow> rows);

// How the run ended, as the log tells it: fall, steps, time, ...; "" if it does not.
std::string end_of(const Log& log);
std::string chain_text(std::span<const StepRow> rows);
// With the number of steps in which each figure was out of bounds while it did not lead to a fall:
// all of a run that did not fall, else those before the last ones.
nlohmann::ordered_json chain_json(std::span<const StepRow> rows, bool fell);

}  // namespace footfall::lab
