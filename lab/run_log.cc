// From the control loop to the log file; see run_log.h.
#include "lab/run_log.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/index.h"
#include "lab/run_end.h"
#include "lab/version.h"

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

}  // namespace

RunLog::RunLog(engine::ControlLoop& loop, engine::LogWriter* log, int every, Said said)
    : loop_(loop),
      log_(log),
      every_(std::max(1, every)),
      said_(std::move(said)),
      last_targets_(loop.behavior().planners.size()) {}

std::int64_t RunLog::time_ns() const {
  return loop_.ticks() * 1'000'000'000'000LL / loop_.behavior().robot.rate_mhz;
}

std::string RunLog::state_name() const {
  const auto active = loop_.machine().active_atomic();
  return active.empty() ? "-" : loop_.behavior().states[at(active.front())].path;
}

void RunLog::event(std::string_view kind, std::string_view name, std::string_view detail) {
  if (log_) log_->event(time_ns(), kind, name, detail);
}

void RunLog::after_tick(const StepEvent& step) {
  if (!log_) {
    if (said_) write_texts();
    return;
  }
  const behaviors::Behavior& behavior = loop_.behavior();
  for (const int t : loop_.machine().transitions_taken()) {
    const behaviors::TransitionInfo& info = behavior.transitions[at(t)];
    event("transition", behavior.states[at(info.source)].path, names_of(behavior, info.targets));
  }
  write_texts();
  for (const int mark : loop_.machine().marks()) event("mark", behavior.marks[at(mark)], "");
  if (step.foot >= 0) {
    event("step", behavior.robot.contacts[at(step.foot)].name,
          fmt::format("clearance {:.4f} m, flight {:.3f} s", step.clearance, step.flight_time));
  }
  for (std::size_t i = 0; i < last_targets_.size(); ++i) {
    const double* target = loop_.signals().values() + behavior.layout.planner[i].target;
    const std::array<double, 3> now = {target[0], target[1], target[2]};
    // Replanning moves a target a little each time; a row for each millimetre tells the story.
    if (std::hypot(now[0] - last_targets_[i][0], now[1] - last_targets_[i][1]) < 1e-3) continue;
    last_targets_[i] = now;
    event("plan", behavior.planners[i].name,
          fmt::format("{:.4f} {:.4f} {:.4f}", now[0], now[1], now[2]));
  }
  for (int f = 0; f < core::kFaultCount; ++f) {
    const auto fault = static_cast<core::Fault>(f);
    if (loop_.faults().of(fault) == seen_faults_.of(fault)) continue;
    const std::string place = place_text(loop_, fault, loop_.last_place(fault));
    event("fault", core::fault_name(fault),
          fmt::format("{}{}{}", loop_.faults().of(fault), place.empty() ? "" : ", ", place));
  }
  seen_faults_ = loop_.faults();
  if (loop_.ticks() % every_ == 0) log_->sample(time_ns(), loop_.signals().values());
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

engine::LogHeader make_log_header(const behaviors::Behavior& behavior, const std::string& world,
                                  const std::string& backend, std::uint64_t seed) {
  nlohmann::json states = nlohmann::json::array();
  for (const behaviors::StateInfo& state : behavior.states) states.push_back(state.path);
  nlohmann::json contacts = nlohmann::json::array();
  for (const auto& contact : behavior.robot.contacts) contacts.push_back(contact.name);
  nlohmann::json joints = nlohmann::json::array();
  for (const auto& joint : behavior.robot.joints) joints.push_back(joint.name);
  engine::LogHeader header;
  header.run = {{"behavior", behavior.name},
                {"robot", behavior.robot.name},
                {"robot_file", behavior.robot.path},
                {"world", world},
                {"backend", backend},
                {"seed", std::to_string(seed)},
                {"version", kVersion},
                {"model", behavior.robot.model_path},
                {"rate_hz", fmt::format("{}", behavior.robot.rate_hz())},
                {"states", states.dump()},
                {"contacts", contacts.dump()},
                {"joints", joints.dump()}};
  return header;
}

}  // namespace footfall::lab
