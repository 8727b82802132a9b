// From the control loop to the log file; see run_log.h.
#include "lab/run/run_log.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "behaviors/language/estimators.h"
#include "core/index.h"
#include "core/text/json_text.h"
#include "core/text/printable.h"
#include "lab/run/actuator_facts.h"
#include "lab/run/end.h"
#include "lab/run/log_setup.h"
#include "lab/run/version.h"
#include "model/sensor_mounts.h"

namespace footfall::lab {
namespace {

std::string names_of(const behaviors::Chart& chart, const behaviors::Range& targets) {
  std::string names;
  for (int i = targets.first; i < targets.end(); ++i) {
    if (!names.empty()) names += ", ";
    names += chart.states[at(chart.targets[at(i)])].path;
  }
  return names;
}

constexpr double kPlanRow = 5e-3;  // m

// `goal.y`: the parameter and which of its values.
std::string slot_name(const std::vector<behaviors::ParameterInfo>& parameters, int slot) {
  for (const behaviors::ParameterInfo& p : parameters) {
    if (slot < p.slot || slot >= p.slot + p.size) continue;
    return behaviors::value_name(p, slot - p.slot);
  }
  return fmt::format("slot {}", slot);
}

}  // namespace

RunLog::RunLog(engine::ControlLoop& loop, engine::LogWriter* log, Said said)
    : loop_(loop),
      log_(log),
      said_(std::move(said)),
      last_targets_(loop.behavior().planners.size()) {
  trace_.size_for(loop.behavior());
  states_before_.reserve(loop.behavior().states.size());
}

void RunLog::begin() {
  seen_faults_ = loop_.faults();
  if (log_ != nullptr) loop_.record(trace_);
}

void RunLog::before_tick() noexcept {
  const auto active = loop_.machine().active_atomic();
  states_before_.assign(active.begin(), active.end());
}

std::string RunLog::state_name() const {
  const auto active = loop_.machine().active_atomic();
  return active.empty() ? "-" : loop_.behavior().states[at(active.front())].path;
}

void RunLog::event(std::string_view kind, std::string_view name, std::string_view detail) {
  if (log_ == nullptr) return;
  // Scripts and command lines may say any bytes; the log's texts are UTF-8.
  const std::string clean_name = core::is_plain_text(name) ? "" : core::printable_lines(name);
  const std::string clean_detail = core::is_plain_text(detail) ? "" : core::printable_lines(detail);
  log_->event(loop_.ticks(), kind, clean_name.empty() ? name : clean_name,
              clean_detail.empty() ? detail : clean_detail);
}

void RunLog::after_start() {
  if (!log_) return;
  log_->tick(-1, loop_.sensors(), loop_.fresh(), {}, loop_.signals().values(), false);
}

void RunLog::after_tick(const StepEvent& step) {
  if (first_execution_error_.empty() && loop_.faults().of(core::Fault::execution) > 0) {
    first_execution_error_ = fmt::format("{}, at {:.3f} s", execution_text(loop_), loop_.time());
  }
  if (!log_) {
    if (said_) write_texts();
    return;
  }
  const behaviors::Behavior& behavior = loop_.behavior();
  if (!trace_.empty()) log_->inputs(loop_.ticks(), trace_);
  for (const int t : loop_.machine().transitions_taken()) {
    const behaviors::TransitionInfo& info = behavior.transitions[at(t)];
    event("transition", behavior.states[at(info.source)].path, names_of(behavior, info.targets));
  }
  write_edits();
  write_texts();
  for (const int mark : loop_.machine().marks()) event("mark", behavior.marks[at(mark)], "");
  if (step.foot >= 0) {
    event("step", behavior.robot.contacts[at(step.foot)].name,
          fmt::format("clearance {:.4f} m, flight {:.3f} s", step.clearance, step.flight_time));
  }
  write_plans();
  const bool fault = write_faults();
  log_->tick(loop_.ticks(), loop_.sensors(), loop_.fresh(), loop_.commands(),
             loop_.signals().values(), fault || !loop_.machine().transitions_taken().empty());
}

// What came to the door in this tick, and who brought it, for people: `live ann@bench (undo)`; what
// it did to which tick is in /edits.
void RunLog::write_edits() {
  const behaviors::Behavior& behavior = loop_.behavior();
  for (std::size_t i = 0; i < loop_.edits().taken(); ++i) {
    const engine::EditOrder& order = loop_.edits().taken(i);
    std::string text;
    for (const behaviors::SlotValue& edit : order.new_values()) {
      text += fmt::format("{}{} = {:g}", text.empty() ? "" : ", ",
                          slot_name(behavior.parameters, edit.slot), edit.value);
    }
    if (order.ramp_ticks > 0) text += fmt::format(" over {} ticks", order.ramp_ticks);
    for (const int e : order.new_events()) {
      text += fmt::format("{}raise {}", text.empty() ? "" : ", ", behavior.events[at(e)]);
    }
    const bool refused = order.outcome == engine::EditOutcome::refused;
    if (refused) text = order.note.view();
    if (order.outcome == engine::EditOutcome::stale_revision) text += " (refused: stale revision)";
    std::string name = refused ? "refused" : engine::edit_source_name(order.source);
    if (!order.who.view().empty()) name += fmt::format(" {}", order.who.view());
    if (!refused && !order.note.view().empty()) name += fmt::format(" ({})", order.note.view());
    event("edit", name, text);
  }
}

// Replanning moves a target a little each time: a row each 5 mm tells the story, and every answer
// is in /plans.
void RunLog::write_plans() {
  const behaviors::Behavior& behavior = loop_.behavior();
  for (std::size_t i = 0; i < last_targets_.size(); ++i) {
    const double* target = loop_.signals().values() + behavior.layout.planner[i].target;
    const std::array<double, 3> now = {target[0], target[1], target[2]};
    const double dx = now[0] - last_targets_[i][0], dy = now[1] - last_targets_[i][1];
    if (dx * dx + dy * dy < kPlanRow * kPlanRow) continue;
    last_targets_[i] = now;
    event("plan", behavior.planners[i].name,
          fmt::format("{:.4f} {:.4f} {:.4f}", now[0], now[1], now[2]));
  }
}

// Whether one appeared.
bool RunLog::write_faults() {
  if (loop_.faults().count == seen_faults_.count) return false;
  for (int f = 0; f < core::kFaultCount; ++f) {
    const auto fault = static_cast<core::Fault>(f);
    if (loop_.faults().of(fault) == seen_faults_.of(fault)) continue;
    const std::string place = fault == core::Fault::execution
                                  ? execution_text(loop_)
                                  : place_text(loop_, fault, loop_.last_place(fault));
    event("fault", core::fault_name(fault),
          fmt::format("{}{}{}", loop_.faults().of(fault), place.empty() ? "" : ", ", place));
  }
  seen_faults_ = loop_.faults();
  return true;
}

// What `log:` actions and scripts said.
void RunLog::write_texts() {
  const behaviors::Behavior& behavior = loop_.behavior();
  for (const behaviors::LogRecord& record : loop_.machine().logs()) {
    const behaviors::LogText& log = behavior.logs[at(record.text)];
    std::string text = log.pieces.front();
    for (std::size_t k = 0; k < log.expressions.size(); ++k) {
      text += fmt::format("{:g}", record.values[k]) + log.pieces[k + 1];
    }
    say(text, "");
  }
  if (loop_.scripts() == nullptr) return;
  for (const std::string& text : loop_.scripts()->take_messages()) say(text, "script");
}

void RunLog::say(const std::string& text, std::string_view from) {
  event("log", text, from);
  if (said_) said_(loop_.time(), text);
}

namespace {

// The type of each name of a task; readers need it to know what `task.NAME.reference.z` refers to.
std::map<std::string, std::string> task_types(const behaviors::Behavior& behavior) {
  std::map<std::string, std::string> types;
  for (const behaviors::TaskInstance& task : behavior.task_instances) {
    types[behavior.task_names[at(task.signals)].name] = tasks::info(task.type).name;
  }
  return types;
}

}  // namespace

engine::LogHeader make_log_header(const behaviors::Behavior& behavior, const LogSource& source) {
  std::vector<std::string> states;
  for (const behaviors::StateInfo& state : behavior.states) states.push_back(state.path);
  engine::LogHeader header;
  for (const auto& contact : behavior.robot.contacts) header.names.contacts.push_back(contact.name);
  for (const auto& joint : behavior.robot.joints) header.names.joints.push_back(joint.name);
  header.names.markers = source.markers;
  header.names.aids = source.aids;
  header.names.estimation =
      source.sensor_errors || behavior.estimator.type != behaviors::EstimatorType::true_state;
  if (header.names.estimation && source.markers.empty() &&
      !behavior.robot.sensors.mocap_sites.empty()) {
    for (const model::Marker& marker : model::sensor_mounts(behavior.robot).markers) {
      header.names.markers.push_back(marker.name);
    }
  }
  header.run = {{"behavior", behavior.name},
                {"robot", behavior.robot.name},
                {"robot_file", behavior.robot.path},
                {"world", source.world},
                {"backend", source.backend},
                {"estimator", std::string(behaviors::estimator_info(behavior.estimator.type).name)},
                {"seed", std::to_string(source.settings.seed)},
                {"version", kVersion},
                {"format", std::to_string(kLogFormat)},
                {"build", build_id()},
                {"command", source.command},
                {"model", behavior.robot.model_path},
                {"rate_hz", fmt::format("{}", behavior.robot.rate_hz())},
                {"states", core::json_text(states)},
                {"tasks", core::json_text(nlohmann::json(task_types(behavior)))},
                {"contacts", core::json_text(header.names.contacts)},
                {"joints", core::json_text(header.names.joints)}};
  if (source.friction > 0.0) {
    header.run.emplace_back("friction", fmt::format("{:g}", source.friction));
  }
  if (source.elastic) {
    header.run.emplace_back("actuators", core::json_text(actuator_facts(behavior)));
  }
  header.setup = setup_text(behavior, source);
  header.events = behavior.events;
  header.files = source_files(behavior, source.world_file);
  for (const behaviors::ParameterInfo& p : behavior.parameters) {
    header.parameters.push_back({p.name, p.slot, p.size});
  }
  header.values = behavior.values;
  header.rate_mhz = behavior.robot.rate_mhz;
  header.row_every = source.row_every;
  header.lockstep = source.settings.lockstep;
  return header;
}

}  // namespace footfall::lab
