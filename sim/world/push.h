// Pushes and pairs of numbers from the command line: `--push "40,0.1,90,step 8 phase 0.5"`. The
// MuJoCo backend applies a push as an external force on a body, between two ticks.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "core/units/units.h"

namespace footfall::sim {

// At `seconds` of the run's clock.
struct AtTime {
  double seconds = 0.0;
};

// In the `step`-th step (from 1), at `phase` of its duration.
struct AtStep {
  int step = 1;
  double phase = 0.0;  // [0, 1)
};

// A constant horizontal force on a body for a limited time.
struct PushSpec {
  double force = 0.0;      // N
  double duration = 0.0;   // s
  double direction = 0.0;  // rad in the heading frame, 0 forward, pi/2 left
  std::variant<AtTime, AtStep> at;
  std::string body = "torso";  // at its centre of mass
};

// Parses `FORCE_N,DURATION_S,DIRECTION_DEG,AT`; AT is a time in seconds, or `step N`, or `step N
// phase P` with P from 0 to 1 or in %. Units may be written (`40 N,100 ms,90 deg,3 s`). nullopt if
// malformed, with the expected format in `error`.
std::optional<PushSpec> parse_push(std::string_view text, std::string& error,
                                   std::string_view body = "torso");

// Parses `x,y` of one dimension, bare numbers in SI: for `--goal` and `--goal-velocity`.
std::optional<std::array<double, 2>> parse_vector2(std::string_view text, core::Dimension dimension,
                                                   std::string& error);

}  // namespace footfall::sim
