// An estimator over a log's sensors, the report's section about it, and figures by the truth.
#include "lab/replay/estimation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "engine/tick/input_row.h"
#include "lab/figures/log_figures.h"
#include "lab/report/report.h"
#include "lab/report/sections.h"
#include "tests/support/logged_run.h"

namespace footfall::tests {
namespace {

lab::Log logged(double seconds) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = seconds;
  return run_logged(rig, spec, 1, true).log;
}

std::string refused(const lab::Log& log, const lab::EstimatorTrial& trial) {
  try {
    lab::replay_estimator(log, trial);
  } catch (const std::runtime_error& problem) {
    return problem.what();
  }
  return "";
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(EstimatorReplay, OfTheTrueStateHasNoErrorsInAnyTick) {
  const lab::Log log = logged(1.0);
  const lab::EstimationFigures f = lab::replay_estimator(log, {"true_state", {}, 0.2});
  EXPECT_EQ(f.ticks, log.inputs.ticks() - 1 - 300);  // but the read at the start and 0.2 s
  EXPECT_EQ(f.without, 0);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(f.rpy[k].max, 0.0);
    EXPECT_EQ(f.position[k].max, 0.0);
    EXPECT_EQ(f.velocity[k].max, 0.0);
    EXPECT_EQ(f.com_velocity[k].max, 0.0);
    EXPECT_GT(f.com_velocity_at_plans[k].count, 0);
    EXPECT_LT(f.com_velocity_at_plans[k].count, f.com_velocity[k].count);
  }
  EXPECT_LT(f.rotation.max, 1e-12);
  EXPECT_TRUE(std::isnan(f.gyro_bias));
  EXPECT_EQ(f.nees.count, 0);
  const auto json = lab::estimation_json(f);
  EXPECT_EQ(json["estimator"], "true_state");
  EXPECT_EQ(json["orientation_rad"]["yaw"]["max"], 0.0);
  EXPECT_TRUE(json["gyro_bias_radps"].is_null() && json["nees"].is_null());
  EXPECT_TRUE(says(lab::estimation_text(f), "CoM velocity at plans x"));
}

// With sensor_truth the CoM's velocity is what the log says it was.
TEST(EstimatorReplay, TakesTheCoMsVelocityFromTheLogWhereSensorsHaveErrors) {
  lab::Log log = logged(0.5);
  engine::InputNames names = log.inputs.names;
  names.estimation = true;
  const engine::InputLayout before(log.inputs.names), after(names);
  std::vector<std::uint64_t> words(static_cast<std::size_t>(log.inputs.ticks()) *
                                   after.names().size());
  for (std::int64_t k = 0; k < log.inputs.ticks(); ++k) {
    hal::Sensors sensors;
    hal::Commands commands;
    const bool fresh = before.unpack(log.inputs.row(log.inputs.first_tick + k), sensors, commands);
    sensors.sensor_truth = true;
    sensors.true_com_velocity = {1.0, 2.0, 3.0};
    sensors.true_gyro_bias = {0.003, 0.0, 0.004};
    after.pack(sensors, fresh, commands,
               words.data() + static_cast<std::size_t>(k) * after.names().size());
  }
  log.inputs.words = words;
  log.inputs.names = names;
  log.inputs.columns = after.names();
  const lab::EstimationFigures f = lab::replay_estimator(log, {"true_state", {}, 0.0});
  // The true state estimates no errors of sensors: nothing to compare with those of the log.
  EXPECT_TRUE(std::isnan(f.gyro_bias) && std::isnan(f.accelerometer_bias));
  EXPECT_TRUE(std::isnan(f.gyro_bias_error[0]) && std::isnan(f.heading_deviation[1]));
  EXPECT_FALSE(says(lab::estimation_text(f), "bias"));
  for (std::size_t k = 0; k < 3; ++k) {  // the robot's own speed is below 1 m/s
    EXPECT_NEAR(f.com_velocity[k].rms(), static_cast<double>(k + 1), 0.5);
  }
}

TEST(EstimatorReplay, SaysWhatALogLacks) {
  lab::Log log = logged(0.3);
  EXPECT_TRUE(says(refused(log, {"motion_capture", {}, 0.0}),
                   "has no markers, which the estimator motion_capture needs"));
  EXPECT_TRUE(says(refused(log, {"true_state", {}, 10.0}), "nothing to compare from 10 s on"));
  EXPECT_TRUE(says(refused(log, {"true_state", {{"estimator.lambda_", "1"}}, 0.0}),
                   "expected estimator.KEY"));
  EXPECT_TRUE(
      says(refused(log, {"true_state", {{"lift_time", "1 s"}}, 0.0}), "only the estimator runs"));
  log.inputs.digest.clear();
  EXPECT_TRUE(says(refused(log, {"true_state", {}, 0.0}), "has no inputs to replay"));
}

// 2 s at 100 Hz of an estimator whose errors are known.
lab::Log estimated_log() {
  lab::Log log;
  log.path = "out/log.mcap";
  log.complete = log.part = true;
  log.rate_mhz = 100'000;
  log.run = {{"estimator", "motion_capture"}, {"tasks", R"({"attitude": "body_orientation"})"}};
  for (int row = 0; row < 200; ++row) {
    log.tick.push_back(row);
    log.time.push_back(row * 0.01);
  }
  const auto add = [&](const std::string& name, auto value) {
    log.signals.push_back({name, "", ""});
    log.column.emplace_back();
    for (int row = 0; row < 200; ++row) {
      log.column.back().push_back(static_cast<float>(value(row)));
    }
  };
  const auto swing = [](int row) { return 0.05 * std::sin(0.1 * row); };
  for (const std::string axis : {"roll", "pitch", "yaw"}) {
    add("base.rpy." + axis, [&](int row) { return swing(row) + 0.01 * std::sin(0.9 * row); });
    add("truth.base.rpy." + axis, swing);
    add("estimate.sigma." + axis, [](int) { return 0.006; });
    add("task.attitude.reference." + axis, [](int) { return 0.0; });
  }
  for (const std::string axis : {"x", "y", "z"}) {
    add("com.pos." + axis, [](int) { return 1.0; });
    add("truth.com.pos." + axis, [](int) { return 2.0; });
    for (const std::string what : {"vel.", "pos."}) {
      add("base." + what + axis, [&](int row) { return swing(row) + 0.02; });
      add("truth.base." + what + axis, swing);
    }
    add("estimate.gyro_bias." + axis, [](int row) { return 2e-3 * (1.0 - std::exp(-0.05 * row)); });
    add("truth.gyro_bias." + axis, [](int) { return 2e-3; });
    add("estimate.sigma.velocity." + axis, [](int) { return NAN; });
  }
  add("estimate.markers", [](int row) { return 5 + row % 3; });
  add("estimate.innovation.marker", [](int row) { return 1e-3 * std::abs(std::sin(0.3 * row)); });
  add("contact.right_foot", [](int row) { return row % 50 < 30 ? 1.0 : 0.0; });
  add("force.right_foot.z", [](int row) { return row % 50 < 28 ? 130.0 : 0.0; });
  return log;
}

TEST(EstimationSection, ShowsErrorsBoundsInnovationsMarkersBiasesAndContacts) {
  const lab::Log log = estimated_log();
  const lab::Section section = lab::estimation_section(log);
  double squared = 0.0;  // of an amplitude of 0.01 rad, below 2 sigma
  for (int row = 0; row < 200; ++row) squared += std::pow(0.01 * std::sin(0.9 * row), 2);
  const double rms = std::sqrt(squared / 200.0) * 180.0 / M_PI;
  EXPECT_TRUE(
      says(section.html, fmt::format("<td>pitch</td><td>{:.3g}°</td><td>0.573°</td><td>100 %"
                                     "</td>",
                                     rms)))
      << section.html;
  EXPECT_TRUE(says(section.html, "<td>velocity x</td><td>20 mm/s</td><td>20 mm/s</td><td></td>"))
      << section.html;
  std::string plots;
  for (const lab::TimePlot& plot : section.plots) {
    plots += fmt::format("{} {}; ", plot.id, plot.curves.size());
  }
  EXPECT_EQ(plots,
            "estimate-roll 3; estimate-pitch 3; estimate-yaw 3; estimate-velocity-x 1; "
            "estimate-velocity-y 1; estimate-velocity-z 1; estimate-position-x 1; "
            "estimate-position-y 1; estimate-position-z 1; estimate-innovation.marker 1; "
            "estimate-markers 1; estimate-gyro 6; estimate-contacts 2; ");
  if (const char* const folder = std::getenv("FOOTFALL_TEST_PAGES")) {
    std::ofstream(std::string(folder) + "/estimation.html")
        << lab::report_html(log, {.static_plots = true});
  }
}

TEST(EstimationSection, IsEmptyWithTheTrueState) {
  lab::Log log;
  EXPECT_TRUE(lab::estimation_section(log).plots.empty());
  EXPECT_TRUE(lab::estimation_section(log).html.empty());
}

TEST(RunFigures, JudgeARobotByTheTruthWhereItIsKnown) {
  lab::Log log = estimated_log();
  const lab::RunFigures f = lab::log_figures(log);
  EXPECT_NEAR(f.pitch.max, 0.05, 1e-4);  // and not 0.06, which the estimate has
  EXPECT_EQ(f.end[0], 2.0);
  log.run["estimator"] = "contact_kalman";  // its place is the one it believes
  EXPECT_EQ(lab::log_figures(log).end[0], 1.0);
  EXPECT_NEAR(lab::log_figures(log).pitch.max, 0.05, 1e-4);
}

}  // namespace
}  // namespace footfall::tests
