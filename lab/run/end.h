// What ended a run, and why, for people and scripts.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/tick/control_loop.h"

namespace footfall::lab {

enum class RunEnd { steps, time, fall, fault, stopped, finished };
const char* run_end_name(RunEnd end);
// The same in a sentence's words.
const char* run_end_text(RunEnd end);

// Why a run ended with a fall or by a fault.
struct EndCause {
  std::string criterion;        // height, tilt, body_contact, swing, or the dotted name of a fault
  std::optional<double> value;  // measured, SI; what has none is yes or no
  std::optional<double> limit;
  std::string unit;     // of both, "" without
  double time = 0.0;    // s
  std::string states;   // active when it came, by path, commas between
  std::string subject;  // foot or joint, "" if it is of neither
  std::string text;     // all of this in one line
};

// After the last tick of a run that fell or was stopped. `states`: atomic ones at its start.
EndCause explain_end(const engine::ControlLoop& loop, std::span<const int> states);

// The largest of a joint's or contact's faults in a run.
struct WorstFault {
  core::Fault fault = core::Fault::count;
  std::string joint;   // or contact
  double value = 0.0;  // N m, rad or s, as engine::FaultPlace says
  std::string unit;
};
std::vector<WorstFault> worst_faults(const engine::ControlLoop& loop);
// `left_knee 7.2 Nm`; empty if the fault has no place.
std::string place_text(const engine::ControlLoop& loop, core::Fault fault,
                       const engine::FaultPlace& place);

// `b.yaml:5:12: it is 4, outside 0 to 3`: the loop's last problem with an expression or call.
std::string execution_text(const engine::ControlLoop& loop);

}  // namespace footfall::lab
