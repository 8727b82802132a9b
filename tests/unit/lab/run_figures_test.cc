// The figures of a run are those of the logged signals, by their definitions.
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "lab/figures/log_figures.h"
#include "lab/log/window.h"
#include "tests/support/logged_run.h"

namespace footfall::tests {
namespace {

// Every figure again from the log, by its definition.
TEST(RunFigures, AreThoseOfTheLoggedSignals) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 5.0;
  const Logged run = run_logged(rig, spec);
  const lab::Log& log = run.log;
  const lab::RunFigures& f = run.result.figures;
  ASSERT_EQ(log.rows(), 7500U);
  const auto column = [&](const std::string& name) {
    const auto* values = log.values(name);
    if (!values) throw std::runtime_error("no signal " + name);
    return std::vector<double>(values->begin(), values->end());
  };
  const auto x = column("com.pos.x"), y = column("com.pos.y");
  const auto roll = column("base.rpy.roll"), yaw = column("base.rpy.yaw");
  const auto step = column("torque.step");
  std::vector<std::vector<double>> command;
  for (const auto& joint : rig.behavior->robot.joints) {
    command.push_back(column("joint." + joint.name + ".command"));
  }
  double path = 0.0, roll_max = 0.0, yaw_max = 0.0, roll_squares = 0.0, torque = 0.0, steps = 0.0;
  double count = 0.0;
  for (std::size_t row = 0; row < log.rows(); ++row) {
    if (row > 0) path += std::hypot(x[row] - x[row - 1], y[row] - y[row - 1]);
    if (log.time[row] < 2.0) continue;
    count += 1.0;
    roll_max = std::max(roll_max, std::abs(roll[row]));
    roll_squares += roll[row] * roll[row];
    yaw_max = std::max(yaw_max, std::abs(yaw[row]));
    steps = std::max(steps, step[row]);
    for (const auto& tau : command) torque = std::max(torque, std::abs(tau[row]));
  }
  // Logged as float: 6e-8 of each value; the path adds 7500 differences of numbers below 0.3 m.
  EXPECT_NEAR(f.path_length, path, 7500 * 2 * 0.3 * 6e-8);
  EXPECT_NEAR(f.roll.max, roll_max, 1e-6);  // its reference is 0
  EXPECT_NEAR(f.roll.rms(), std::sqrt(roll_squares / count), 1e-6);
  EXPECT_NEAR(f.yaw.max, yaw_max, 1e-6);
  EXPECT_NEAR(f.max_torque_step, steps, 1e-5 * steps);
  EXPECT_NEAR(f.peak_torque, torque, 1e-5 * torque);

  const std::vector<double> at = times_of(log, "step");
  ASSERT_EQ(static_cast<std::int64_t>(at.size()), f.steps);
  ASSERT_GT(f.steps, 10);
  ASSERT_LT(f.steps, 51);  // the mean is over all of them
  const std::size_t a = row_at(log, at.front()), b = row_at(log, at.back());
  const double duration = at.back() - at.front();
  EXPECT_NEAR(f.mean_velocity_last_50[0], (x[b] - x[a]) / duration, 1e-6);
  EXPECT_NEAR(f.mean_velocity_last_50[1], (y[b] - y[a]) / duration, 1e-6);
  EXPECT_NEAR(f.mean_step_time, duration / static_cast<double>(f.steps - 1), 1e-6);
  double goal_error = 0.0;
  for (std::size_t k = at.size() - 10; k < at.size(); ++k) {
    const std::size_t row = row_at(log, at[k]);
    goal_error += std::hypot(x[row], y[row]) / 10.0;
  }
  EXPECT_NEAR(f.goal_error, goal_error, 1e-6);
}

// A page of a part says what the summary would have said of it: one definition, two sources.
TEST(RunFigures, OfALogAreThoseOfTheRun) {
  for (const int row_every : {1, 6}) {
    Rig rig("balance");
    lab::RunSpec spec;
    spec.max_time = 5.0;
    const Logged run = run_logged(rig, spec, row_every);
    const lab::RunFigures &f = run.result.figures, g = lab::log_figures(run.log);
    EXPECT_EQ(g.steps, f.steps);
    EXPECT_EQ(g.placements, f.placements);
    EXPECT_NEAR(g.time, f.time, 1e-9);
    EXPECT_EQ(g.counted_from, f.counted_from);
    // Between rows 4 ms apart a figure moves by its rate times 4 ms at most; the fastest here are
    // feet and base at 1 m/s and 1 rad/s. Of all rows only the rounding to float is left.
    const double slack = row_every == 1 ? 1e-6 : 4e-3;
    EXPECT_NEAR(g.placement_mean, f.placement_mean, slack);
    EXPECT_NEAR(g.placement_max, f.placement_max, slack);
    EXPECT_NEAR(g.roll.max, f.roll.max, slack);
    EXPECT_NEAR(g.roll.rms(), f.roll.rms(), slack);
    EXPECT_NEAR(g.yaw.rms(), f.yaw.rms(), slack);
    EXPECT_NEAR(g.height.rms(), f.height.rms(), slack);
    EXPECT_NEAR(g.height.max, f.height.max, slack);
    EXPECT_NEAR(g.goal_error, f.goal_error, slack);
    EXPECT_NEAR(g.worst_clearance, f.worst_clearance, slack);
    EXPECT_NEAR(g.mean_step_time, f.mean_step_time, slack);
    if (row_every == 1) {
      EXPECT_NEAR(g.peak_torque, f.peak_torque, 1e-5 * f.peak_torque);
      EXPECT_NEAR(g.max_torque_step, f.max_torque_step, 1e-5 * f.max_torque_step);
    }
  }
}

TEST(RunFigures, OfAPartCountEverythingInIt) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 5.0;
  const Logged run = run_logged(rig, spec);
  const lab::Log part = lab::log_window(run.log, 0.5, 1.5);
  const lab::RunFigures f = lab::log_figures(part);
  const auto& pitch = *run.log.values("base.rpy.pitch");
  double largest = 0.0;
  for (std::size_t row = 0; row < run.log.rows(); ++row) {
    if (run.log.time[row] >= 0.5 && run.log.time[row] <= 1.5)
      largest = std::max(largest, std::abs(static_cast<double>(pitch[row])));
  }
  EXPECT_EQ(f.pitch.max, largest);
  EXPECT_EQ(f.counted_from, part.time.front());
  EXPECT_NEAR(f.time, 1.0, 1.1 / 1500.0);
  EXPECT_EQ(f.pitch.count, static_cast<std::int64_t>(part.rows()));
}

TEST(ErrorFigure, IsRootMeanSquareAndLargestMagnitude) {
  lab::ErrorFigure figure;
  EXPECT_EQ(figure.rms(), 0.0);
  figure.add(3.0);
  figure.add(-4.0);
  EXPECT_DOUBLE_EQ(figure.rms(), std::sqrt(12.5));
  EXPECT_EQ(figure.max, 4.0);
}

}  // namespace
}  // namespace footfall::tests
