// What an edit may do to the torque: however hard it is, no joint's command steps beyond the
// robot's bound while the edit acts; and how a person's edit is spread over time.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/support/allocation_guard.h"
#include "tests/support/fake_robot.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

using engine::EditBatch;
using engine::EditSource;

// Joints that do not move, held by a spring: the torque is inertia times kp times the error.
constexpr const char* kSpring = R"(
behavior: 1
robot: hume
parameters:
  knee: {value: 0.6, range: [-1, 2], live: true}
gains: {ranges: {kp: [0, 4000], ki: [0, 1], kd: [0, 100]}, soft: {pose: {kp: 0, kd: 0}}}
stacks:
  held: {contacts: [], gains: soft, tasks: {pose: {type: joint_posture, priority: 1, reference: entry}}}
machine: {states: {hold: {stack: held}}}
)";

EditBatch edit(const behaviors::Behavior& behavior, const char* name, double value,
               EditSource source, double over = 0.0) {
  EditBatch batch;
  const int parameter = behavior.find_parameter(name);
  const behaviors::ParameterInfo& info = behavior.parameters[static_cast<std::size_t>(parameter)];
  for (int k = 0; k < info.size; ++k) batch.values.push_back({info.slot + k, value});
  batch.source = source;
  batch.over = over;
  return batch;
}

// Largest change of a joint's command from one tick to the next, N m.
class Steps {
 public:
  double of(const engine::ControlLoop& loop) {
    double largest = 0.0;
    for (int j = 0; j < loop.model().joint_count(); ++j) {
      const auto i = static_cast<std::size_t>(j);
      if (seen_) largest = std::max(largest, std::abs(loop.commands().tau[i] - before_[i]));
      before_[i] = loop.commands().tau[i];
    }
    seen_ = true;
    return largest;
  }

 private:
  std::array<double, core::kMaxJoints> before_{};
  bool seen_ = false;
};

// What the controller asks for, within the joints' limits: N m, by joint.
std::vector<double> wanted_torque(const engine::ControlLoop& loop) {
  const tasks::ActiveControl& control = loop.machine().control();
  const bool blended = control.has_other && control.form == tasks::TransitionForm::continuous;
  const double w = blended ? control.other_weight : 0.0;
  const std::vector<double> limits = loop.behavior().robot.torque_limits();
  std::vector<double> tau;
  for (std::size_t j = 0; j < limits.size(); ++j) {
    double asked = loop.controller().tau_primary()[j];
    if (w > 0.0) asked = (1.0 - w) * asked + w * loop.controller().tau_other()[j];
    tau.push_back(tasks::within_limit(asked, limits[j]));
  }
  return tau;
}

TEST(EditLimits, AHardEditOfAGainReachesItsTorqueAtTheBoundAndThenStepsAreFreeAgain) {
  // The joints were pushed half a radian away from where they are held, too softly to feel it.
  StubRig rig(kSpring, 1e9);
  rig.hardware->spoil = [](hal::Sensors& sensors, std::int64_t tick) {
    if (tick > 0) sensors.q[2] += 0.5;
  };
  engine::InputTrace trace;
  rig.loop->record(trace);
  rig.loop->start();
  Steps steps;
  rig.loop->tick();
  steps.of(*rig.loop);
  ASSERT_TRUE(rig.loop->edits()
                  .submit(edit(*rig.behavior, "gains.soft.pose.kp", 4000.0, EditSource::scenario))
                  .accepted());
  const double bound = rig.behavior->robot.torque_step_limit;
  int held = 0;
  for (int k = 0; k < 40; ++k) {
    rig.loop->tick();
    EXPECT_LE(steps.of(*rig.loop), bound) << k;
    held += trace.limit_steps ? 1 : 0;
  }
  // What was asked for from the first of these ticks on.
  const double asked = wanted_torque(*rig.loop)[2];
  EXPECT_EQ(rig.loop->commands().tau[2], asked);
  const auto ticks = static_cast<int>(std::ceil(std::abs(asked) / bound));
  EXPECT_GT(ticks, 4) << asked;
  EXPECT_EQ(held, ticks);
  EXPECT_EQ(rig.faults(core::Fault::torque_step), 0);
}

TEST(EditLimits, APersonsEditTakesTheRobotsTimeAtLeastAndAScenariosItsOwn) {
  for (const double ramp : {0.1, 0.05, 0.0}) {
    StubRig rig(kSpring, 1e9, nullptr, [&](behaviors::Behavior& b) { b.robot.edit_ramp = ramp; });
    const behaviors::Behavior& behavior = *rig.behavior;
    rig.loop->start();
    const auto ticks_of = [&](EditSource source, double over) {
      const double to = rig.loop->machine().parameters()[0] > 0.5 ? 0.0 : 1.0;
      EXPECT_TRUE(rig.loop->edits().submit(edit(behavior, "knee", to, source, over)).accepted());
      for (int k = 0;; ++k) {
        rig.loop->tick();
        engine::EditAnswer answer;
        while (rig.loop->edits().take_answer(answer)) {
        }
        if (rig.loop->machine().parameters()[0] == to) return k;
      }
    };
    ASSERT_EQ(behavior.parameters[0].name, "knee");
    EXPECT_EQ(ticks_of(EditSource::live, 0.0), std::lround(ramp * 1500.0));
    EXPECT_EQ(ticks_of(EditSource::live, 0.2), 300);
    EXPECT_EQ(ticks_of(EditSource::scenario, 0.0), 0);
    EXPECT_EQ(ticks_of(EditSource::scenario, 0.02), 30);
  }
}

// Any value in range of any live parameter or gain, at any moment; the robot may fall by that. The
// limiter is on in each tick that an edit writes to, and until the command is what is asked for; no
// such tick steps beyond the bound. What a bad value does to the motion later is not the edit's
// step.
TEST(EditLimits, NoHardEditOfABalancingRobotStepsTheTorqueBeyondTheBound) {
  std::mt19937_64 random(7);
  int edits = 0, held_back = 0;
  for (int run = 0; run < 6; ++run) {
    Rig rig("balance_best");
    const behaviors::Behavior& behavior = *rig.behavior;
    const double bound = behavior.robot.torque_step_limit;
    engine::InputTrace trace;
    rig.loop->record(trace);
    rig.loop->start();
    Steps steps;
    bool behind = false;  // what is asked for
    const auto uniform = [&](double a, double b) {
      return std::uniform_real_distribution<double>(a, b)(random);
    };
    for (int k = 0; k < 2000 && rig.loop->state() == engine::LoopState::running; ++k) {
      if (k > 100 && random() % 40 == 0) {
        const auto p = random() % behavior.parameters.size();
        const behaviors::ParameterInfo& info = behavior.parameters[p];
        if (!info.live || !info.has_range()) continue;
        EditBatch batch =
            edit(behavior, info.name.c_str(), uniform(info.min, info.max), EditSource::scenario);
        edits += rig.loop->edits().submit(batch).accepted() ? 1 : 0;
      }
      rig.loop->sense();
      rig.loop->compute();
      engine::EditAnswer answer;
      while (rig.loop->edits().take_answer(answer)) {
      }
      const double step = steps.of(*rig.loop);
      const auto joints = static_cast<std::size_t>(rig.loop->model().joint_count());
      const std::span<const double> commanded(rig.loop->commands().tau.data(), joints);
      const std::vector<double> asked = wanted_torque(*rig.loop);
      if (trace.limit_steps) {
        ASSERT_LE(step, bound) << "tick " << k;
      }
      ASSERT_TRUE(trace.limit_steps || (trace.writes.empty() && !behind)) << "tick " << k;
      behind = trace.limit_steps && !std::equal(asked.begin(), asked.end(), commanded.begin());
      held_back += behind ? 1 : 0;
      rig.loop->actuate();
    }
  }
  EXPECT_GT(edits, 100);
  EXPECT_GT(held_back, 20);  // the edits were hard
}

TEST(EditLimits, TheLimiterAllocatesNothing) {
  if (!AllocationGuard::counts()) GTEST_SKIP() << "not under sanitizers";
  StubRig rig(kSpring, 1e9);
  rig.loop->start();
  ASSERT_TRUE(rig.loop->edits()
                  .submit(edit(*rig.behavior, "gains.soft.pose.kp", 1000.0, EditSource::live))
                  .accepted());
  const AllocationGuard guard;
  for (int k = 0; k < 200; ++k) rig.loop->tick();
  EXPECT_EQ(guard.allocations(), 0);
}

}  // namespace
}  // namespace footfall::tests
