// Which reactions a robot file may give to a fault, and which faults a robot can have at all. The
// loader and the reference both read this table; docs/faults.md has more of each.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "core/fault.h"
#include "model/robot/description.h"

namespace footfall::model {

struct FaultRule {
  core::Fault fault;
  std::string_view when;      // one line
  core::Reaction otherwise;   // unless the robot file names one
  std::string_view refusing;  // why `continue` is refused; empty: any reaction is legal
};

// One rule for each core::Fault, in its order.
std::span<const FaultRule> fault_rules();

// Why the robot can never have the fault, as the file describes it; empty: it can.
std::string why_never(const RobotDescription& robot, core::Fault fault);

// The robot file's `faults`, when the rest of the robot is known. Problems go to diagnostics.
void read_reactions(const core::YamlNode& node, RobotDescription& robot,
                    core::Diagnostics& diagnostics);

}  // namespace footfall::model
