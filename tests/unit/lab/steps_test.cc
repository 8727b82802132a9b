// The table of steps: on made-up ticks whose answers are known, and on runs; the chain of a fall.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "lab/report/data.h"
#include "lab/report/report.h"
#include "lab/report/sections.h"
#include "lab/steps/fall_chain.h"
#include "lab/steps/log_steps.h"
#include "lab/steps/step_columns.h"
#include "tests/support/logged_run.h"

namespace footfall::tests {
namespace {

using lab::StepRow;
using lab::StepSample;

constexpr double kTick = 1e-3;    // s
constexpr double kHeading = 0.5;  // rad: all that is across the heading has to be turned
constexpr double kLoaded = 20.0;  // N

std::array<double, 2> ahead_and_left(double x, double y) {
  return {std::cos(kHeading) * x - std::sin(kHeading) * y,
          std::sin(kHeading) * x + std::cos(kHeading) * y};
}

// A robot that stands on its right foot (contact 0) for 0.3 s of each 0.4 s: the left foot leaves
// the ground 0.05 s after a touchdown, and comes down at 0.4 s, 0.8 s, ...
StepSample hop(int tick) {
  StepSample s;
  s.time = tick * kTick;
  const int phase = tick % 400;
  const bool air = phase >= 50;
  s.yaw = kHeading;
  s.plan.yaw = kHeading;
  s.foot[0].force = {30.0, 40.0, 200.0};  // 50 N along the ground: a quarter
  s.foot[1].force[2] = air ? 0.0 : 100.0;
  const auto right = ahead_and_left(0.0, -0.08), left = ahead_and_left(0.02, 0.09);
  s.foot[0].position = {right[0], right[1], 0.0};
  s.foot[1].position = {left[0], left[1], air ? 0.05 * std::sin(M_PI * (phase - 50) / 350.0) : 0.0};
  s.foot[0].velocity = {6e-3, 8e-3, 0.0};  // 10 mm/s
  s.foot[1].velocity = {0.3, 0.4, air ? -0.25 : 0.0};
  if (air) {
    const auto at = [&](double x, double y) {
      const auto offset = ahead_and_left(x, y);
      return std::array{left[0] + offset[0], left[1] + offset[1]};
    };
    s.foot[1].measured = at(0.0, 0.0);
    s.foot[1].reference = at(0.0, 0.004);
    s.plan.target = at(0.003, 0.004);
  }
  s.com_velocity = ahead_and_left(0.1, 0.15);
  s.plan.predicted_vel = ahead_and_left(0.0, 0.2);
  s.plan.landing = 0.4 * (tick / 400 + 1) + 0.03;
  s.plan.extension = 0.01;
  s.yaw_rate = phase < 50 ? 0.7 : -0.3;
  s.tilt = phase == 200 ? 0.04 : 0.01;
  s.saturated = phase >= 100 && phase < 107;
  return s;
}

std::vector<StepRow> hops(int ticks, StepSample (*sample)(int) = hop) {
  lab::StepTable table(2, kLoaded);
  for (int tick = 0; tick < ticks; ++tick) table.observe(sample(tick));
  return table.rows();
}

TEST(StepTable, TellsTimesPlacesSpeedsAndForcesOfEachTouchdown) {
  const std::vector<StepRow> rows = hops(1000);
  ASSERT_EQ(rows.size(), 2U);
  const StepRow& row = rows[1];
  constexpr double kExact = 1e-12;
  EXPECT_EQ(row.foot, 1);
  EXPECT_EQ(row.number, 2.0);
  EXPECT_NEAR(row.time, 0.8, kExact);
  EXPECT_TRUE(std::isnan(rows[0].step_time));  // there was no touchdown before
  EXPECT_NEAR(row.step_time, 0.4, kExact);
  EXPECT_NEAR(row.flight_time, 0.35, kExact);
  EXPECT_NEAR(row.early, 0.03, kExact);
  EXPECT_EQ(row.extension, 0.01);
  EXPECT_NEAR(row.speed, 0.5, kExact);
  EXPECT_NEAR(row.sink_speed, 0.25, kExact);
  EXPECT_NEAR(row.error, 0.005, kExact);
  EXPECT_NEAR(row.not_reached, 0.003, kExact);
  EXPECT_NEAR(row.tracking, 0.004, kExact);
  EXPECT_NEAR(row.width, 0.17, kExact);
  EXPECT_NEAR(row.lateral_speed, 0.15, kExact);
  EXPECT_NEAR(row.lateral_predicted, 0.2, kExact);
  EXPECT_NEAR(row.clearance, 0.05, 1e-6);  // the top lies at a tick
  EXPECT_EQ(row.yaw, kHeading);
  EXPECT_EQ(row.yaw_rate, -0.3);
}

TEST(StepTable, SumsOverAStepWhatHappensFromOneTouchdownToTheNext) {
  const StepRow row = hops(1000)[1];
  EXPECT_NEAR(row.friction, 0.25, 1e-12);
  // 350 ticks on one foot at 10 mm/s. On two: the landing's own tick belongs to the step that it
  // ends, the other 49 to this one, and its end has one more.
  EXPECT_NEAR(row.slip_single, 350 * kTick * 0.01, 1e-9);
  EXPECT_NEAR(row.slip_double, 50 * kTick * (0.01 + 0.5), 1e-9);
  EXPECT_EQ(row.tilt, 0.04);
  EXPECT_EQ(row.saturated, 7.0);
}

TEST(StepTable, TakesTheYawRateAfterATouchdownFromTheNextLiftOff) {
  const std::vector<StepRow> rows = hops(1000);
  EXPECT_EQ(rows[0].yaw_rate_after, -0.3);
  const std::vector<StepRow> open = hops(810);  // ends on both feet
  EXPECT_TRUE(std::isnan(open.back().yaw_rate_after));
}

TEST(StepTable, CountsASpeedTowardsTheOtherSideAsNegative) {
  const auto mirrored = [](int tick) {
    StepSample s = hop(tick);
    std::swap(s.foot[0], s.foot[1]);
    for (auto& foot : s.foot) {  // about the heading
      const double c = std::cos(2 * kHeading), d = std::sin(2 * kHeading);
      const auto [x, y, z] = foot.position;
      foot.position = {c * x + d * y, d * x - c * y, z};
    }
    return s;  // the right foot hops now, and the CoM still goes left
  };
  const StepRow row = hops(1000, +mirrored)[1];
  EXPECT_EQ(row.foot, 0);
  EXPECT_NEAR(row.width, 0.17, 1e-12);
  EXPECT_NEAR(row.lateral_speed, -0.15, 1e-12);
}

TEST(StepTable, DoesNotCallABounceATouchdown) {
  const auto bouncing = [](int tick) {
    StepSample s = hop(tick);
    const int phase = tick % 400;
    if (phase >= 10 && phase < 40) s.foot[1].force[2] = 0.0;  // 30 ms
    return s;
  };
  EXPECT_EQ(hops(1000, +bouncing).size(), 2U);
}

TEST(StepTable, LeavesOutWhatNothingTells) {
  const auto bare = [](int tick) {
    StepSample s = hop(tick);
    s.plan = {};
    for (auto& foot : s.foot) foot.reference = foot.measured = {lab::kAbsent, lab::kAbsent};
    return s;
  };
  const std::vector<StepRow> rows = hops(500, +bare);
  ASSERT_EQ(rows.size(), 1U);
  const std::string csv = lab::steps_csv(rows, {"right", "left"});
  EXPECT_EQ(csv.substr(0, 60), "step,foot,time_s,step_time_s,flight_time_s,extension_s,early");
  const std::string line = csv.substr(csv.find('\n') + 1);
  EXPECT_EQ(line.substr(0, line.find("0.5,")), "1,left,0.4,,0.35,,,");
  EXPECT_EQ(std::ranges::count(line, ','), std::ranges::count(csv, ',') / 2);
}

TEST(StepColumns, StandInTheDocuments) {
  std::string table = "| column | unit | |\n|---|---|---|\n";
  for (const lab::StepColumn& c : lab::step_columns()) {
    table += "| `" + std::string(c.name) + "` | " + std::string(c.unit) + " | " +
             std::string(c.doc) + " |\n";
  }
  std::ifstream in(FOOTFALL_SOURCE_DIR "/docs/log.md");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  EXPECT_NE(text.find(table), std::string::npos) << "docs/log.md needs this table:\n" << table;
}

// Quiet steps, of which some are then spoiled.
std::vector<StepRow> quiet(std::size_t count) {
  std::vector<StepRow> rows(count);
  for (StepRow& row : rows) {
    row.step_time = 0.35;
    row.width = 0.16;
    row.lateral_predicted = row.lateral_speed = 0.1;
  }
  return rows;
}

TEST(FallChain, OrdersTheFirstCrossingsOfTheLastStepsByTimeThenByCause) {
  std::vector<StepRow> rows = quiet(20);
  rows[11].tilt = 0.2;  // the ninth from the end: not looked at
  rows[14].step_time = 0.62;
  rows[16].step_time = 0.7;
  rows[17].tilt = 0.06;
  rows[17].speed = 1.1;
  rows[19].width = 0.05;
  std::string told;
  for (const lab::Crossing& c : lab::fall_chain(rows)) {
    told += std::string(c.link->id) + " " + std::to_string(c.before_end) + "; ";
  }
  EXPECT_EQ(told, "long_step 5; fast_foot 2; tilt 2; narrow 0; ");
  EXPECT_DOUBLE_EQ(lab::fall_chain(rows)[0].value, 0.62);
  const std::string text = lab::chain_text(rows);
  EXPECT_NE(text.find("5 steps before it  step of 0.62 s (over 0.45"), std::string::npos) << text;
  const auto json = lab::chain_json(rows, true);
  EXPECT_EQ(json["crossings"].size(), 4U);
  EXPECT_EQ(json["healthy"]["steps"], 12);
  EXPECT_EQ(json["healthy"]["tilt"], 1);
  EXPECT_EQ(lab::chain_json(rows, false)["healthy"]["long_step"], 2);
}

TEST(FallChain, SaysSoIfNothingWasOutOfBounds) {
  EXPECT_NE(lab::chain_text(quiet(5)).find("nothing"), std::string::npos);
  EXPECT_NE(lab::chain_text({}).find("no swing foot"), std::string::npos);
}

lab::Log walked(double seconds, double push_at) {
  Rig rig("balance");
  lab::RunSpec spec;
  spec.max_time = seconds;
  lab::ScheduledEvent push;
  push.at_time = push_at;
  push.fire = [&] { rig.backend->push(rig.backend->find_body("torso"), 400.0, 1.0, 0.1); };
  if (push_at > 0.0) spec.events.push_back(push);
  return run_logged(rig, spec, 6, true).log;
}

// Oracle: the report's touchdowns, which it finds from the switches and the rows alone.
TEST(LogSteps, AgreeWithTheTouchdownsOfTheReport) {
  const lab::Log log = walked(4.0, 0.0);
  const lab::RunSteps steps = lab::log_steps(log);
  const std::vector<lab::Touchdown> touchdowns = lab::touchdowns(log);
  EXPECT_TRUE(steps.truth);
  ASSERT_EQ(steps.rows.size(), touchdowns.size());
  ASSERT_GT(steps.rows.size(), 6U);
  for (std::size_t k = 0; k < touchdowns.size(); ++k) {
    const StepRow& row = steps.rows[k];
    EXPECT_EQ(steps.feet[static_cast<std::size_t>(row.foot)], touchdowns[k].foot);
    EXPECT_NEAR(row.time, touchdowns[k].time, 2e-3);  // rows near a transition: each tick
    ASSERT_TRUE(touchdowns[k].planned);
    const double error = std::hypot(touchdowns[k].actual[0] - touchdowns[k].target[0],
                                    touchdowns[k].actual[1] - touchdowns[k].target[1]);
    // Two ticks apart, of a foot that goes at `speed`, and of a target that is planned anew.
    EXPECT_NEAR(row.error, error, 2e-3 * row.speed + 2e-3);
    EXPECT_LE(row.error, row.not_reached + row.tracking + 1e-9);
    EXPECT_GE(row.error, std::abs(row.not_reached - row.tracking) - 1e-9);
    EXPECT_GT(row.width, 0.08);
    EXPECT_LT(row.friction, 0.71);  // the ground's friction is 0.7, its cone a pyramid
    EXPECT_GT(row.clearance, 0.04);
  }
}

TEST(LogSteps, OfARunThatFellHaveAChainThatEndsInTheFall) {
  const lab::Log log = walked(8.0, 2.5);
  ASSERT_EQ(lab::end_of(log), "fall");
  const lab::RunSteps steps = lab::log_steps(log);
  const std::vector<lab::Crossing> chain = lab::fall_chain(steps.rows);
  ASSERT_FALSE(chain.empty());
  const std::size_t before =
      std::ranges::count_if(steps.rows, [](const StepRow& row) { return row.time > 2.5; });
  for (const lab::Crossing& c : chain) {
    if (c.link->id != "friction") EXPECT_LE(c.before_end, before) << c.link->id;
  }
  // The report says the same, and shows the quantities.
  const lab::Section section = lab::steps_section(log, steps);
  EXPECT_NE(section.html.find("first out of bounds"), std::string::npos);
  ASSERT_GE(section.plots.size(), 8U);
  EXPECT_EQ(section.plots[0].id, "step-time");
  if (const char* const folder = std::getenv("FOOTFALL_TEST_PAGES")) {
    lab::ReportOptions options;
    options.steps = steps;
    options.static_plots = true;
    std::ofstream(std::string(folder) + "/steps.html") << lab::report_html(log, options);
  }
}

TEST(LogSteps, OfALogWithoutInputsThereAreNone) {
  lab::Log log;
  EXPECT_TRUE(lab::log_steps(log).rows.empty());
  EXPECT_TRUE(lab::steps_section(log, {}).plots.empty());
}

}  // namespace
}  // namespace footfall::tests
