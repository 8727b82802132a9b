// What a person who tunes sees and asks for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/tune/model/model.h"
#include "apps/tune/view/tables.h"
#include "tests/unit/apps/tune/tune_test_support.h"

namespace footfall::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> entry_names(const TuneModel& model) {
  std::vector<std::string> names;
  for (const TuneEntry& entry : model.entries) names.push_back(entry.name);
  return names;
}

TEST(TuneModel, ListsParametersBeforeGainsByNameWithTheirComponents) {
  EXPECT_THAT(entry_names(small_model()),
              ElementsAre("goal.x", "goal.y", "lift_time", "gains.single.swing.kp.pitch",
                          "gains.single.swing.kp.roll", "gains.single.swing.kp.yaw"));
}

TEST(TuneModel, ACatalogueThatPointsOutsideItsValuesIsNotBelieved) {
  footfall_lcm::catalogue_t told = small_catalogue();
  told.parameters[0].first = 2147483647;
  told.parameters[1].first = -1;
  told.parameters[2].size = 0;
  TuneModel model;
  take_catalogue(model, told);
  EXPECT_TRUE(model.parameters.empty());
}

TEST(TuneModel, ValuesOfAnotherRunOrLengthAreLeftOut) {
  TuneModel model = small_model();
  footfall_lcm::values_t other = values_with(model, 0, 0.2, 3);
  other.session = 8;
  take_values(model, other);
  other = values_with(model, 0, 0.2, 3);
  other.now.pop_back();
  take_values(model, other);
  EXPECT_EQ(model.value_now(0), 0.145);
  take_values(model, values_with(model, 0, 0.2, 3));
  EXPECT_EQ(model.value_now(0), 0.2);
  EXPECT_EQ(model.values.revision, 3);
}

TEST(TuneModel, AnotherRunBeginsAnew) {
  TuneModel model = small_model();
  take_telemetry(model, told_telemetry(1.0, 0.9F));
  ASSERT_EQ(model.history.size(), 1U);
  footfall_lcm::catalogue_t told = small_catalogue();
  told.session = 9;
  told.values[0] = 0.2;
  take_catalogue(model, told);
  EXPECT_EQ(model.history.size(), 0U);
  EXPECT_EQ(model.value_now(0), 0.2);
  EXPECT_EQ(model.value_of_file(0), 0.2);
}

TEST(TuneModel, FiltersByPartOrPattern) {
  EXPECT_TRUE(passes_filter("gains.single.swing.kp", "swing"));
  EXPECT_TRUE(passes_filter("gains.single.swing.kp", "gains.*.kp"));
  EXPECT_FALSE(passes_filter("gains.single.swing.kp", "*.kd"));
  EXPECT_TRUE(passes_filter("anything", ""));
}

TEST(TuneModel, ReadsChangesOfWholesAndParts) {
  std::vector<std::string> problems;
  const auto changes = read_changes(
      small_model(),
      {"lift_time=150ms", "goal.y=20 cm", "gains.single.swing.kp[1]=240", "goal=[1 m, 1 m]",
       "gains.single.swing.kp=300", "gains.single.swing.kp.roll=210"},
      problems);
  EXPECT_THAT(problems, ElementsAre());
  ASSERT_EQ(changes.size(), 6U);
  EXPECT_EQ(changes[0].name, "lift_time");
  EXPECT_EQ(changes[0].component, -1);
  EXPECT_THAT(changes[0].values, ElementsAre(0.15));
  EXPECT_EQ(changes[1].name, "goal");
  EXPECT_EQ(changes[1].component, 1);
  EXPECT_THAT(changes[1].values, ElementsAre(0.2));
  EXPECT_EQ(changes[2].component, 1);
  EXPECT_THAT(changes[3].values, ElementsAre(1.0, 1.0));
  EXPECT_EQ(changes[3].count, 2);
  EXPECT_THAT(changes[4].values, ElementsAre(300.0, 300.0, 300.0));
  EXPECT_EQ(changes[5].component, 1);
}

TEST(TuneModel, OneNumberForAPositionOfSeveralIsRefusedWithTheFormThatIsNeeded) {
  std::vector<std::string> problems;
  read_changes(small_model(), {"goal=1m"}, problems);
  EXPECT_THAT(problems, ElementsAre("goal: expected 2 values, got one: goal.x=1m sets one, "
                                    "\"goal=[...]\" all"));
}

TEST(TuneModel, AParameterThatIsNotLiveIsNotUnknown) {
  std::vector<std::string> problems;
  read_changes(small_model(), {"clearance=9cm", "clearance.x=9cm"}, problems);
  EXPECT_THAT(problems, ElementsAre("'clearance' is not live, because the file says so",
                                    "'clearance.x' is not live, because the file says so"));
  std::string problem;
  EXPECT_TRUE(find_parameters(small_model(), "clearance", problem).empty());
  EXPECT_EQ(problem, "'clearance' is not live, because the file says so");
}

TEST(TuneModel, SaysEveryProblemOfChanges) {
  std::vector<std::string> problems;
  read_changes(small_model(),
               {"lift_tine=150ms", "lift_time", "lift_time=3 N", "goal.z=1", "goal=1,2,3",
                "gains.single.swing.kp[9]=1"},
               problems);
  EXPECT_THAT(problems, ElementsAre("unknown parameter 'lift_tine' (did you mean 'lift_time'?)",
                                    "expected NAME=VALUE, got 'lift_time'",
                                    "lift_time: expected a time, got '3 N'",
                                    "goal.z: it has 2 values", "goal: expected 2 values, got 3",
                                    "gains.single.swing.kp[9]: it has 3 values"));
}

TEST(TuneModel, TellsADecimalCommaAndAnArgumentThatTheShellHasSplit) {
  std::vector<std::string> problems;
  read_changes(small_model(), {"lift_time=150", "ms", "lift_time=0,15s"}, problems);
  EXPECT_THAT(problems,
              ElementsAre("expected NAME=VALUE, got 'ms': quote it: \"lift_time=150 ms\"",
                          "lift_time: expected a time, got '0,15s': a decimal point, not a comma: "
                          "'0.15s'"));
}

TEST(TuneModel, AnswersAreNotedWithWhoAskedAndWhatCameOfIt) {
  TuneModel model = small_model();
  footfall_lcm::answer_t answer{};
  answer.session = 7;
  answer.client = 5;
  answer.who = "ann@bench";
  answer.accepted = 1;
  answer.tick = 2500;
  answer.text = "lift_time = 150 ms";
  take_answer(model, answer, 5);
  answer.client = 6;
  answer.accepted = 0;
  answer.tick = -1;
  answer.reasons = {"lift_time: 3 s is out of its range"};
  take_answer(model, answer, 5);
  answer.session = 8;
  take_answer(model, answer, 5);
  ASSERT_EQ(model.notes.size(), 2U);
  EXPECT_EQ(model.notes[0].time, 2.5);
  EXPECT_TRUE(model.notes[0].own);
  EXPECT_FALSE(model.notes[1].own);
  EXPECT_THAT(model.notes[1].text, HasSubstr("refused: lift_time: 3 s is out of its range"));
}

TEST(TuneModel, WhatGetPrintsIsTakenBackBySet) {
  TuneModel model = small_model();
  take_values(model, values_with(model, 0, 1.0 / 7.0, 1));
  const std::string text = get_text(model, {0, 1, 2});
  std::vector<std::string> lines, problems;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = text.find('\n', begin);
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  EXPECT_THAT(lines, ElementsAre("goal=[0, 0] m", testing::StartsWith("lift_time=142.85714285714"),
                                 "gains.single.swing.kp=[220, 237, 400] 1/s^2"));
  const auto changes = read_changes(model, lines, problems);
  EXPECT_THAT(problems, ElementsAre());
  EXPECT_THAT(changes[1].values, ElementsAre(1.0 / 7.0));
}

TEST(TuneModel, TheDifferenceToTheFileIsGoneWhenTheFileHasIt) {
  TuneModel model = small_model();
  take_values(model, values_with(model, 0, 0.15, 1));
  EXPECT_EQ(difference_text(model, {0, 1, 2}), "lift_time  145 ms  -> 150 ms\n");
  EXPECT_THAT(list_text(model, {1}), HasSubstr("150 ms  file 145 ms  range 80 to 400 ms"));
  ASSERT_EQ(changes_to_file(model).size(), 1U);
  take_file_values(model, model.values.now);
  EXPECT_EQ(difference_text(model, {0, 1, 2}), "");
}

TEST(TuneModel, JsonHasSiValuesAndNullWithoutRange) {
  footfall_lcm::catalogue_t told = small_catalogue();
  told.parameters[1].has_range = 0;
  TuneModel model;
  take_catalogue(model, told);
  const auto json = list_json(model, {1, 2});
  EXPECT_EQ(json["parameters"][0]["value"], 0.145);
  EXPECT_TRUE(json["parameters"][0]["max"].is_null());
  EXPECT_EQ(json["parameters"][1]["target"], (std::vector{220.0, 237.0, 400.0}));
}

TEST(TuneModel, WatchesSignalsAndValuesByNameAndPattern) {
  TuneModel model = small_model();
  take_telemetry(model, told_telemetry(1.5, 0.9F));
  std::vector<std::string> problems;
  const auto columns = watch_columns(model, {"com.*", "goal", "com.pos.zz"}, problems);
  EXPECT_THAT(problems, ElementsAre(HasSubstr("did you mean 'com.pos.z'?")));
  ASSERT_EQ(columns.size(), 3U);
  EXPECT_EQ(watch_head(columns), "  time (s)  com.pos.z (m)  goal.x (m)  goal.y (m)  state\n");
  EXPECT_EQ(watch_line(model, columns),
            "     1.500            0.9           0           0  step.right_foot.lift\n");
  EXPECT_EQ(watch_json(model, columns)["states"][0], "step.right_foot.lift");
}

TEST(TuneModel, AValueIsShownOnlyBesideATickInWhichItHeld) {
  TuneModel model = small_model();
  std::vector<std::string> problems;
  const auto columns = watch_columns(model, {"goal.x"}, problems);
  const auto row = [&](std::int64_t tick, std::int64_t revision) {
    auto told = told_telemetry(1e-3 * static_cast<double>(tick), 0.9F);
    told.revision = revision;
    take_telemetry(model, told);
    return watch_json(model, columns)["goal.x"];
  };
  auto values = values_with(model, 1, 0.5, 3);
  values.tick = 1000;
  values.target[1] = 2.0;
  take_values(model, values);
  EXPECT_EQ(row(1000, 3), 0.5);
  EXPECT_TRUE(row(999, 3).is_null()) << "earlier than the values";
  EXPECT_TRUE(row(1020, 3).is_null()) << "it moves";
  values.now[1] = 2.0;
  take_values(model, values);
  EXPECT_EQ(row(1020, 3), 2.0) << "at rest since";
  EXPECT_TRUE(row(1020, 4).is_null()) << "an edit came between";
}

TEST(TuneModel, AParameterThatIsASignalTooIsWatchedOnce) {
  footfall_lcm::catalogue_t told = small_catalogue();
  told.signals.push_back("goal.x");
  told.signal_units.push_back("m");
  TuneModel model;
  take_catalogue(model, told);
  std::vector<std::string> problems;
  EXPECT_EQ(watch_columns(model, {"goal.x"}, problems).size(), 1U);
  EXPECT_EQ(watch_columns(model, {"goal.*"}, problems).size(), 2U);
  EXPECT_THAT(problems, ElementsAre());
}

TEST(TuneModel, NamesFromTheNetworkShowNoControlCharacters) {
  footfall_lcm::catalogue_t told = small_catalogue();
  told.parameters[0].doc = "a\nb\033[2J";
  TuneModel model;
  take_catalogue(model, told);
  for (const char c : list_text(model, {2})) EXPECT_TRUE(c >= ' ' || c == '\n');
  EXPECT_THAT(list_text(model, {2}), testing::EndsWith("\n"));
  EXPECT_THAT(list_text(model, {2}), Not(HasSubstr("a\nb")));
}

TEST(SignalHistory, KeepsTheNewestRowsInOrder) {
  SignalHistory history;
  history.reset(2, 3);
  for (int k = 0; k < 5; ++k) {
    const float value = static_cast<float>(k);
    history.add(k, std::array{value, 10.0F * value});
  }
  history.add(9.0, std::array{1.0F});  // of another length
  ASSERT_EQ(history.size(), 3U);
  EXPECT_EQ(history.time(0), 2.0);
  EXPECT_EQ(history.value(2, 1), 40.0F);
  history.add(0.5, std::array{1.0F, 2.0F});  // another run
  EXPECT_EQ(history.size(), 1U);
}

TEST(SignalHistory, AStraightLineIsPlottedFromCornerToCorner) {
  SignalHistory history;
  history.reset(1, 100);
  for (int k = 0; k <= 10; ++k) history.add(0.1 * k, std::array{static_cast<float>(k)});
  const TextPlot plot = plot_signal(history, 0, 1.01, 6, 6, false);
  ASSERT_EQ(plot.rows.size(), 6U);
  EXPECT_EQ(plot.low, 0.0);
  EXPECT_EQ(plot.high, 10.0);
  EXPECT_EQ(plot.rows[0].back(), '*');
  EXPECT_EQ(plot.rows[5].front(), '*');
  EXPECT_EQ(plot.rows[0].front(), ' ');
  for (std::size_t column = 0; column < 6; ++column) {
    int marks = 0;
    for (const std::string& row : plot.rows) marks += row[column] == '*' ? 1 : 0;
    EXPECT_GT(marks, 0) << "a gap in column " << column;
  }
}

TEST(SignalHistory, AnEmptyOrUndefinedSignalGivesAnEmptyPlot) {
  SignalHistory history;
  history.reset(1, 10);
  EXPECT_TRUE(plot_signal(history, 0, 1.0, 4, 2, true).empty);
  history.add(0.0, std::array{NAN});
  EXPECT_TRUE(plot_signal(history, 0, 1.0, 4, 2, true).empty);
  history.add(0.1, std::array{5.0F});
  const TextPlot plot = plot_signal(history, 0, 1.0, 4, 2, true);
  EXPECT_FALSE(plot.empty);
  EXPECT_EQ(plot.low, plot.high);
}

}  // namespace
}  // namespace footfall::apps
