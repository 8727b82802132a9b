// The report is one page that needs nothing else, with every section, in both ways of drawing.
#include "lab/report/report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "core/text/json_text.h"
#include "lab/log/window.h"
#include "lab/report/data.h"
#include "lab/report/plot.h"
#include "lab/report/strip.h"

namespace footfall::lab {
namespace {

// A robot that steps twice a second: 10 s at 250 Hz, with every kind of signal once.
class Report : public testing::Test {
 protected:
  Report() {
    log_.path = "out/log.mcap";
    log_.complete = true;
    log_.run = {
        {"behavior", "behaviors/library/balance.yaml"},
        {"robot", "hume"},
        {"seed", "1"},
        {"states", R"(["step.right_foot.lift","step.right_foot.land","step.left_foot.lift"])"}};
    for (int row = 0; row < 2500; ++row) log_.time.push_back(row * 0.004);
    const auto right = [](double t) { return std::fmod(t, 1.0) < 0.5; };
    for (const char* foot : {"right_foot", "left_foot"}) {
      const bool is_right = foot[0] == 'r';
      for (const char* kind : {"contact.", "support."}) {
        add(std::string(kind) + foot, [=](double t) { return right(t) == is_right ? 1.0 : 0.0; });
      }
      add(std::string("point.") + foot + ".x", [](double t) { return 0.1 * std::floor(2 * t); });
      add(std::string("point.") + foot + ".z", [=](double t) {
        return right(t) == is_right ? 0.0 : 0.05 * std::sin(2.0 * M_PI * std::fmod(t, 0.5));
      });
      add(std::string("point.") + foot + ".y", [=](double) { return is_right ? -0.1 : 0.1; });
      add(
          std::string("force.") + foot + ".z", [](double t) { return 100 * t; }, "N");
    }
    for (const char* name : {"com.pos.x",
                             "com.pos.y",
                             "com.pos.z",
                             "com.ref.z",
                             "com.vel.x",
                             "com.vel.y",
                             "base.rpy.roll",
                             "task.height.error",
                             "task.height.error.z",
                             "task.height.measured.z",
                             "task.height.reference.z",
                             "task.height.commanded.z",
                             "task.height.achieved.z",
                             "planner.foot.target.x",
                             "planner.foot.target.y",
                             "planner.foot.predicted_pos.x",
                             "planner.foot.predicted_pos.y",
                             "planner.foot.predicted_vel.x",
                             "planner.foot.predicted_vel.y",
                             "joint.right_knee.torque",
                             "joint.right_knee.command",
                             "torque.step"}) {
      add(
          name, [](double t) { return 0.5 + 0.01 * std::sin(9 * t); }, "m");
    }
    add("steps", [](double t) { return std::floor(2 * t); });
    add("state", [=](double t) { return right(t) ? (std::fmod(t, 1.0) < 0.25 ? 0.0 : 1.0) : 2.0; });
    log_.events = {{0.5, "mark", "step", "n=1 <b>&</b>"}, {0.7, "fault", "fault.fall", ""}};
    options_.timing_json =
        R"({"tick_us":{"p50":8.5},"percentiles":[{"part":0.5,"us":8.5},{"part":0.99,"us":15.25}],"histogram":{"edges_us":[0,10,20],"counts":[900,3]}})";
    options_.summary_json = R"({"end":"time","fell":false,"steps":19,"error":{"roll":
        {"rms":0.001,"max":0.0042}},"faults":{"fall":2},"goal_error_m":null})";
    options_.strip_png = {1, 2, 3};
  }

  template <typename F>
  void add(const std::string& name, F value, const std::string& unit = "") {
    log_.signals.push_back({name, unit, ""});
    std::vector<float> column;
    for (const double t : log_.time) column.push_back(static_cast<float>(value(t)));
    log_.column.push_back(std::move(column));
  }

  Log log_;
  ReportOptions options_;
};

// Attributes and style rules that would make a browser load something.
bool loads_something(const std::string& page) {
  for (const char* pattern : {"src=\"http", "src='http", "src=http", "src=\"//",
                              "src=\"file:", "href=\"http", "href='http", "href=http", "href=\"//",
                              "@import", "url(http", "url(\"http", "url(//", "<link", "<iframe"}) {
    if (page.find(pattern) != std::string::npos) return true;
  }
  return false;
}

TEST_F(Report, ThePageHasEverySectionInBothWaysOfDrawing) {
  for (const bool is_static : {false, true}) {
    options_.static_plots = is_static;
    const std::string page = report_html(log_, options_);
    for (const char* id : {"summary", "film", "path", "phase", "tasks", "posture", "torques",
                           "forces", "planner", "events", "timing", "settings"}) {
      EXPECT_NE(page.find(std::string("<section id=\"") + id + "\""), std::string::npos) << id;
      EXPECT_NE(page.find(std::string("<a href=\"#") + id + "\""), std::string::npos) << id;
    }
    EXPECT_EQ(page.find("{{"), page.find("{{", page.find("<script>"))) << "a place was not filled";
  }
}

TEST_F(Report, AWindowHasTheRowsAndEventsOfItsTimeOnly) {
  const Log part = log_window(log_, 0.6, 0.9);
  ASSERT_GT(part.rows(), 0U);
  EXPECT_GE(part.time.front(), 0.6);
  EXPECT_LE(part.time.back(), 0.9);
  for (const auto& column : part.column) EXPECT_EQ(column.size(), part.rows());
  ASSERT_EQ(part.events.size(), 1U);
  EXPECT_EQ(part.events[0].name, "fault.fall");
  EXPECT_EQ(log_window(log_, 1e6, 2e6).rows(), 0U);
}

TEST_F(Report, APageOfAPartSaysSoAndHasThePartsFigures) {
  const Log part = log_window(log_, 2.1, 4.2);
  options_.summary_json = core::json_text(page_summary(part, options_.summary_json));
  const std::string page = report_html(part, options_);
  EXPECT_NE(page.find("Of the part from 2.100 s to 4.200 s"), std::string::npos);
  EXPECT_NE(page.find("<b>4</b><span>steps</span>"), std::string::npos);  // at 2.5, 3.0, 3.5, 4.0 s
  EXPECT_NE(page.find("<b>0</b><span>faults</span>"), std::string::npos);
  EXPECT_EQ(page.find("<b>4.2 mrad</b>"), std::string::npos);  // of the whole run
}

TEST_F(Report, TheStripShowsTheRunAndWhatMattersMostInIt) {
  const auto row = [](const StripMoments& strip, std::size_t k) {
    const std::size_t first = k * static_cast<std::size_t>(kStripColumns);
    return std::pair(strip.times.at(first), strip.times.at(first + kStripColumns - 1));
  };
  const StripMoments steps = strip_moments(log_);
  EXPECT_EQ(row(steps, 0), std::pair(log_.time.front(), log_.time.back()));
  EXPECT_NEAR(row(steps, 1).first, 7.5, 0.005);  // four of a step each half second
  log_.events.push_back({5.0, "push", "80 N", ""});
  const StripMoments push = strip_moments(log_);
  EXPECT_EQ(push.caption, "Above: the run at equal times; below: the push at 5.000 s");
  EXPECT_LT(row(push, 1).first, 5.0);
  EXPECT_GT(row(push, 1).second, 6.0);
  log_.events.push_back({10.0, "end", "fall", ""});
  const StripMoments fall = strip_moments(log_);
  EXPECT_EQ(row(fall, 1).second, log_.time.back());
  EXPECT_GT(row(fall, 1).first, 8.0);
  const StripMoments part = strip_moments(log_window(log_, 4.0, 6.0));
  EXPECT_EQ(part.times.size(), 16U);
  EXPECT_NEAR(part.times.front(), 4.0, 0.005);
  EXPECT_NEAR(part.times.back(), 6.0, 0.005);
}

TEST_F(Report, ThePageLoadsNothing) {
  for (const bool is_static : {false, true}) {
    options_.static_plots = is_static;
    EXPECT_FALSE(loads_something(report_html(log_, options_)));
  }
  EXPECT_TRUE(loads_something("<script src=\"https://x.y/z.js\">"));  // the check can fail
}

TEST_F(Report, WithoutTheLibraryEveryPlotIsDrawnAsSvg) {
  options_.static_plots = true;
  const std::string page = report_html(log_, options_);
  EXPECT_EQ(page.find("data-plot="), std::string::npos);
  EXPECT_EQ(page.find("leeoniya"), std::string::npos);  // the library's head comment
  EXPECT_NE(page.find("aria-label=\"Roll and pitch\""), std::string::npos);
  EXPECT_NE(page.find("href=\"#bands-run\""), std::string::npos);
}

TEST_F(Report, NumbersComeFromTheSummaryAndElseFromTheLog) {
  const std::string page = report_html(log_, options_);
  EXPECT_NE(page.find("<b>19</b><span>steps</span>"), std::string::npos);
  EXPECT_NE(page.find("<b>4.2 mrad</b>"), std::string::npos);
  EXPECT_NE(page.find("fall 2"), std::string::npos);
  EXPECT_NE(page.find("99 % of the ticks within</th><td>15.25 µs"), std::string::npos);
  options_.summary_json = core::json_text(page_summary(log_, "not json"));
  const std::string other = report_html(log_, options_);
  EXPECT_NE(other.find("<b>19</b><span>steps</span>"), std::string::npos);  // a foot each 0.5 s
  EXPECT_NE(other.find("roll error"), std::string::npos);
}

TEST_F(Report, TextFromTheRunIsNeverMarkup) {
  log_.run["world"] = "<script>alert(1)</script>";
  log_.signals[0].name = "contact.</script>";
  const std::string page = report_html(log_, options_);
  EXPECT_EQ(page.find("<script>alert"), std::string::npos);
  EXPECT_EQ(page.find("<b>&</b>"), std::string::npos);
  EXPECT_EQ(page.find("contact.</script>"), std::string::npos);
}

TEST_F(Report, ALogWithoutRowsStillGivesAPage) {
  Log none;
  none.path = "empty.mcap";
  none.signals = {{"com.pos.x", "m", ""}};
  none.column.resize(1);
  for (const bool is_static : {false, true}) {
    ReportOptions options;
    options.strip_note = "no EGL";
    options.static_plots = is_static;
    EXPECT_NE(report_html(none, options).find("No pictures: no EGL"), std::string::npos);
  }
  EXPECT_NO_THROW(report_html(Log{}, {}));
}

TEST_F(Report, NoRightsToWriteIsOneSentenceWithThePath) {
  try {
    write_report(log_, "/no/such/folder/report.html", options_);
    FAIL() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(),
                 "/no/such/folder/report.html: cannot write: No such file or directory");
  }
}

TEST_F(Report, AMinuteStaysBelowFiveMegabytes) {
  const std::size_t rows = 15000;
  log_.time.clear();
  for (std::size_t row = 0; row < rows; ++row)
    log_.time.push_back(static_cast<double>(row) * 0.004);
  for (auto& column : log_.column) {
    std::vector<float> longer;
    for (std::size_t row = 0; row < rows; ++row) longer.push_back(column[row % column.size()]);
    column = std::move(longer);
  }
  for (int joint = 0; joint < 60; ++joint) {  // as many curves as a robot of Hume's size has
    add(
        "joint.j" + std::to_string(joint) + ".torque", [](double t) { return std::sin(40 * t); },
        "Nm");
  }
  for (const bool is_static : {false, true}) {
    options_.static_plots = is_static;
    EXPECT_LT(report_html(log_, options_).size(), 5'000'000U);
  }
}

TEST_F(Report, ThinningKeepsEveryPeak) {
  std::vector<float> column(log_.rows(), 0.0F);
  column[1234] = 7.0F;
  column[1235] = -8.0F;
  const Grid grid(log_, 0, log_.rows(), 100);
  const std::vector<float> thin = grid.thin(column, 2.0);
  ASSERT_EQ(thin.size(), grid.time().size());
  EXPECT_LE(thin.size(), 100U);
  EXPECT_EQ(*std::max_element(thin.begin(), thin.end()), 14.0F);
  EXPECT_EQ(*std::min_element(thin.begin(), thin.end()), -16.0F);
  EXPECT_TRUE(std::is_sorted(grid.time().begin(), grid.time().end()));
}

TEST_F(Report, BothImagesOfAMirrorShareTheirBand) {
  const StateBands bands = state_bands(log_);
  EXPECT_EQ(bands.names, (std::vector<std::string>{"lift", "land"}));
  ASSERT_GE(bands.intervals.size(), 3U);
  EXPECT_DOUBLE_EQ(bands.intervals[0].begin, 0.0);
  EXPECT_NEAR(bands.intervals[0].end, 0.25, 0.005);  // one row of 4 ms
}

TEST_F(Report, StepsAreFoundBySupportAndContact) {
  const std::vector<SupportPhase> phases = single_support(log_);
  EXPECT_EQ(phases.size(), 20U);
  EXPECT_EQ(phases[0].foot, "right_foot");
  EXPECT_EQ(phases[1].foot, "left_foot");
  const std::vector<Touchdown> touches = touchdowns(log_);
  EXPECT_EQ(touches.size(), 19U);  // every half second from 0.5 s on a foot comes down
  EXPECT_NEAR(touches[0].time, 0.5, 0.005);
  EXPECT_TRUE(touches[0].planned);
}

TEST(ReportPlot, TicksAreRoundNumbersInTheRange) {
  EXPECT_EQ(ticks(0.0, 10.0, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(ticks(-0.12, 0.13, 5), (std::vector<double>{-0.1, -0.05, 0, 0.05, 0.1}));
  EXPECT_EQ(ticks(3.0, 3.0, 5).size(), 1U);
}

TEST(ReportPlot, Base64IsThatOfRfc4648) {
  EXPECT_EQ(base64("foobar", 6), "Zm9vYmFy");
  EXPECT_EQ(base64("fooba", 5), "Zm9vYmE=");
  EXPECT_EQ(base64("foob", 4), "Zm9vYg==");
  EXPECT_EQ(base64("", 0), "");
}

}  // namespace
}  // namespace footfall::lab
