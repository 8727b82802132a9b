// Runs the tick on logged inputs; see replay.h.
#include "lab/replay/replay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>
#include <utility>

#include "behaviors/compiled/take_over_map.h"
#include "behaviors/loader.h"
#include "engine/tick/control_loop.h"
#include "engine/tick/input_row.h"
#include "lab/log/attached_files.h"
#include "lab/run/log_setup.h"
#include "lab/run/run_log.h"

namespace footfall::lab {
namespace {

// Returns the logged sensor data; commands are discarded.
class LoggedHardware final : public hal::Hardware {
 public:
  explicit LoggedHardware(const LoggedInputs& inputs) { play(inputs, inputs.first_tick); }
  // Plays these inputs, beginning with tick `next`.
  void play(const LoggedInputs& inputs, std::int64_t next) {
    inputs_ = &inputs;
    layout_.emplace(inputs.names);
    if (layout_->names() != inputs.columns) {
      throw std::runtime_error("the log's inputs are not of this program's kind");
    }
    next_ = next;
  }
  std::string name() const override { return "replay"; }
  void start() override { next_ = -1; }
  bool read(hal::Sensors& sensors) noexcept override {
    const std::int64_t last = inputs_->first_tick + inputs_->ticks() - 1;
    const std::int64_t tick = std::clamp(next_++, inputs_->first_tick, last);
    hal::Commands ignored;
    return layout_->unpack(inputs_->row(tick), sensors, ignored);
  }
  void write(const hal::Commands&) noexcept override {}
  void safe_stop() noexcept override {}

 private:
  const LoggedInputs* inputs_ = nullptr;
  std::optional<engine::InputLayout> layout_;
  std::int64_t next_ = -1;  // -1: the data read by start()
};

std::unique_ptr<behaviors::Behavior> load(const RunSetup& setup, const std::string& file,
                                          const LogFolder& folder) {
  core::Diagnostics diagnostics;
  behaviors::LoadOptions options;
  options.search = folder.search();
  options.robot = folder.place_of(setup.robot_file);
  options.set = setup.set;
  options.world = actuators_of(setup);
  auto behavior = behaviors::load_behavior(
      file.empty() ? folder.place_of(setup.behavior_file) : file, options, diagnostics);
  if (behavior == nullptr) throw std::runtime_error(diagnostics.to_string());
  if (!behavior->has_robot) throw std::runtime_error(behavior->path + ": error: no robot to run");
  return behavior;
}

// Slot of each logged value in the behavior, which may be a different one; -1 if absent.
std::vector<int> slot_map(const Log& log, const behaviors::Behavior& behavior) {
  std::vector<int> map(log.parameter_values.size(), -1);
  for (const LoggedParameter& logged : log.parameters) {
    const int index = behavior.find_parameter(logged.name);
    if (index < 0) continue;
    const behaviors::ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(index)];
    for (int k = 0; k < std::min(logged.size, info.size); ++k) {
      map[static_cast<std::size_t>(logged.slot + k)] = info.slot + k;
    }
  }
  return map;
}

engine::LoopSettings replay_settings(const RunSetup& setup) {
  engine::LoopSettings settings = setup.settings;
  settings.run_scripts = settings.waits = false;
  return settings;
}

bool same(const behaviors::PlanAnswer& a, const behaviors::PlanAnswer& b) {
  return a.planner == b.planner && a.sequence == b.sequence && a.ok == b.ok &&
         std::memcmp(a.target.data(), b.target.data(), sizeof a.target) == 0 &&
         std::memcmp(a.predicted_pos.data(), b.predicted_pos.data(), sizeof a.predicted_pos) == 0 &&
         std::memcmp(a.predicted_vel.data(), b.predicted_vel.data(), sizeof a.predicted_vel) == 0 &&
         std::memcmp(&a.extension, &b.extension, sizeof a.extension) == 0;
}

// One behavior of the run with one log, or with a later log after a reload was reverted.
struct ReplayStage {
  ReplayStage(const Log& l, const std::string& behavior_file)
      : log(&l), folder(l), setup(read_setup(l.setup)), hardware(l.inputs) {
    if (log->inputs.ticks() == 0) {
      throw std::runtime_error("the log '" + log->path + "' has no inputs to replay");
    }
    behavior = load(setup, behavior_file, folder);
    name_inputs();
    loop = std::make_unique<engine::ControlLoop>(*behavior, hardware, replay_settings(setup));
    loop->play(trace);
  }

  void name_inputs() {
    slots = slot_map(*log, *behavior);
    events.clear();
    for (const std::string& name : log->event_names) events.push_back(behavior->find_event(name));
    plan = edit = 0;
  }

  // Resumes the behavior later in the run; the data of its first tick were already read.
  void play(const Log& later, const RunSetup& its_setup) {
    log = &later;
    setup.continues = its_setup.continues;
    hardware.play(later.inputs, later.inputs.first_tick + 1);
    name_inputs();
  }

  void fill_trace() {
    const std::int64_t tick = loop->ticks();
    trace.clear();
    for (; plan < log->plans.size() && log->plans[plan].tick <= tick; ++plan) {
      const LoggedPlan& p = log->plans[plan];
      if (p.planner < 0 || p.planner >= static_cast<int>(behavior->planners.size())) continue;
      trace.plans.push_back(
          {p.planner, p.sequence, p.ok, p.target, p.predicted_pos, p.predicted_vel, p.extension});
    }
    for (; edit < log->edits.size() && log->edits[edit].tick <= tick; ++edit) {
      for (const auto& [slot, value] : log->edits[edit].writes) {
        if (slot < 0 || slot >= static_cast<int>(slots.size())) continue;
        const int here = slots[static_cast<std::size_t>(slot)];
        if (here >= 0) trace.writes.push_back({here, value});
      }
      for (const int event : log->edits[edit].events) {
        if (event < 0 || event >= static_cast<int>(events.size())) continue;
        trace.events.push_back(events[static_cast<std::size_t>(event)]);
      }
      trace.limit_steps |= log->edits[edit].limit_steps;
      trace.late |= log->edits[edit].late;
      trace.requests_lost |= log->edits[edit].requests_lost;
      trace.scripts_stuck |= log->edits[edit].scripts_stuck;
    }
  }

  const Log* log;
  LogFolder folder;
  RunSetup setup;
  LoggedHardware hardware;
  std::unique_ptr<behaviors::Behavior> behavior;
  std::vector<int> slots, events;  // indexed by the log's slot and event
  engine::InputTrace trace;
  std::unique_ptr<engine::ControlLoop> loop;
  std::size_t plan = 0, edit = 0;  // next entry of the log
};

}  // namespace

struct Replay::Impl {
  std::unique_ptr<ReplayStage> now, before;
  bool computed = false;  // the last tick is not yet finished
  bool read = false;      // the data of the next tick were already read

  void end_tick() {
    if (computed) now->loop->actuate();
    computed = false;
  }
};

Replay::Replay(const Log& log, const std::string& behavior_file) : impl_(std::make_unique<Impl>()) {
  if (log.get("format", "1") != std::to_string(kLogFormat)) {
    throw std::runtime_error(fmt::format(
        "the log '{}' has format {}, made by version {} of this program: only format {} can be "
        "repeated here (events, report and export read it)",
        log.path, log.get("format", "1"), log.get("version", "?"), kLogFormat));
  }
  impl_->now = std::make_unique<ReplayStage>(log, behavior_file);
  if (impl_->now->setup.continues.number > 0) {
    throw std::runtime_error(
        fmt::format("the log '{}' goes on from the one before reload {}, and replays only with it: "
                    "give the folder "
                    "of the whole run",
                    log.path, impl_->now->setup.continues.number));
  }
  impl_->now->loop->start();
}
Replay::~Replay() = default;

// Same order as in lab::Reloads.
void Replay::go_on(const Log& next_log) {
  const RunSetup setup = read_setup(next_log.setup);
  const bool back = setup.continues.back && impl_->before != nullptr;
  const std::int64_t due = back ? end() - 1 : end();
  if (next() != end() || next_log.inputs.first_tick != due) {
    throw std::runtime_error(
        fmt::format("the log '{}' does not begin where the one before ends", next_log.path));
  }
  if (back) {  // the restored behavior repeats this tick
    impl_->computed = false;
    impl_->read = true;
    impl_->before->play(next_log, setup);
  } else {
    impl_->end_tick();
    impl_->before = std::make_unique<ReplayStage>(next_log, "");
  }
  std::swap(impl_->now, impl_->before);
  const ReplayStage& old = *impl_->before;
  impl_->now->loop->take_over(*old.loop,
                              behaviors::map_take_over(*old.behavior, *impl_->now->behavior),
                              back ? engine::ValueChange::at_once : engine::ValueChange::ramped);
  impl_->now->loop->set_probation(!back);
  if (back) impl_->before.reset();
}

std::int64_t Replay::end() const {
  return impl_->now->log->inputs.first_tick + impl_->now->log->inputs.ticks();
}
std::int64_t Replay::next() const { return impl_->now->loop->ticks() + (impl_->computed ? 1 : 0); }
const behaviors::Behavior& Replay::behavior() const { return *impl_->now->behavior; }
const engine::ControlLoop& Replay::loop() const { return *impl_->now->loop; }

void Replay::tick(const std::function<void()>& after, const std::function<void()>& before_machine) {
  impl_->end_tick();
  ReplayStage& now = *impl_->now;
  const LogContinuation& continues = now.setup.continues;
  if (continues.number > 0 && now.loop->ticks() == now.log->inputs.first_tick + continues.watch) {
    now.loop->set_probation(false);
  }
  now.fill_trace();
  now.trace.inspect = before_machine;
  if (!std::exchange(impl_->read, false)) now.loop->sense();
  now.loop->compute();
  if (after) after();
  impl_->computed = true;
}

std::string Replay::state() const {
  std::string names;
  for (const int state : impl_->now->loop->machine().active_atomic()) {
    if (!names.empty()) names += " ";
    names += impl_->now->behavior->states[static_cast<std::size_t>(state)].path;
  }
  return names.empty() ? "-" : names;
}

std::vector<std::string> Replay::plan_differences() const {
  std::vector<std::string> lines;
  const auto& logged = impl_->now->trace.plans;
  const auto& now = impl_->now->trace.planned;
  for (const behaviors::PlanAnswer& then : logged) {
    // Planners with an injected fault answered nothing in the run, or later.
    const auto found = std::ranges::find_if(now, [&](const behaviors::PlanAnswer& answer) {
      return answer.planner == then.planner && answer.sequence == then.sequence;
    });
    if (found == now.end() || same(then, *found)) continue;
    const auto text = [](const behaviors::PlanAnswer& plan) {
      return fmt::format("({}, {}, {})", plan.target[0], plan.target[1], plan.target[2]);
    };
    const auto planner = static_cast<std::size_t>(then.planner);
    lines.push_back(fmt::format("planner.{}: {} in the log, {} now",
                                impl_->now->behavior->planners[planner].name, text(then),
                                text(*found)));
  }
  return lines;
}

}  // namespace footfall::lab
