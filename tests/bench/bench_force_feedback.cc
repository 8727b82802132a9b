// The least unstable feedback of an internal force: computed from actuators, delays and low-pass
// (behaviors/check/actuators/force_loop.h) in the posture in which Hume stands, and found by
// bisection in simulation, where the difference of two runs, with and without a small step of the
// reference, grows or dies out. Prints {"cases": [{"name", "alike", "computed", "simulated"}]},
// "simulated" null if it is not within the bracket; with an argument only the cases whose names
// hold it. `alike`: whether both legs follow alike. If not, a step of the tension also moves the
// torso, whose tasks are no part of what is computed.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "behaviors/check/actuators/force_loop.h"
#include "behaviors/check/physics/law.h"
#include "behaviors/loader.h"
#include "core/index.h"
#include "engine/tick/control_loop.h"
#include "sim/mujoco_backend.h"
#include "sim/world/actuators.h"
#include "sim/world/description.h"

namespace footfall {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::array kBracket = {0.7, 1.4};  // of what is computed
constexpr double kResolution = 0.001;        // of the same
constexpr double kKick = 0.1;                // N
constexpr double kKickTime = 0.3;            // s, of the behavior's step

struct Case {
  const char* name;
  double bandwidth;                                     // Hz
  double command_delay = 0.0, measurement_delay = 0.0;  // ticks
  double viscous = 0.0;                                 // N m s/rad
  // Of a joint's torque loop; none: ideal actuators.
  std::function<hal::TorqueLoopGains(const model::JointDescription&, hal::TorqueLoopGains own)>
      gains = {};
  bool alike = true;  // both legs
};

// d for a damping ratio of J s^2 + d s + k (1 + p).
hal::TorqueLoopGains direct(const model::JointDescription& joint, double p, double forward,
                            double ratio) {
  hal::TorqueLoopGains gains;
  gains.type = hal::TorqueLoopGains::Type::direct;
  gains.damps = hal::TorqueLoopGains::Damping::spring;
  gains.p = p;
  gains.forward = forward;
  gains.damping = 2.0 * ratio * std::sqrt(joint.rotor * joint.spring * (1.0 + p));
  return gains;
}

hal::TorqueLoopGains own_gains(const model::JointDescription&, hal::TorqueLoopGains own) {
  return own;
}
hal::TorqueLoopGains stiff_gains(const model::JointDescription& joint, hal::TorqueLoopGains) {
  return direct(joint, 20.0, 1.0, 0.7);
}
hal::TorqueLoopGains soft_gains(const model::JointDescription& joint, hal::TorqueLoopGains) {
  return direct(joint, 0.8, 0.0, 0.7);
}
// The legs' torque loops differ: each bears a part of the tension.
hal::TorqueLoopGains mixed_gains(const model::JointDescription& joint, hal::TorqueLoopGains own) {
  return joint.name.starts_with("right_") ? direct(joint, 3.0, 1.0, 1.0) : stiff_gains(joint, own);
}
hal::TorqueLoopGains integral_gains(const model::JointDescription& joint, hal::TorqueLoopGains) {
  hal::TorqueLoopGains gains = direct(joint, 5.0, 1.0, 0.8);
  gains.i = 20.0;
  return gains;
}
hal::TorqueLoopGains cascade_gains(const model::JointDescription&, hal::TorqueLoopGains) {
  hal::TorqueLoopGains gains;
  gains.type = hal::TorqueLoopGains::Type::cascade;
  gains.velocity_p = 40.0;
  gains.velocity_i = 40.0;
  gains.p = 0.3;
  gains.i = 0.5;
  return gains;
}

const std::vector<Case>& cases() {
  static const std::vector<Case> all = {
      {"ideal, no delay", 20.0},
      {"ideal, 1 tick", 20.0, 1.0},
      {"ideal, 2 ticks, 80 Hz", 80.0, 2.0},
      {"Kp 20 ff 1 of Hume, 1 tick", 20.0, 1.0, 0.0, 0.0, own_gains},
      {"Kp 20 ff 1 of Hume, no delay, 40 Hz", 40.0, 0.0, 0.0, 0.0, own_gains},
      {"Kp 20 ff 1, 1/2 + 1 tick", 20.0, 0.5, 1.0, 0.0, stiff_gains},
      {"Kp 0.8 ff 0, 1 tick", 20.0, 1.0, 0.0, 0.0, soft_gains},
      {"Kp 0.8 ff 0, 2 + 1 ticks, 5 Hz", 5.0, 2.0, 1.0, 0.0, soft_gains},
      {"Kp 20 and Kp 3, ff 1, 1 tick", 20.0, 1.0, 0.0, 0.0, mixed_gains, false},
      {"Kp 5 ff 1 Ki 20, friction, 1 tick, 10 Hz", 10.0, 1.0, 0.0, 2.0, integral_gains},
      {"cascade, 1 tick", 20.0, 1.0, 0.0, 0.0, cascade_gains},
  };
  return all;
}

sim::WorldDescription world_of(const Case& c, double period) {
  core::Diagnostics diagnostics;
  sim::WorldDescription world = sim::load_world(
      sim::find_world_file("ideal", {FOOTFALL_SOURCE_DIR}), diagnostics, {FOOTFALL_SOURCE_DIR});
  if (diagnostics.has_errors()) throw std::runtime_error(diagnostics.to_string());
  world.actuators.command_delay = c.command_delay * period;
  world.actuators.measurement_delay = c.measurement_delay * period;
  world.actuators.viscous = c.viscous;
  if (c.gains) world.actuators.model = sim::ActuatorModel::series_elastic;
  return world;
}

// A run of a case; the robot's own torque loops are those of the case.
struct Run {
  std::unique_ptr<behaviors::Behavior> behavior;
  sim::WorldDescription world;
  std::unique_ptr<sim::MujocoBackend> backend;
  std::unique_ptr<engine::ControlLoop> loop;

  Run(const Case& c, double feedback, double kick) {
    core::Diagnostics diagnostics;
    behaviors::LoadOptions options;
    options.search = {FOOTFALL_SOURCE_DIR};
    options.set = {{"feedback", std::to_string(feedback)},
                   {"bandwidth", std::to_string(c.bandwidth) + " Hz"},
                   {"kick", std::to_string(kick) + " N"}};
    behavior = behaviors::load_behavior(
        std::string(FOOTFALL_SOURCE_DIR) + "/tests/bench/force_feedback.yaml", options,
        diagnostics);
    if (!behavior) throw std::runtime_error(diagnostics.to_string());
    model::RobotDescription& robot = behavior->robot;
    for (std::size_t j = 0; c.gains && j < robot.joints.size(); ++j) {
      robot.drives.torque_loop[j] = c.gains(robot.joints[j], robot.drives.torque_loop[j]);
    }
    world = world_of(c, behavior->period());
    backend = std::make_unique<sim::MujocoBackend>(robot, world);
    loop = std::make_unique<engine::ControlLoop>(*behavior, *backend, engine::LoopSettings{});
    loop->start();
  }
  // Whether no limit of a torque acts: an oscillation that has grown to one grows no further.
  bool is_linear() const {
    return !loop->controller().result().limited && !loop->sensors().motor_saturated;
  }
  double tension() const { return loop->controller().result().internal_measured[0]; }
};

double computed(const Case& c) {
  Run run(c, 0.0, 0.0);
  while (run.loop->time() < kKickTime) run.loop->tick();
  const double period = run.loop->period();
  behaviors::PhysicsLaw law(*run.behavior, run.loop->model());
  const auto shares = law.tension_shares(run.behavior->controls.front(), 0);
  if (shares.empty()) throw std::runtime_error("no tension");
  const int physics_steps = run.world.physics.steps_per_tick;
  if (!c.gains) {
    const auto late = std::lround(c.command_delay * physics_steps);
    const auto plant = behaviors::TensionPlant::ideal(1 + static_cast<int>(late / physics_steps));
    return behaviors::ForceLoop(plant, {1.0}, c.bandwidth, period).limit({});
  }
  const hal::DriveSettings drive =
      sim::drive_settings(run.world.actuators, run.behavior->robot, physics_steps);
  const behaviors::DriveTiming timing = {drive.steps * physics_steps, drive.command_delay,
                                         1 + drive.measurement_delay};
  std::vector<behaviors::TorqueResponse> joints;
  for (const hal::DriveJoint& joint : drive.joints) {
    joints.emplace_back(
        behaviors::torque_loop_map(joint.gains, joint.actuator, drive.step, drive.filters), timing);
    if (!joints.back().is_stable()) throw std::runtime_error("an unstable torque loop");
  }
  const auto plant = behaviors::TensionPlant::elastic(joints);
  return behaviors::ForceLoop(plant, shares, c.bandwidth, period).limit({});
}

// Root mean square beside a straight line.
double swing(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0.0, slope = 0.0, square = 0.0;
  for (const double v : values) mean += v / n;
  for (std::size_t k = 0; k < values.size(); ++k) {
    slope += (static_cast<double>(k) - 0.5 * (n - 1.0)) * values[k];
  }
  slope *= 12.0 / (n * (n * n - 1.0));
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double off = values[k] - mean - slope * (static_cast<double>(k) - 0.5 * (n - 1.0));
    square += off * off / n;
  }
  return std::sqrt(square);
}

bool is_stable(const Case& c, double feedback) {
  constexpr double kLast = 0.5, kWindow = 0.25;  // s after the step
  Run with(c, feedback, kKick), without(c, feedback, 0.0);
  std::vector<double> first, last;
  while (with.loop->time() < kKickTime + kLast + kWindow) {
    const bool both = with.loop->tick() == engine::LoopState::running &&
                      without.loop->tick() == engine::LoopState::running;
    const bool linear = with.is_linear() && without.is_linear();
    if (!both || (!linear && with.loop->time() > kKickTime)) return false;
    const double t = with.loop->time() - kKickTime;
    const double off = with.tension() - without.tension();
    if (t > 0.0 && t <= kWindow) first.push_back(off);  // with the step itself
    if (t > kLast) last.push_back(off);
  }
  return swing(last) < swing(first);
}

std::optional<double> simulated(const Case& c, double limit) {
  double good = kBracket[0] * limit, bad = kBracket[1] * limit;
  if (!is_stable(c, good) || is_stable(c, bad)) return std::nullopt;
  while (bad - good > kResolution * limit) {
    const double middle = 0.5 * (good + bad);
    (is_stable(c, middle) ? good : bad) = middle;
  }
  return 0.5 * (good + bad);
}

int run(const std::string& part) {
  Json out = Json::array();
  for (const Case& c : cases()) {
    if (std::string(c.name).find(part) == std::string::npos) continue;
    const double limit = computed(c);
    const auto found = simulated(c, limit);
    out.push_back({{"name", c.name},
                   {"alike", c.alike},
                   {"computed", limit},
                   {"simulated", found ? Json(*found) : Json(nullptr)}});
    std::fprintf(stderr, "%s: computed %.3f, simulated %.3f\n", c.name, limit,
                 found.value_or(std::nan("")));
  }
  std::printf("%s\n", Json{{"cases", out}}.dump().c_str());
  return 0;
}

}  // namespace
}  // namespace footfall

int main(int argc, char** argv) try {
  return footfall::run(argc > 1 ? argv[1] : "");
} catch (const std::exception& problem) {
  std::fprintf(stderr, "error: %s\n", problem.what());
  return 1;
}
