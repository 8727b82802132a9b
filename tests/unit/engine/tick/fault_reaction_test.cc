// Every fault with every reaction that a robot file may give it, on each backend that can have it:
// count, event, row in the log, ticks from the cause to the reaction, and the replay of the log.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>

#include "engine/log/writer.h"
#include "lab/replay/replay.h"
#include "lab/run/log_setup.h"
#include "lab/run/run.h"
#include "lab/run/run_log.h"
#include "model/robot/fault_rules.h"
#include "sim/mujoco_backend.h"
#include "sim/world/description.h"
#include "tests/support/fake_robot.h"

namespace footfall::tests {
namespace {

namespace fs = std::filesystem;
using core::Fault;
using core::Reaction;

constexpr std::int64_t kCause = 40;  // the tick in which something goes wrong
constexpr int kLate = 3;             // limits.overruns of the robot
// limits.swing, ms at 1500 Hz, half of which passes between the ticks kCause and kCause + 1.
constexpr double kLoadedSwing = (2 * kCause + 1) / 1.5;
constexpr int kImuAge = 6, kMocapAge = 12;  // ticks of its limits.imu_age and limits.mocap_age
constexpr int kSwing = 15;                  // ticks of its limits.swing where that is tried

// Level 1 has rank 3 in the nominal posture; with straight legs its height cannot be moved.
// Where a swing is tried the left foot is let go of, and stays on the ground.
std::string behavior_text(const std::string& robot, std::string_view fault) {
  const bool lands = fault == core::fault_name(Fault::load_air);  // in kCause
  const bool swings = lands || fault == core::fault_name(Fault::swing_contact);
  return fmt::format(
      R"(
behavior: 1
robot: {}
events: {{flood: an event that nobody waits for, work: an action that fails, hang: for a script}}
{}parameters: {{narrow: {{value: 1, range: [0, 2]}}}}
planners: {{foot: {{type: velocity_reversal, kappa: 0.4, reversal: 185 ms}}}}
{}machine:
  safe: limp
  transitions:
    - {{on: fault.{}, do: [{{mark: heard}}]}}
    - {{on: work, do: [{{set: {{narrow: "= $narrow + 5"}}}}]}}
  states:
    hold:
      on_entry: [{{mark: step}}]
      contacts: [{}]
      tasks:
        height: {{type: com_position, axes: [z], priority: 1, gains: {{kp: 200, kd: 20}}, reference: entry}}
        attitude: {{type: body_orientation, axes: [roll, pitch], priority: 1, gains: {{kp: 200, kd: 20}}, reference: entry}}
        pose: {{type: joint_posture, priority: 2, gains: {{kp: 2000, kd: 40}}, reference: entry}}
      invoke: [{{planner: foot, at: 0 s, every: 0.5 ms, deadline: 2 ms, on_late: keep_last,
                 with: {{stance: right_foot, swing: left_foot, switch_in: 100 ms}}}}]
      transitions: [{}]
    both: {{contacts: [right_foot, left_foot], tasks: {{pose: {{type: joint_posture, priority: 1, gains: {{kp: 2000, kd: 40}}, reference: entry}}}}}}
    limp: {{contacts: [], tasks: {{rest: {{type: joint_damping, priority: 1, gains: {{kd: 5}}}}}}}}
)",
      robot,
      fault == core::fault_name(Fault::script_stuck)
          ? "scripts: {files: slow.lua, deadline: 20 ms}\n"
          : "",
      // The true state needs no sensor.
      fault == core::fault_name(Fault::sensor_nan) ? "estimator: {type: contact_kalman}\n" : "",
      fault, swings ? "right_foot" : "right_foot, left_foot",
      lands ? fmt::format("{{after: {} ms, to: both}}", (kCause - 0.5) / 1.5) : "");
}

// About half a second in one function of Lua's library, which counts no instructions.
constexpr const char* kSlowScript =
    "footfall.on('hang', function() string.find(('a'):rep(1000), '.-.-.-b') end)";

// How a fault is provoked, and what is to be seen of it.
struct Provocation {
  std::function<void(hal::Sensors&)> spoil = nullptr;  // in each tick from `from` on ...
  std::int64_t from = kCause;
  int spoiled = 1000;                                                 // ... as many of them
  std::function<void(engine::ControlLoop&, Meddler&)> act = nullptr;  // before kCause
  int ticks = 1;               // in how many ticks `act` is repeated
  int delay = 0;               // ticks from the cause until it is found
  bool after_machine = false;  // found after the machine's tick: it reacts in the next one
  std::optional<std::int64_t> count = 1;  // nullopt: once or more
};

void straighten_legs(hal::Sensors& s) {
  const double lean = std::atan2(0.0181, 0.4575);  // of the thigh, so that hip and knee are plumb
  for (const std::size_t leg : {0U, 3U}) {
    s.q[leg] = 0.0;
    s.q[leg + 1] = lean;
    s.q[leg + 2] = -lean;
  }
  s.q_WB = {1.0, 0.0, 0.0, 0.0};
}

// The knees move the height with a lever of sin(0.05 deg).
void bend_slightly(hal::Sensors& s) {
  straighten_legs(s);
  for (const std::size_t leg : {0U, 3U}) {
    s.q[leg + 1] -= 0.05 * std::numbers::pi / 180.0;
    s.q[leg + 2] += 0.1 * std::numbers::pi / 180.0;
  }
}

// Pushed along the ground, with a torque that pushes, too.
void slide(hal::Sensors& s) {
  s.v_WB = {20.0, 0.0, 0.0};
  s.tau[0] += 30.0;
}

void lift_left(hal::Sensors& s) { s.contact[1] = false; }

void raise(engine::ControlLoop& loop, const char* event, int times) {
  for (int k = 0; k < times; ++k) loop.machine().raise(loop.behavior().find_event(event));
}

Provocation sensor_provocation(Fault fault) {
  switch (fault) {
    case Fault::sensor_stale:
      return {.act = [](engine::ControlLoop&, Meddler& robot) { robot.stale = true; }};
    case Fault::imu_stale:
      return {.spoil = [](hal::Sensors& s) { s.imu_fresh = false; }, .delay = kImuAge};
    case Fault::mocap_stale:
      return {.spoil = [](hal::Sensors& s) { s.mocap_fresh = false; }, .delay = kMocapAge};
    case Fault::sensor_nan:  // told once while it lasts
      return {.spoil = [](hal::Sensors& s) { s.gyro[1] = std::nan(""); }, .spoiled = 3};
    case Fault::sensor_clock:
      return {.spoil = [](hal::Sensors& s) { s.time_ns -= 1'000'000'000; }};
    default:
      return {};
  }
}

Provocation provocation(Fault fault) {
  switch (fault) {
    case Fault::fall:
      return {.spoil = [](hal::Sensors& s) { s.body_contact = true; }};
    case Fault::non_finite:
      return {.spoil = [](hal::Sensors& s) { s.qd[3] = std::nan(""); }};
    case Fault::torque_limit:  // in one tick: if it lasts, the simulated robot falls
    case Fault::torque_step:
      return {.spoil = [](hal::Sensors& s) { s.q[0] += 0.5; },
              .spoiled = 1,
              .after_machine = true,
              .count = std::nullopt};
    case Fault::joint_limit:
      return {.spoil = [](hal::Sensors& s) { s.q[0] = 1.0; }, .spoiled = 1};  // beyond 50 degrees
    case Fault::swing_too_long:
      return {.spoil = lift_left, .delay = kSwing};
    case Fault::simulator_warning:
      return {.spoil = [](hal::Sensors& s) { s.backend_fault = true; }};
    case Fault::tick_overrun:
      return {.act = [](engine::ControlLoop& loop, Meddler&) { loop.late(true); },
              .ticks = kLate,
              .delay = kLate - 1,
              .count = kLate};
    case Fault::planner_late:  // the answer that is due now is lost
      return {.act = [](engine::ControlLoop& loop, Meddler&) { loop.drop_planners(true); },
              .after_machine = true,
              .count = std::nullopt};
    case Fault::execution:
      return {.act = [](engine::ControlLoop& loop, Meddler&) { raise(loop, "work", 1); },
              .after_machine = true};
    case Fault::event_overflow:  // 128 find room
      return {.act = [](engine::ControlLoop& loop, Meddler&) { raise(loop, "flood", 150); },
              .after_machine = true,
              .count = 22};
    case Fault::rank_loss:
      return {.spoil = straighten_legs, .after_machine = true};
    case Fault::no_estimate:
      return {.spoil = [](hal::Sensors& s) { s.has_truth = false; }};
    case Fault::script_stuck:  // waited for and given up after the tick
      return {.act = [](engine::ControlLoop& loop, Meddler&) { raise(loop, "hang", 1); },
              .delay = 1,
              .after_machine = true};
    case Fault::swing_contact:  // since the first tick: beyond half of limits.swing in kCause
      return {
          .spoil = [](hal::Sensors& s) { s.contact[1] = true; }, .from = 0, .after_machine = true};
    case Fault::slip:  // with 20 m/s in a tick
      return {.spoil = slide, .after_machine = true};
    case Fault::load_air:
      return {.spoil = lift_left, .from = 0, .after_machine = true};
    case Fault::condition:
      return {.spoil = bend_slightly, .spoiled = 1, .after_machine = true};
    default:
      return sensor_provocation(fault);
  }
}

struct Case {
  Fault fault;
  Reaction reaction;
  bool mujoco;
};

constexpr std::array kReactionNames = {"continue", "safe_state", "safe_stop"};

std::string case_name(const testing::TestParamInfo<Case>& info) {
  std::string name = fmt::format("{}_{}_{}", core::fault_name(info.param.fault),
                                 kReactionNames[static_cast<std::size_t>(info.param.reaction)],
                                 info.param.mujoco ? "mujoco" : "stub");
  std::ranges::replace(name, '.', '_');
  return name;
}

std::vector<Case> legal_cases() {
  std::vector<Case> cases;
  for (const model::FaultRule& rule : model::fault_rules()) {
    for (const auto reaction : {Reaction::keep_going, Reaction::safe_state, Reaction::safe_stop}) {
      if (reaction == Reaction::keep_going && !rule.refusing.empty()) continue;
      for (const bool mujoco : {false, true}) cases.push_back({rule.fault, reaction, mujoco});
    }
  }
  return cases;
}

class FaultReaction : public testing::TestWithParam<Case> {
 protected:
  void SetUp() override {
    folder_ = fs::path(testing::TempDir()) / ("footfall_fault_" + std::to_string(getpid()));
    fs::create_directories(folder_);
    const auto [fault, reaction, mujoco] = GetParam();
    const std::string name(core::fault_name(fault));
    // Other provocations may make a foot of the simulated robot jump.
    const std::string swing = fault == Fault::swing_too_long  ? "10 ms"
                              : fault == Fault::swing_contact ? fmt::format("{} ms", kLoadedSwing)
                                                              : "1 s";
    // While reads bring nothing the IMU's data age, too.
    const char* const age = fault == Fault::sensor_stale ? "1 s" : "4 ms";
    write("robot.yaml", fmt::format("robot: 1\nbase: {}/robots/hume/robot.yaml\n"
                                    "limits: {{swing: {}, overruns: {}, imu_age: {}, "
                                    "mocap_age: 8 ms}}\nfaults: {{{}: {}}}\n",
                                    fs::absolute(FOOTFALL_SOURCE_DIR).string(), swing, kLate, age,
                                    name, kReactionNames[static_cast<std::size_t>(reaction)]));
    write("slow.lua", kSlowScript);
    write("behavior.yaml", behavior_text(path("robot.yaml"), name));
    core::Diagnostics diagnostics;
    behavior_ = behaviors::load_behavior(path("behavior.yaml"), {}, diagnostics);
    if (behavior_ == nullptr) throw std::runtime_error(diagnostics.to_string());
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
  }

  std::unique_ptr<hal::Hardware> backend() const {
    const model::RobotDescription& robot = behavior_->robot;
    if (GetParam().mujoco) {
      return std::make_unique<sim::MujocoBackend>(robot, sim::WorldDescription());
    }
    hal::StubSettings settings;
    settings.joints = robot.joint_count();
    settings.contacts = static_cast<int>(robot.contacts.size());
    settings.period = robot.period_s();
    settings.inertia = 1e6;
    settings.base = {0.0, 0.0, robot.standing_height};
    for (const auto& joint : robot.joints) settings.start.push_back(joint.posture);
    return std::make_unique<hal::StubBackend>(settings);
  }

  // 60 ticks, logged.
  lab::Log run(const Provocation& what) {
    const auto real = backend();
    Meddler robot(*real);
    robot.spoil = [&](hal::Sensors& sensors, std::int64_t tick) {
      if (what.spoil && tick >= what.from && tick < what.from + what.spoiled) what.spoil(sensors);
    };
    engine::ControlLoop loop(*behavior_, robot, {});
    lab::RunSpec spec;
    spec.max_time = 60.0 * behavior_->period();
    for (int k = 0; what.act && k < what.ticks; ++k) {
      lab::ScheduledEvent event;
      event.at_time = static_cast<double>(kCause + k) * behavior_->period();
      event.label = "cause";
      event.fire = [&] { what.act(loop, robot); };
      spec.events.push_back(event);
    }
    engine::LogWriter writer(path("log.mcap"), behavior_->signals,
                             lab::make_log_header(*behavior_, {}));
    spec.log = &writer;
    result_ = lab::run(loop, spec);
    writer.close();
    ticks_ = loop.ticks();
    ended_by_ = loop.ended_by();
    state_ = loop.state();
    return lab::read_log(path("log.mcap"), {.all_rows = true, .inputs = true});
  }

  fs::path folder_;
  std::unique_ptr<behaviors::Behavior> behavior_;
  lab::RunResult result_;
  std::int64_t ticks_ = 0;
  Fault ended_by_ = Fault::count;
  engine::LoopState state_ = engine::LoopState::running;
};

// The tick of the first such event, -1 without one.
std::int64_t first(const lab::Log& log, std::string_view kind, std::string_view name,
                   std::string_view detail = "") {
  for (const lab::LoggedEvent& event : log.events) {
    if (event.kind != kind || (!name.empty() && event.name != name)) continue;
    if (detail.empty() || event.detail == detail) return event.tick;
  }
  return -1;
}

TEST_P(FaultReaction, HappensIsCountedLoggedAndReplayed) {
  const auto [fault, reaction, mujoco] = GetParam();
  const Provocation what = provocation(fault);
  const lab::Log log = run(what);
  const std::int64_t found = kCause + what.delay;
  const std::int64_t reacts = found + (what.after_machine ? 1 : 0);
  const bool ends = fault == Fault::fall || fault == Fault::simulator_warning;
  const bool stops = ends || reaction == Reaction::safe_stop;

  if (what.count) {
    EXPECT_EQ(result_.faults.of(fault), *what.count);
  } else {
    EXPECT_GE(result_.faults.of(fault), 1);
  }
  // A late tick is in the log when it is late, whether or not others follow.
  const std::int64_t row = fault == Fault::tick_overrun ? kCause : found;
  EXPECT_EQ(first(log, "fault", core::fault_name(fault)), row);

  if (stops) {
    EXPECT_EQ(ticks_, found + 1);
    EXPECT_EQ(ended_by_, fault);
    const bool fell = ends || fault == Fault::swing_too_long;
    EXPECT_EQ(state_, fell ? engine::LoopState::fallen : engine::LoopState::stopped);
    EXPECT_EQ(result_.end, fell ? lab::RunEnd::fall : lab::RunEnd::fault);
    EXPECT_TRUE(result_.cause.has_value());
  } else {
    EXPECT_EQ(ticks_, 60);
    EXPECT_EQ(state_, engine::LoopState::running);
    EXPECT_EQ(first(log, "transition", "", "limp"), reaction == Reaction::safe_state ? reacts : -1);
  }
  EXPECT_EQ(first(log, "mark", "heard"), stops && what.after_machine ? -1 : reacts);

  lab::Replay replay(log);
  const lab::ReplayReport report = lab::verify_replay(log, replay);
  EXPECT_EQ(report.differs_at, -1) << fmt::format("{}", fmt::join(report.lines, "\n"));
  EXPECT_EQ(replay.loop().faults().of(fault), result_.faults.of(fault));
}

INSTANTIATE_TEST_SUITE_P(Legal, FaultReaction, testing::ValuesIn(legal_cases()), case_name);

}  // namespace
}  // namespace footfall::tests
