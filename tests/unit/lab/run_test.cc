// Runs: what ends them, and when pushes fire.
#include "lab/run/run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "engine/realtime/executive.h"
#include "lab/log/reader.h"
#include "lab/run/run_log.h"
#include "tests/support/fake_robot.h"
#include "tests/support/logged_run.h"
#include "tests/support/rig.h"

namespace footfall::tests {
namespace {

TEST(Run, EndsAfterTheStepsAskedFor) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_steps = 4;
  const lab::RunResult result = lab::run(*rig.loop, spec);
  EXPECT_EQ(result.end, lab::RunEnd::steps);
  EXPECT_EQ(result.figures.steps, 4);
  EXPECT_FALSE(result.figures.fell);
  EXPECT_EQ(result.tick_time.count(), rig.loop->ticks());
}

TEST(Run, EndsAtTheTimeAskedFor) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 0.5;
  const lab::RunResult result = lab::run(*rig.loop, spec);
  EXPECT_EQ(result.end, lab::RunEnd::time);
  EXPECT_EQ(rig.loop->ticks(), 750);
  EXPECT_DOUBLE_EQ(result.figures.time, 0.5);
}

TEST(Run, EndsWithAFall) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 10.0;
  lab::ScheduledEvent push;
  push.at_time = 0.2;
  push.fire = [&] { rig.backend->push(rig.backend->find_body("torso"), 800.0, 1.0, 0.2); };
  spec.events.push_back(push);
  const lab::RunResult result = lab::run(*rig.loop, spec);
  EXPECT_EQ(result.end, lab::RunEnd::fall);
  EXPECT_TRUE(result.figures.fell);
  EXPECT_LT(result.figures.time, 3.0);
  EXPECT_EQ(result.faults.of(core::Fault::fall), 1);
  // Why: the criterion that it names is beyond its limit, and the state is the one it fell in, not
  // the safe one that it fell into.
  ASSERT_TRUE(result.cause);
  const lab::EndCause& cause = *result.cause;
  if (cause.criterion == "tilt") {
    EXPECT_GT(*cause.value, 0.8);
  }
  if (cause.criterion == "height") {
    EXPECT_LT(*cause.value, 0.6 * rig.behavior->robot.standing_height);
  }
  EXPECT_TRUE(cause.criterion == "tilt" || cause.criterion == "height" ||
              cause.criterion == "body_contact")
      << cause.criterion;
  EXPECT_TRUE(cause.states.starts_with("step.") || cause.states == "sway") << cause.states;
  EXPECT_NE(cause.text.find(cause.states), std::string::npos);
}

TEST(Run, EndsWhereTheBehaviorEnds) {
  const std::string path = temporary("final.yaml");
  std::ofstream(path) << "behavior: 1\nrobot: hume\nmachine:\n  states:\n"
                         "    stand: {contacts: [right_foot, left_foot], after: 100 ms, to: done}\n"
                         "    done: {type: final}\n";
  Rig rig(path);
  lab::RunSpec spec;
  const lab::RunResult result = lab::run(*rig.loop, spec);
  std::filesystem::remove(path);
  EXPECT_EQ(result.end, lab::RunEnd::finished);
  EXPECT_NEAR(result.figures.time, 0.1, 2.0 / 1500.0);
}

TEST(Run, EndsWhenItIsStopped) {
  Rig rig("balance");
  std::atomic<bool> stop{false};
  lab::RunSpec spec;
  spec.stop = &stop;
  lab::ScheduledEvent interrupt;
  interrupt.at_time = 0.1;
  interrupt.fire = [&] { stop = true; };
  spec.events.push_back(interrupt);
  const lab::RunResult result = lab::run(*rig.loop, spec);
  EXPECT_EQ(result.end, lab::RunEnd::stopped);
  EXPECT_EQ(rig.loop->ticks(), 151);  // the tick in which it was told is finished
}

TEST(Run, EndsWithAFaultWhoseReactionIsToStop) {
  Rig rig("balance");
  rig.behavior->robot.reactions[static_cast<std::size_t>(core::Fault::joint_limit)] =
      core::Reaction::safe_stop;
  rig.behavior->robot.joints[2].position_max = rig.behavior->robot.joints[2].posture - 0.1;
  lab::RunSpec spec;
  const lab::RunResult result = lab::run(*rig.loop, spec);
  EXPECT_EQ(result.end, lab::RunEnd::fault);
  EXPECT_EQ(rig.loop->ticks(), 1);
  ASSERT_TRUE(result.cause);
  EXPECT_EQ(result.cause->criterion, "joint.limit");
  EXPECT_EQ(result.cause->subject, rig.behavior->robot.joints[2].name);
  EXPECT_NEAR(*result.cause->value, rig.behavior->robot.joints[2].posture, 1e-3);
  ASSERT_EQ(result.worst.size(), 1U);
  EXPECT_EQ(result.worst[0].joint, rig.behavior->robot.joints[2].name);
}

// Throws in the middle of a run.
struct Broken final : lab::RunObserver {
  void before_tick(const lab::StepClock& /*steps*/, lab::RunLog& /*log*/) override {
    if (++ticks == 500) throw std::runtime_error("error: it broke");
  }
  void after_tick() override {}
  int ticks = 0;
};

TEST(Run, AnExceptionLeavesALogThatCanBeReadAndSaysWhy) {
  Rig rig("balance");
  const std::string path = temporary("broken.mcap");
  {
    engine::LogWriter writer(path, rig.behavior->signals,
                             lab::make_log_header(*rig.behavior, lab::LogSource{}));
    Broken broken;
    lab::RunSpec spec;
    spec.log = &writer;
    spec.observer = &broken;
    EXPECT_THROW(lab::run(*rig.loop, spec), engine::RunInterrupted);
  }
  const lab::Log log = lab::read_log(path, {.all_rows = true, .inputs = true});
  std::filesystem::remove(path);
  EXPECT_EQ(log.inputs.first_tick + log.inputs.ticks(), 499);
  ASSERT_FALSE(log.events.empty());
  EXPECT_EQ(log.events.back().kind, "end");
  EXPECT_EQ(log.events.back().name, "error");
  EXPECT_NE(log.events.back().detail.find("it broke"), std::string::npos);
}

TEST(Run, AnExceptionOfTheStatusLineOrOfWhatListensStopsTheRobot) {
  for (const bool status : {true, false}) {
    StubRig rig(R"({behavior: 1, robot: hume, machine: {states: {
      a: {contacts: [], after: 10 ms, to: b, on_exit: [{log: hello}]}, b: {contacts: []}}}})");
    lab::RunSpec spec;
    const auto fail = [] { throw std::runtime_error("nobody listens"); };
    if (status) {
      spec.status = [&](const lab::RunStatus& /*now*/) { fail(); };
      spec.realtime = true;  // it comes five times a second
    } else {
      spec.said = [&](double /*time*/, const std::string& /*text*/) { fail(); };
    }
    EXPECT_THROW(lab::run(*rig.loop, spec), engine::RunInterrupted);
    // A stopped stub moves nothing any more.
    hal::Commands push;
    push.tau.fill(10.0);
    hal::Sensors before, after;
    rig.stub->read(before);
    for (int k = 0; k < 10; ++k) rig.stub->write(push);
    rig.stub->read(after);
    EXPECT_EQ(before.q, after.q);
  }
}

// A `final` state without control commands no torque: its step is what the joints still gave.
TEST(Run, TheStepOfLettingGoIsNotTheBehaviorsOwn) {
  const std::string path = temporary("let_go.yaml");
  std::ofstream(path) << "behavior: 1\nrobot: hume\nmachine:\n  states:\n    stand:\n"
                         "      contacts: [right_foot, left_foot]\n      tasks:\n"
                         "        height: {type: com_position, axes: [z], priority: 1, reference: "
                         "entry, gains: {kp: 270, kd: 10}}\n"
                         "        attitude: {type: body_orientation, priority: 1, reference: 0, "
                         "gains: {kp: 200, kd: 15}}\n"
                         "        rest: {type: joint_damping, priority: 2, gains: {kd: 2}}\n"
                         "      on_exit: [{log: \"lets go\"}]\n"
                         "      after: 2.1 s\n      to: done\n    done: {type: final}\n";
  Rig rig(path);
  lab::RunSpec spec;
  std::vector<std::string> said;
  spec.said = [&](double time, const std::string& text) {
    EXPECT_NEAR(time, 2.1, 2.0 / 1500.0);
    said.push_back(text);
  };
  const Logged run = run_logged(rig, spec);
  std::filesystem::remove(path);
  ASSERT_EQ(run.result.end, lab::RunEnd::finished);
  EXPECT_EQ(said, std::vector<std::string>{"lets go"});
  const std::size_t last = run.log.rows() - 1;
  double largest = 0.0;
  for (const auto& joint : rig.behavior->robot.joints) {
    const auto* command = run.log.values("joint." + joint.name + ".command");
    ASSERT_TRUE(command);
    EXPECT_EQ((*command)[last], 0.0F);
    largest = std::max(largest, std::abs(static_cast<double>((*command)[last - 1])));
  }
  const lab::RunFigures& f = run.result.figures;
  EXPECT_NEAR(f.end_torque_step, largest, 1e-5 * largest);  // logged as float
  EXPECT_LT(f.max_torque_step, 0.1 * largest);              // it stood still
  const auto* x = run.log.values("com.pos.x");
  EXPECT_NEAR(f.start[0], static_cast<double>(x->front()), 1e-6);
  EXPECT_NEAR(f.end[0], static_cast<double>(x->back()), 1e-6);
}

TEST(Run, APushAtAStepAndPhaseFiresOnceThere) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_steps = 8;
  int fired = 0;
  lab::ScheduledEvent push;
  push.at_step = 4;
  push.phase = 0.5;
  push.label = "here";
  push.fire = [&] { ++fired; };
  spec.events.push_back(push);
  const Logged run = run_logged(rig, spec);
  EXPECT_EQ(fired, 1);
  const std::vector<double> steps = times_of(run.log, "step");
  const std::vector<double> pushes = times_of(run.log, "push");
  ASSERT_EQ(pushes.size(), 1U);
  ASSERT_EQ(steps.size(), 8U);
  // Half of the last whole step's duration after the fourth, to the tick.
  EXPECT_NEAR(pushes[0], steps[3] + 0.5 * (steps[3] - steps[2]), 1.01 / 1500.0);
}

TEST(Run, AGoalVelocityMovesTheGoal) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 1.0;
  spec.goal = {{0.02, 0.01}};
  spec.goal_velocity = {{0.1, -0.05}};
  const Logged run = run_logged(rig, spec);
  const auto* x = run.log.values("goal.x");
  const auto* y = run.log.values("goal.y");
  ASSERT_TRUE(x && y);
  ASSERT_EQ(run.log.rows(), 1500U);
  for (const std::size_t row : {1UL, 700UL, 1400UL}) {
    EXPECT_NEAR(static_cast<double>((*x)[row]), 0.02 + 0.1 * run.log.time[row], 1e-6);
    EXPECT_NEAR(static_cast<double>((*y)[row]), 0.01 - 0.05 * run.log.time[row], 1e-6);
  }
}

// One axis at the end of its range does not stop the other.
TEST(Run, AGoalVelocityGoesOnAlongTheAxisThatHasRoom) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 1.0;
  spec.goal = {{999.95, 0.0}};  // its range ends at 1000
  spec.goal_velocity = {{0.1, 0.05}};
  const std::vector<engine::EditBatch> edits = lab::goal_edits(*rig.behavior, spec);
  ASSERT_EQ(edits.size(), 3U);
  EXPECT_NEAR(edits[1].over, 0.5, 1e-9);
  EXPECT_NEAR(edits[1].values.at(0).value, 1000.0, 1e-9);
  EXPECT_EQ(edits[2].over, 1.0);
  EXPECT_NEAR(edits[2].values.at(0).value, 0.05, 1e-12);
}

}  // namespace
}  // namespace footfall::tests
