// JSON and text of a run's figures; see summary.h.
#include "lab/run/summary.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "behaviors/language/estimators.h"
#include "lab/figures/step_counter.h"

namespace footfall::lab {
namespace {

using Json = nlohmann::ordered_json;

Json error_json(const ErrorFigure& e) {
  if (e.count == 0) return nullptr;
  return {{"rms", e.rms()}, {"max", e.max}};
}

Json faults_json(const core::FaultCounters& faults) {
  Json out = Json::object();
  for (int i = 0; i < core::kFaultCount; ++i) {
    const auto fault = static_cast<core::Fault>(i);
    if (faults.of(fault) > 0) out[std::string(core::fault_name(fault))] = faults.of(fault);
  }
  return out;
}

// Ticks in which each was there: a fault that stays has appeared once.
Json fault_ticks_json(const core::FaultCounters& faults) {
  Json out = Json::object();
  for (int i = 0; i < core::kFaultCount; ++i) {
    const auto fault = static_cast<core::Fault>(i);
    if (faults.of(fault) > 0) out[std::string(core::fault_name(fault))] = faults.ticks_of(fault);
  }
  return out;
}

Json internal_json(const RunFigures& figures) {
  Json out = Json::object();
  for (const auto& [name, force] : figures.internal) {
    const double reference = std::abs(force.reference);
    out[name] = {{"rms", force.error.rms()},
                 {"max", force.error.max},
                 {"relative_rms", reference > 0.0 ? Json(force.error.rms() / reference) : Json()}};
  }
  return out;
}

Json worst_json(const RunResult& result) {
  Json out = Json::object();
  for (const WorstFault& worst : result.worst) {
    const std::string unit(worst.unit);
    out[std::string(core::fault_name(worst.fault))] = {
        {"joint", worst.joint}, {unit.empty() ? "value" : unit, worst.value}};
  }
  return out;
}

Json cause_json(const RunResult& result) {
  if (!result.cause) return nullptr;
  const EndCause& cause = *result.cause;
  return {{"criterion", cause.criterion},
          {"subject", cause.subject.empty() ? Json() : Json(cause.subject)},
          {"value", cause.value ? Json(*cause.value) : Json()},
          {"limit", cause.limit ? Json(*cause.limit) : Json()},
          {"unit", cause.unit.empty() ? Json() : Json(cause.unit)},
          {"time_s", cause.time},
          {"states", cause.states},
          {"text", cause.text}};
}

double moved(const RunFigures& f) {
  return std::hypot(f.end[0] - f.start[0], f.end[1] - f.start[1]);
}

std::string motion_text(const RunFigures& f) {
  return fmt::format(
      "  moved        {:.3f} m: CoM from ({:.3f}, {:.3f}) to ({:.3f}, {:.3f}) m, path {:.3f} m\n",
      moved(f), f.start[0], f.start[1], f.end[0], f.end[1], f.path_length);
}

std::string torque_text(const RunFigures& f) {
  std::string text = "  torque       ";
  if (f.roll.count > 0) {
    text += fmt::format("peak {:.1f} Nm, largest step between ticks {:.2f} Nm", f.peak_torque,
                        f.max_torque_step);
  } else {
    text += "no tick was made";
  }
  if (f.end_torque_step > 0.0) {
    text += fmt::format("; {:.2f} Nm as the run ended", f.end_torque_step);
  }
  return text + "\n";
}

// The behavior counts its own marks, the run what the feet do.
std::string no_steps_text(std::int64_t marked) {
  return fmt::format(
      "  NO STEPS     the behavior marked {}, but no foot left the ground for {:.0f} ms, rose "
      "{:.0f} cm "
      "and then carried the robot without those that stood\n",
      marked, StepCounter::kMinFlight * 1e3, StepCounter::kMinRise * 1e2);
}

std::string faults_text(const RunResult& result) {
  std::string text;
  for (int i = 0; i < core::kFaultCount; ++i) {
    const auto fault = static_cast<core::Fault>(i);
    if (result.faults.of(fault) == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", core::fault_name(fault),
                        result.faults.of(fault));
    if (result.faults.ticks_of(fault) > result.faults.of(fault)) {
      text += fmt::format(" in {} ticks", result.faults.ticks_of(fault));
    }
    if (fault == core::Fault::execution) text += fmt::format(" (first {})", result.execution_error);
    for (const WorstFault& worst : result.worst) {
      if (worst.fault != fault) continue;
      text += fmt::format(" (worst {} {:.3g}{}{})", worst.joint, worst.value,
                          std::string_view(worst.unit).empty() ? "" : " ", worst.unit);
    }
  }
  return fmt::format("  faults       {}\n", text.empty() ? "none" : text);
}

std::string torque_loops_text(const RunIdentity& id) {
  std::string text;
  for (const UnusedTorqueLoop& loop : id.unused_torque_loops) {
    text += fmt::format("{}'{}' of {} joint{}", text.empty() ? "" : ", ", loop.name, loop.joints,
                        loop.joints == 1 ? "" : "s");
  }
  return fmt::format("  torque loop  {} not used: the actuators are ideal in this world\n", text);
}

std::string estimator_text(const RunIdentity& id) {
  std::string text = fmt::format("  estimator    {}", id.estimator);
  if (id.sensor_errors != "unused") return text + "\n";
  std::string others;  // that read them
  for (const behaviors::EstimatorInfo& type : behaviors::estimator_types()) {
    if (type.needs_imu) others += fmt::format("{}{}", others.empty() ? "" : " or ", type.name);
  }
  return text + fmt::format(
                    ": the errors of the sensors of '{}' do not reach the state; they do with "
                    "--set estimator.type={}\n",
                    id.world, others);
}

Json torque_loops_json(const RunIdentity& id) {
  Json out = Json::array();
  for (const UnusedTorqueLoop& loop : id.unused_torque_loops) {
    out.push_back({{"name", loop.name}, {"joints", loop.joints}});
  }
  return out;
}

// Lists of more than this many values are told by their largest.
constexpr std::size_t kMostListed = 3;

std::string variation_text(const RunIdentity& id, const RunResult& result) {
  std::string text;
  for (const auto& [name, values] : id.variation) {
    text += text.empty() ? "" : ", ";
    if (values.size() <= kMostListed) {
      text += fmt::format("{} {:.3g}", name, fmt::join(values, " "));
    } else {
      double least = values.front(), most = values.front();
      for (const double value : values) {
        least = std::min(least, value);
        most = std::max(most, value);
      }
      text += fmt::format("{} {:.3g} to {:.3g}", name, least, most);
    }
  }
  for (const std::string& event : result.not_reached)
    text += fmt::format("; {}: not reached", event);
  return fmt::format("  drawn        {}\n", text);
}

Json tick_json(const core::TimingHistogram& h) {
  return {{"p50", h.percentile(0.5) * 1e-3},
          {"p99", h.percentile(0.99) * 1e-3},
          {"p999", h.percentile(0.999) * 1e-3}};
}

}  // namespace

Json variation_json(const RunIdentity& id) {
  Json out = Json::object();
  for (const auto& [name, values] : id.variation) {
    out[name] = values.size() == 1 ? Json(values.front()) : Json(values);
  }
  return out;
}

std::vector<std::string> figure_names() {
  RunResult result;  // in which every figure has a value
  RunFigures& f = result.figures;
  f.steps = 2;
  f.placements = 1;
  for (ErrorFigure* error : {&f.roll, &f.pitch, &f.yaw, &f.height}) error->add(0.0);
  result.end = RunEnd::finished;
  result.allocations = 0;
  std::vector<std::string> names;
  const Json flat = summary_json({}, result).flatten();
  for (const auto& [path, value] : flat.items()) {
    if (!value.is_number() && !value.is_boolean()) continue;
    std::string name = path.substr(1);
    std::ranges::replace(name, '/', '.');
    names.push_back(std::move(name));
  }
  return names;
}

bool is_figure_of_a_part(std::string_view name) {
  constexpr std::array<std::string_view, 5> kWhole = {"faults.", "fault_ticks.", "internal_force.",
                                                      "worst_fault.", "variation."};
  return std::ranges::any_of(kWhole, [&](std::string_view w) { return name.starts_with(w); });
}

std::vector<UnusedTorqueLoop> unused_torque_loops(const behaviors::Behavior& behavior,
                                                  const hal::Hardware& hardware) {
  std::vector<UnusedTorqueLoop> unused;
  if (hardware.uses_torque_loop()) return unused;
  for (std::size_t table = 0; table < behavior.torque_loops.size(); ++table) {
    std::set<std::size_t> joints;
    for (const behaviors::ControlSpec& control : behavior.controls) {
      for (std::size_t j = 0; j < control.torque_loops.size(); ++j) {
        if (control.torque_loops[j] == static_cast<int>(table)) joints.insert(j);
      }
    }
    if (joints.empty()) continue;  // `check` warns of a table that no state uses
    unused.push_back({behavior.torque_loops[table].name, static_cast<int>(joints.size())});
  }
  return unused;
}

Json figures_json(const RunFigures& f) {
  Json out;
  out["steps"] = f.steps;
  out["time_s"] = f.time;
  out["error"] = {{"roll", error_json(f.roll)},
                  {"pitch", error_json(f.pitch)},
                  {"yaw", error_json(f.yaw)},
                  {"height", error_json(f.height)}};
  out["foot_placement_m"] =
      f.placements > 0
          ? Json{{"mean", f.placement_mean}, {"max", f.placement_max}, {"count", f.placements}}
          : Json();
  const bool settled = f.roll.count > 0;  // there was a tick
  out["max_torque_step_Nm"] = settled ? Json(f.max_torque_step) : Json();
  out["peak_torque_Nm"] = settled ? Json(f.peak_torque) : Json();
  out["goal_error_m"] = f.steps > 0 ? Json(f.goal_error) : Json();
  out["path_length_m"] = f.path_length;
  out["internal_force"] = internal_json(f);
  out["counted_from_s"] = f.counted_from;
  out["start_m"] = f.start;
  out["end_m"] = f.end;
  out["moved_m"] = moved(f);
  out["max_distance_m"] = f.max_distance;
  out["mean_speed_last_50_mps"] = {f.mean_velocity_last_50[0], f.mean_velocity_last_50[1]};
  out["clearance_min_m"] = f.steps > 0 ? Json(f.worst_clearance) : Json();
  out["mean_step_time_s"] = f.steps > 1 ? Json(f.mean_step_time) : Json();
  return out;
}

Json summary_json(const RunIdentity& id, const RunResult& result, bool physics_only) {
  const RunFigures& f = result.figures;
  Json out;
  out["format"] = kSummaryFormat;
  out["behavior"] = id.behavior;
  out["robot"] = id.robot;
  out["world"] = id.world;
  out["backend"] = id.backend;
  out["seed"] = id.seed;
  out["estimator"] = id.estimator;
  out["sensor_errors"] = id.sensor_errors;
  out["end"] = run_end_name(result.end);
  out["fell"] = f.fell;
  out.update(figures_json(f));
  out["faults"] = faults_json(result.faults);
  out["fault_ticks"] = fault_ticks_json(result.faults);
  out["cause"] = cause_json(result);
  out["worst_fault"] = worst_json(result);
  out["execution_error"] = result.execution_error.empty() ? Json() : Json(result.execution_error);
  const bool let_go = result.end == RunEnd::finished || result.cause.has_value();
  out["end_torque_step_Nm"] = f.roll.count > 0 && let_go ? Json(f.end_torque_step) : Json();
  out["marked_steps"] = result.marked_steps;
  out["unused_torque_loops"] = torque_loops_json(id);
  out["missed"] = result.missed;
  out["not_reached"] = result.not_reached;
  out["variation"] = variation_json(id);
  out["constraints"] = id.constraints;
  out["footholds"] = id.footholds ? Json(*id.footholds) : Json();
  out["log_lost_ticks"] = result.log_lost;
  if (!physics_only) {
    out["tick_us"] = tick_json(result.tick_time);
    out["allocations"] = result.allocations >= 0 ? Json(result.allocations) : Json();
    out["real_time_factor"] = result.real_time_factor;
    out["log"] = id.log.empty() ? Json() : Json(id.log);
  }
  return out;
}

Json timing_json(const RunResult& result) {
  Json out;
  out["tick_us"] = tick_json(result.tick_time);
  out["tick_us"]["max"] = static_cast<double>(result.tick_time.max_ns()) * 1e-3;
  out["ticks"] = result.tick_time.count();
  out["wall_time_s"] = result.wall_time;
  out["real_time_factor"] = result.real_time_factor;
  Json percentiles = Json::array();
  for (const double p : {0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 0.95, 0.99, 0.999, 0.9999, 1.0}) {
    percentiles.push_back({{"part", p}, {"us", result.tick_time.percentile(p) * 1e-3}});
  }
  out["percentiles"] = percentiles;
  return out;
}

std::string summary_text(const RunIdentity& id, const RunResult& result) {
  const RunFigures& f = result.figures;
  const auto deg = [](double rad) { return rad * 180.0 / M_PI; };
  std::string text = fmt::format("{} · {} · {} · {} · seed {}\n", id.behavior, id.robot, id.world,
                                 id.backend, id.seed);
  text += fmt::format("  end          {} after {:.2f} s, {} step{}\n", run_end_text(result.end),
                      f.time, f.steps, f.steps == 1 ? "" : "s");
  if (result.cause) text += fmt::format("  cause        {}\n", result.cause->text);
  if (f.steps == 0 && result.marked_steps > 0) text += no_steps_text(result.marked_steps);
  text += motion_text(f);
  if (f.height.count > 0) {
    text += fmt::format("  orientation  roll {:.2f}°  pitch {:.2f}°  yaw {:.2f}° (largest error)\n",
                        deg(f.roll.max), deg(f.pitch.max), deg(f.yaw.max));
    text += fmt::format("  CoM height   {:.2f} mm rms, {:.2f} mm largest error\n",
                        f.height.rms() * 1e3, f.height.max * 1e3);
  }
  if (f.steps > 1) {
    text += fmt::format(
        "  steps        {:.3f} s each, clearance {:.1f} cm at least, goal error {:.3f} m\n",
        f.mean_step_time, f.worst_clearance * 100.0, f.goal_error);
  }
  if (f.placements > 0) {
    text += fmt::format("  footsteps    {:.1f} mm mean, {:.1f} mm largest from the plan\n",
                        f.placement_mean * 1e3, f.placement_max * 1e3);
  }
  text += torque_text(f);
  for (const auto& [name, force] : f.internal) {
    text +=
        fmt::format("  {}  {:.1f} N rms from {:.1f} N\n", name, force.error.rms(), force.reference);
  }
  text += faults_text(result);
  for (const std::string& event : result.missed) {
    text += fmt::format("  NEVER CAME   {}\n", event);
  }
  if (result.log_lost > 0) {
    text += fmt::format("  LOG LOST     {} ticks: the machine was too slow to write them\n",
                        result.log_lost);
  }
  text += fmt::format("  tick         {:.1f} us median, {:.1f} us p99.9; {:.0f} x real time\n",
                      result.tick_time.percentile(0.5) * 1e-3,
                      result.tick_time.percentile(0.999) * 1e-3, result.real_time_factor);
  if (!id.unused_torque_loops.empty()) text += torque_loops_text(id);
  if (!id.variation.empty()) text += variation_text(id, result);
  if (!id.constraints.empty()) {
    text += fmt::format("  AIDED        by {}\n", fmt::join(id.constraints, ", "));
  }
  if (id.footholds) {
    text += fmt::format("  footholds    {} with a height drawn anew\n", *id.footholds);
  }
  text += estimator_text(id);
  if (!id.physics.empty()) text += fmt::format("  physics      {}\n", id.physics);
  return text;
}

}  // namespace footfall::lab
