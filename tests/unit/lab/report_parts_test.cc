// Parts of the report by themselves: marks with the values before, friction cones, time in states,
// several runs on one page.
#include <gtest/gtest.h>

#include <cmath>

#include "lab/log/window.h"
#include "lab/report/report.h"
#include "lab/report/sections.h"
#include "lab/report/states.h"
#include "lab/report/strip.h"

namespace footfall::lab {
namespace {

// Rows at 1 kHz, without signals.
Log empty_log(int rows) {
  Log log;
  log.path = "out/log.mcap";
  log.complete = true;
  for (int row = 0; row < rows; ++row) {
    log.tick.push_back(row);
    log.time.push_back(row * 0.001);
  }
  return log;
}

void add(Log& log, const std::string& name, std::vector<float> values) {
  log.signals.push_back({name, "N", ""});
  log.column.push_back(std::move(values));
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(ReportStrip, ACaptionTellsTheFootHoweverDeepTheState) {
  EXPECT_EQ(state_caption("step.right_foot.lift.carry"), "right foot lift carry");
  EXPECT_EQ(state_caption("step.right_foot.land"), "right foot land");
  EXPECT_EQ(state_caption("sway.right_foot"), "sway right foot");
  EXPECT_EQ(state_caption("rise"), "rise");
}

TEST(ReportMarks, AnEditIsShownWithTheValueItChangedFrom) {
  Log log = empty_log(10);
  log.parameters = {{"gains.kp", 0, 1}, {"target", 1, 3}};
  log.parameter_values = {400.0, 0.0, 0.0, 0.9};
  log.edits = {{3, {{0, 420.0}, {3, 0.8}}, {}}, {6, {{0, 390.0}}, {}}};
  log.events = {{0.003, "edit", "scenario", "gains.kp = 420, target[2] = 0.8 over 2 ticks", 3},
                {0.006, "edit", "lcm", "gains.kp = 390, raise go", 6}};
  const std::string html = mark_section(log).html;
  EXPECT_TRUE(has(html, "gains.kp: 400 → 420, target[2]: 0.9 → 0.8 over 2 ticks"));
  EXPECT_TRUE(has(html, "gains.kp: 420 → 390, raise go"));
  EXPECT_TRUE(has(html, "data-t=\"0.0060\""));
  ASSERT_EQ(run_marks(log).size(), 2U);
  EXPECT_EQ(run_marks(log)[1].kind, "edit");
}

TEST(ReportMarks, AFaultThatComesAgainIsOneRowAndALineEachTime) {
  Log log = empty_log(10);
  for (const double t : {0.001, 0.002, 0.004}) log.events.push_back({t, "fault", "fall", "", 1});
  log.events.push_back({0.005, "push", "torso", "", 5});
  log.events.push_back({0.006, "transition", "a", "b", 6});
  const std::string html = mark_section(log).html;
  EXPECT_TRUE(has(html, "3 times until 0.004 s"));
  EXPECT_EQ(run_marks(log).size(), 4U);
  EXPECT_TRUE(mark_section(empty_log(3)).html.empty());
}

TEST(ReportForces, ConeUseIsTangentialOverFrictionTimesNormalWhileLoaded) {
  Log log = empty_log(3);
  log.run["friction"] = "0.5";
  add(log, "force.foot.x", {3.0F, 3.0F, 1.0F});
  add(log, "force.foot.y", {4.0F, 4.0F, 0.0F});
  add(log, "force.foot.z", {10.0F, 20.0F, 0.1F});  // hypot(3, 4) = 5; the last is not loaded
  const Section section = force_section(log);
  const TimePlot* use = nullptr;
  for (const TimePlot& plot : section.plots) {
    if (plot.id == "cone-use") use = &plot;
  }
  ASSERT_NE(use, nullptr);
  ASSERT_EQ(use->curves.size(), 2U);  // and the limit
  EXPECT_FLOAT_EQ(use->curves[0].values[0], 1.0F);
  EXPECT_FLOAT_EQ(use->curves[0].values[1], 0.5F);
  EXPECT_TRUE(std::isnan(use->curves[0].values[2]));
  ASSERT_EQ(section.planes.size(), 1U);
  EXPECT_EQ(section.planes[0].curves.back().points.back(), (Point2{10.0, 20.0}));  // its border
}

TEST(ReportStates, TimeAndVisitsCountWhatIsBelowAPath) {
  Log log = empty_log(6);
  log.time = {0.0, 0.1, 0.2, 0.4, 0.5, 1.0};
  log.run["states"] = R"(["machine","walk","walk.lift","walk.land","walker"])";
  add(log, "state", {2.0F, 3.0F, 4.0F, 2.0F, 2.0F, 4.0F});
  EXPECT_DOUBLE_EQ(state_use(log, "walk").time, 0.8);  // 0 to 0.2 and 0.4 to 1
  EXPECT_EQ(state_use(log, "walk").visits, 2);
  EXPECT_DOUBLE_EQ(state_use(log, "walk.land").time, 0.1);
  EXPECT_EQ(state_use(log, "walk.land").visits, 1);
  EXPECT_EQ(state_use(log, "walker").visits, 2);
  EXPECT_EQ(state_use(log, "gone").visits, 0);

  behaviors::Diagram diagram;
  diagram.states.resize(3);
  diagram.states[0].children = {1, 2};
  diagram.states[1].path = "walk";
  diagram.states[2].path = "rest";
  add_state_use(log, diagram);
  EXPECT_EQ(diagram.states[1].notes, std::vector<std::string>{"0.8 s, 80.0 %, 2 visits"});
  EXPECT_EQ(diagram.states[2].notes, std::vector<std::string>{"never"});
}

TEST(ReportStates, EvenRowsAreThoseOfEveryNthTick) {
  Log log = empty_log(10);
  log.tick = {0, 4, 5, 6, 8, 12, 13, 14, 15, 16};
  log.row_every = 4;
  add(log, "state", {0, 4, 5, 6, 8, 12, 13, 14, 15, 16});
  keep_even_rows(log);
  EXPECT_EQ(log.tick, (std::vector<std::int64_t>{0, 4, 8, 12, 16}));
  EXPECT_EQ(log.column[0], (std::vector<float>{0, 4, 8, 12, 16}));
  EXPECT_DOUBLE_EQ(log.time[2], 0.004);
}

TEST(ReportCompare, RunsOfDifferentLengthShareOnePage) {
  Log a = empty_log(100), b = empty_log(60);
  a.run = {{"behavior", "<a>"}, {"seed", "1"}};
  b.run = {{"behavior", "b"}, {"seed", "2"}};
  b.events = {{0.02, "push", "torso", "", 20}};
  add(a, "com.pos.x", std::vector<float>(100, 1.0F));
  add(a, "com.pos.y", std::vector<float>(100, 1.0F));
  add(b, "com.pos.x", std::vector<float>(60, 2.0F));
  add(b, "com.pos.y", std::vector<float>(60, 2.0F));
  add(b, "joint.knee.torque", std::vector<float>(60, 2.0F));
  LogComparison parting;
  parting.setup = {"seed: '1' against '2'"};
  parting.differences = {{"input", 20, 0.02, "1 against 2"}};
  for (const bool is_static : {false, true}) {
    const std::string page = compare_html({{&a, R"({"steps":3,"error":{"roll":0.5}})", {}},
                                           {&b, R"({"steps":5,"error":{"roll":0.5}})", parting}},
                                          is_static);
    for (const char* id : {"figures", "parting", "marks", "path", "motion", "torques"}) {
      EXPECT_TRUE(has(page, std::string("<section id=\"") + id + "\"")) << id;
    }
    EXPECT_TRUE(has(page, "<td>5<br><small>+2</small>"));
    EXPECT_TRUE(has(page, "<th>error roll</th><td>0.5</td><td>0.5</td>"));
    EXPECT_TRUE(has(page, "data-run=\"1\""));
    EXPECT_TRUE(has(page, "A: &lt;a&gt;, seed 1"));
    EXPECT_FALSE(has(page, "<a>,"));
    EXPECT_TRUE(has(page, "data-t=\"0.0200\" data-what=\"input\""));
  }
}

TEST(ReportPage, PointsOfACurveShrinkWithTheNumberOfCurves) {
  Log log = empty_log(2);
  EXPECT_EQ(run_points(log, 1), 6000U);
  for (int k = 0; k < 250; ++k) add(log, "joint.j" + std::to_string(k) + ".torque", {0, 0});
  // 3 MB of base64 floats, 6 bytes each, over 250 and 500 curves.
  EXPECT_EQ(run_points(log, 1), 2000U);
  EXPECT_EQ(run_points(log, 2), 1000U);
}

}  // namespace
}  // namespace footfall::lab
