// The end of a run in words; see end.h.
#include "lab/run/end.h"

#include <fmt/format.h>

#include <cmath>

#include "core/units/units.h"
#include "engine/tick/fall.h"

namespace footfall::lab {
namespace {

using core::Fault;
using engine::ControlLoop;

std::string state_paths(const ControlLoop& loop, std::span<const int> states) {
  std::string paths;
  for (const int s : states) {
    paths += (paths.empty() ? "" : ", ") + loop.behavior().states[static_cast<std::size_t>(s)].path;
  }
  return paths;
}

const char* unit_of(Fault fault) {
  switch (fault) {
    case Fault::swing_too_long:
    case Fault::swing_contact:
    case Fault::load_air:
      return "s";
    case Fault::slip:
      return "m";
    case Fault::joint_limit:
      return "rad";
    case Fault::condition:
      return "";
    default:
      return "Nm";
  }
}

// The joint, contact or task where a fault is; `place` has one.
const std::string& place_name(const ControlLoop& loop, Fault fault,
                              const engine::FaultPlace& place) {
  const model::RobotDescription& robot = loop.behavior().robot;
  const auto index = static_cast<std::size_t>(place.joint);
  if (fault == Fault::condition) return loop.behavior().task_instances[index].name;
  const bool of_contact = fault == Fault::swing_too_long || fault == Fault::swing_contact ||
                          fault == Fault::load_air || fault == Fault::slip;
  return of_contact ? robot.contacts[index].name : robot.joints[index].name;
}

// A fall by its first criterion that holds, with the words for it.
std::string judge_fall(const ControlLoop& loop, EndCause& cause) {
  const engine::FallCriteria fall =
      engine::judge_fall(loop.behavior().robot, loop.sensors(), loop.model());
  const auto measured = [&](const char* criterion, double value, double limit, const char* unit) {
    cause.criterion = criterion;
    cause.value = value;
    cause.limit = limit;
    cause.unit = unit;
  };
  if (fall.low) {
    measured("height", fall.height, fall.height_limit, "m");
    return fmt::format(
        "torso {:.3f} m above the lowest foot, below the limit {:.3f} m ({:.0f} % of its standing "
        "height)",
        fall.height, fall.height_limit, loop.behavior().robot.height_limit * 100.0);
  }
  if (fall.tilted) {
    measured("tilt", fall.tilt(), fall.tilt_limit, "rad");
    return fmt::format("tilt {:.2f} rad, beyond {:.2f} rad", fall.tilt(), fall.tilt_limit);
  }
  cause.criterion = "body_contact";
  return "a body that is no foot touched something";
}

std::string judge_swing(const ControlLoop& loop, EndCause& cause) {
  cause.criterion = "swing";
  cause.limit = loop.behavior().robot.swing_limit;
  cause.unit = "s";
  cause.subject = place_name(loop, Fault::swing_too_long, loop.last_place(Fault::swing_too_long));
  return fmt::format("{} in the air for more than {:g} s", cause.subject, *cause.limit);
}

std::string judge_fault(const ControlLoop& loop, Fault fault, EndCause& cause) {
  cause.criterion = std::string(core::fault_name(fault));
  const engine::FaultPlace& place = loop.last_place(fault);
  if (fault == Fault::execution) return "fault execution: " + execution_text(loop);
  if (place.joint < 0) return "fault " + cause.criterion;
  cause.subject = place_name(loop, fault, place);
  cause.value = place.value;
  cause.unit = unit_of(fault);
  return fmt::format("fault {}: {}", cause.criterion, place_text(loop, fault, place));
}

}  // namespace

const char* run_end_name(RunEnd end) {
  switch (end) {
    case RunEnd::steps:
      return "steps";
    case RunEnd::time:
      return "time";
    case RunEnd::fall:
      return "fall";
    case RunEnd::fault:
      return "fault";
    case RunEnd::stopped:
      return "stopped";
    case RunEnd::finished:
      return "finished";
  }
  return "time";
}

const char* run_end_text(RunEnd end) {
  switch (end) {
    case RunEnd::steps:
      return "all steps made";
    case RunEnd::time:
      return "time is up";
    case RunEnd::fall:
      return "the robot FELL";
    case RunEnd::fault:
      return "stopped by a fault";
    case RunEnd::stopped:
      return "stopped by hand";
    case RunEnd::finished:
      return "finished (the behavior reached its final state)";
  }
  return "";
}

EndCause explain_end(const ControlLoop& loop, std::span<const int> states) {
  EndCause cause;
  cause.time = loop.time();
  cause.states = state_paths(loop, states);
  const Fault fault = loop.ended_by();
  const std::string what = fault == Fault::fall             ? judge_fall(loop, cause)
                           : fault == Fault::swing_too_long ? judge_swing(loop, cause)
                                                            : judge_fault(loop, fault, cause);
  cause.text = fmt::format("{}, at {:.3f} s in {}", what, cause.time,
                           cause.states.empty() ? "no state" : cause.states);
  return cause;
}

std::string place_text(const ControlLoop& loop, Fault fault, const engine::FaultPlace& place) {
  if (place.joint < 0) return {};
  const bool coarse =
      fault == Fault::torque_limit || fault == Fault::torque_step || fault == Fault::condition;
  const std::string_view unit = unit_of(fault);
  return fmt::format("{} {:.{}f}{}{}", place_name(loop, fault, place), place.value, coarse ? 1 : 3,
                     unit.empty() ? "" : " ", unit);
}

std::vector<WorstFault> worst_faults(const ControlLoop& loop) {
  std::vector<WorstFault> worst;
  for (int i = 0; i < core::kFaultCount; ++i) {
    const auto fault = static_cast<Fault>(i);
    const engine::FaultPlace& place = loop.worst_place(fault);
    if (place.joint < 0) continue;
    worst.push_back({fault, place_name(loop, fault, place), place.value, unit_of(fault)});
  }
  return worst;
}

namespace {

std::string problem_text(const behaviors::Chart& chart,
                         const behaviors::ExecutionProblem& problem) {
  using Kind = behaviors::ExecutionProblem::Kind;
  switch (problem.kind) {
    case Kind::value:
    case Kind::order: {
      const bool known = problem.index >= 0 && problem.index < chart.expressions.size();
      const std::string unit =
          known ? core::unit_text(chart.expressions[problem.index].dimension) : "";
      const std::string value =
          fmt::format("{:.6g}{}{}", problem.value, unit.empty() ? "" : " ", unit);
      if (!std::isfinite(problem.value)) return "it has no value";
      if (problem.kind == Kind::order)
        return "a waypoint at " + value + ", not after the one before";
      return fmt::format("it is {}, outside {:g} to {:g}", value, problem.min, problem.max);
    }
    case Kind::micro_steps:
      return fmt::format("more than {} transitions one after another in a tick", chart.micro_steps);
    case Kind::call:
      return fmt::format("'{}' failed", chart.calls[static_cast<std::size_t>(problem.index)].name);
    case Kind::requests:
      return "too many calls of scripts in one tick";
    case Kind::none:
      break;
  }
  return "";
}

}  // namespace

std::string execution_text(const ControlLoop& loop) {
  const behaviors::ExecutionProblem& problem = loop.machine().execution_problem();
  const behaviors::Chart& chart = loop.behavior();
  const auto index = static_cast<std::size_t>(problem.index);
  const bool placed = (problem.kind == behaviors::ExecutionProblem::Kind::value ||
                       problem.kind == behaviors::ExecutionProblem::Kind::order) &&
                      problem.index >= 0 && index < chart.expression_places.size();
  std::string text = placed ? chart.expression_places[index] : "";
  if (!text.empty()) text += ": ";
  return text + problem_text(chart, problem);
}

}  // namespace footfall::lab
