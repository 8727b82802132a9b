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
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = 5.0;
  const Logged run = run_logged(rig, spec);
  const lab::RunFigures &f = run.result.figures, g = lab::log_figures(run.log);
  EXPECT_EQ(g.steps, f.steps);
  EXPECT_EQ(g.placements, f.placements);
  EXPECT_NEAR(g.time, f.time, 1e-9);
  EXPECT_EQ(g.counted_from, f.counted_from);
  const auto near = [](double of_log, double of_run, const char* what) {  // rounded to float
    EXPECT_NEAR(of_log, of_run, 1e-7 + 1e-5 * std::abs(of_run)) << what;
  };
  near(g.placement_mean, f.placement_mean, "placement mean");
  near(g.placement_max, f.placement_max, "placement max");
  near(g.roll.max, f.roll.max, "roll max");
  near(g.roll.rms(), f.roll.rms(), "roll rms");
  near(g.yaw.rms(), f.yaw.rms(), "yaw rms");
  near(g.height.rms(), f.height.rms(), "height rms");
  near(g.goal_error, f.goal_error, "goal error");
  near(g.worst_clearance, f.worst_clearance, "clearance");
  near(g.mean_step_time, f.mean_step_time, "step time");
  near(g.peak_torque, f.peak_torque, "peak torque");
  near(g.max_torque_step, f.max_torque_step, "torque step");
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

// A log has a row of each tick around changes of state only. A mean over rows would count these
// more: of 100 ticks of 1 and 10 000 of 0.1 the mean square is 200/10100, over the rows 101/200.
TEST(RunFigures, ARowCountsForTheTicksUntilTheNext) {
  lab::Log log;
  log.part = true;  // all of it counts
  log.rate_mhz = 1'000'000;
  log.row_every = 100;
  log.signals = {{"base.rpy.roll", "", ""}};
  log.column.resize(1);
  for (std::int64_t tick = 0; tick < 10'100; tick += tick < 100 ? 1 : 100) {
    log.tick.push_back(tick);
    log.time.push_back(1e-3 * static_cast<double>(tick));
    log.column[0].push_back(tick < 100 ? 1.0F : 0.1F);
  }
  log.tick.push_back(10'100);  // the last row stands for itself alone
  log.time.push_back(10.1);
  log.column[0].push_back(0.0F);
  const lab::RunFigures f = lab::log_figures(log);
  EXPECT_EQ(f.roll.count, 10'101);
  EXPECT_NEAR(f.roll.rms(), std::sqrt(200.0 / 10'101.0), 1e-6);  // 0.1 as a float
}

TEST(ErrorFigure, IsRootMeanSquareAndLargestMagnitude) {
  lab::ErrorFigure figure;
  EXPECT_EQ(figure.rms(), 0.0);
  figure.add(3.0);
  figure.add(-4.0);
  EXPECT_DOUBLE_EQ(figure.rms(), std::sqrt(12.5));
  EXPECT_EQ(figure.max, 4.0);
  figure.add(1.0, 3);  // in three ticks
  EXPECT_DOUBLE_EQ(figure.rms(), std::sqrt(28.0 / 5.0));
}

}  // namespace
}  // namespace footfall::tests
