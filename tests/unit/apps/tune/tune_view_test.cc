// Keys of the full screen, the requests that come of them, and the picture.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/tune/view/layout.h"
#include "apps/tune/view/pages.h"
#include "apps/tune/view/view.h"
#include "tests/unit/apps/tune/tune_test_support.h"

namespace footfall::apps {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

struct Desk {
  TuneModel model = small_model();
  TuneView view;
  TuneOutbox outbox;

  TuneCommand type(const std::string& letters) {
    TuneCommand last = TuneCommand::none;
    for (const char c : letters)
      last = press(view, model, outbox, {TuneKey::text, std::string(1, c)});
    return last;
  }
  TuneCommand hit(TuneKey::Code code) { return press(view, model, outbox, {code, {}}); }
  std::string picture(int width, int height, bool unicode = true) {
    std::string text;
    for (const StyledLine& line :
         draw(model, view, outbox, {0.0, {}, unicode}, width, height).lines) {
      text += plain_text(line) + "\n";
    }
    return text;
  }
};

footfall_lcm::answer_t answer_to(bool accepted, std::int64_t revision,
                                 std::vector<std::string> reasons = {}) {
  footfall_lcm::answer_t answer{};
  answer.accepted = accepted ? 1 : 0;
  answer.revision = revision;
  answer.reasons = std::move(reasons);
  return answer;
}

TEST(TuneView, KeysStepTheSelectedValueAndGatherInOneRequest) {
  Desk desk;
  desk.hit(TuneKey::down);
  desk.hit(TuneKey::down);  // goal.x, goal.y, lift_time
  desk.type("++>-,");       // 5 ms each: 5 + 5 + 50 - 5 - 0.5
  const auto request = desk.outbox.next(desk.model);
  ASSERT_TRUE(request);
  ASSERT_EQ(request->changes.size(), 1U);
  EXPECT_EQ(request->changes[0].name, "lift_time");
  EXPECT_THAT(request->changes[0].values, ElementsAre(0.1995));
  EXPECT_EQ(request->revision, 0);
  EXPECT_FALSE(desk.outbox.next(desk.model)) << "one request at a time";
}

TEST(TuneView, StepsEndAtTheRange) {
  Desk desk;
  desk.type("/lift");
  desk.hit(TuneKey::enter);
  desk.type(">>>>>>>>");
  EXPECT_EQ(desk.outbox.expected(desk.model, 2), 0.4);
  desk.type("+");
  EXPECT_THAT(desk.view.message, HasSubstr("end of its range, 80 to 400 ms"));
}

TEST(TuneView, ATypedValueReplacesWhatIsThere) {
  Desk desk;
  desk.type("/lift");
  desk.hit(TuneKey::enter);
  desk.type("=");
  EXPECT_EQ(desk.view.typed, "145 ms");
  for (int k = 0; k < 6; ++k) desk.hit(TuneKey::backspace);
  desk.type("3 N");
  desk.hit(TuneKey::enter);
  EXPECT_THAT(desk.view.message, HasSubstr("expected a time, got '3 N'"));
  for (int k = 0; k < 3; ++k) desk.hit(TuneKey::backspace);
  desk.type("0.16");
  desk.hit(TuneKey::enter);
  const auto request = desk.outbox.next(desk.model);
  ASSERT_TRUE(request);
  EXPECT_THAT(request->changes[0].values, ElementsAre(0.16));
}

TEST(TuneView, SeveralValuesAreTypedAsOneRequest) {
  Desk desk;
  desk.type(":lift_time=160 ms goal=1 m, 2 m");
  desk.hit(TuneKey::enter);
  const auto request = desk.outbox.next(desk.model);
  ASSERT_TRUE(request);
  ASSERT_EQ(request->changes.size(), 2U);
  EXPECT_THAT(request->changes[0].values, ElementsAre(0.16));
  EXPECT_THAT(request->changes[1].values, ElementsAre(1.0, 2.0));
}

TEST(TuneView, ChangesByKeysTakeTheChosenTime) {
  Desk desk;
  desk.type("o");
  for (int k = 0; k < 6; ++k) desk.hit(TuneKey::backspace);
  desk.type("0.5 s");
  desk.hit(TuneKey::enter);
  desk.type("+");
  EXPECT_EQ(desk.outbox.next(desk.model)->over, 0.5);
}

TEST(TuneView, FilterSignalsEventsUndoAndSave) {
  Desk desk;
  desk.type("/kp");
  EXPECT_EQ(shown_entries(desk.model, desk.view).size(), 3U);
  desk.hit(TuneKey::escape);
  EXPECT_EQ(shown_entries(desk.model, desk.view).size(), 6U);
  desk.type("pheight");
  desk.hit(TuneKey::enter);
  EXPECT_EQ(desk.view.signal, "task.height.error");
  desk.type("e");
  desk.hit(TuneKey::enter);
  EXPECT_THAT(desk.outbox.next(desk.model)->events, ElementsAre("start"));
  desk.outbox.answered(answer_to(true, 1));
  take_values(desk.model, values_with(desk.model, 0, 0.145, 1));
  desk.type("u");
  EXPECT_EQ(desk.outbox.next(desk.model)->what, footfall_lcm::request_t::UNDO);
  EXPECT_EQ(desk.type("s"), TuneCommand::preview_save);
  EXPECT_EQ(desk.type("c"), TuneCommand::compare);
  EXPECT_EQ(desk.type("q"), TuneCommand::quit);
}

TEST(TuneView, NothingIsWrittenWithoutAYes) {
  Desk desk;
  show_page(desk.view, "save", diff_lines("-a\n+b\n"));
  desk.view.mode = TuneMode::confirm;
  EXPECT_EQ(desk.hit(TuneKey::enter), TuneCommand::none);
  EXPECT_EQ(desk.view.message, "nothing was written");
  desk.view.mode = TuneMode::confirm;
  EXPECT_EQ(desk.type("y"), TuneCommand::write);
  desk.view.mode = TuneMode::confirm;
  desk.type("omine.yaml");
  EXPECT_EQ(desk.hit(TuneKey::enter), TuneCommand::preview_save);
  EXPECT_EQ(desk.view.overlay, "mine.yaml");
}

TEST(TuneOutbox, WaitsForTheValuesThatItsAnswerMade) {
  Desk desk;
  desk.type("/lift");
  desk.hit(TuneKey::enter);
  desk.type("+");
  ASSERT_TRUE(desk.outbox.next(desk.model));
  desk.type("+");
  desk.outbox.answered(answer_to(true, 1));
  EXPECT_FALSE(desk.outbox.next(desk.model)) << "the values are those of revision 0";
  take_values(desk.model, values_with(desk.model, 0, 0.15, 1));
  const auto request = desk.outbox.next(desk.model);
  ASSERT_TRUE(request);
  EXPECT_EQ(request->revision, 1);
  EXPECT_THAT(request->changes[0].values, ElementsAre(0.155));
}

TEST(TuneOutbox, SomebodysEditOfAnotherValueIsNoHindrance) {
  Desk desk;
  desk.outbox.want(desk.model, 2, 0.15, 0.0);
  ASSERT_TRUE(desk.outbox.next(desk.model));
  desk.outbox.answered(answer_to(false, 1, {"revision 0 was expected, 1 is in force"}));
  take_values(desk.model, values_with(desk.model, 3, 230.0, 1));
  const auto again = desk.outbox.next(desk.model);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->revision, 1);
  EXPECT_THAT(again->changes[0].values, ElementsAre(0.15));
  EXPECT_THAT(desk.outbox.take_problems(), ElementsAre());
}

TEST(TuneOutbox, SomebodysEditOfTheSameValueIsNotOverwritten) {
  Desk desk;
  desk.outbox.want(desk.model, 2, 0.15, 0.0);
  ASSERT_TRUE(desk.outbox.next(desk.model));
  desk.outbox.answered(answer_to(false, 1, {"revision 0 was expected, 1 is in force"}));
  take_values(desk.model, values_with(desk.model, 0, 0.2, 1));
  EXPECT_FALSE(desk.outbox.next(desk.model));
  EXPECT_THAT(desk.outbox.take_problems(),
              ElementsAre("lift_time was changed meanwhile, to 200 ms: look again"));
  EXPECT_TRUE(desk.outbox.empty());
}

TEST(TuneOutbox, ARefusalIsSaidAndDropsWhatBuildsOnIt) {
  Desk desk;
  desk.outbox.want(desk.model, 2, 0.15, 0.0);
  ASSERT_TRUE(desk.outbox.next(desk.model));
  desk.outbox.want(desk.model, 2, 0.155, 0.0);
  desk.outbox.answered(answer_to(false, 0, {"no"}));
  EXPECT_THAT(desk.outbox.take_problems(), ElementsAre("no"));
  EXPECT_TRUE(desk.outbox.empty());
  EXPECT_EQ(desk.outbox.expected(desk.model, 2), 0.145);
}

TEST(TunePicture, TextIsFittedByColumnsAndShowsNoControls) {
  EXPECT_EQ(fitted("abc", 5), "abc  ");
  EXPECT_EQ(fitted("abcdef", 4), "abc~");
  EXPECT_EQ(fitted_right("abc", 5), "  abc");
  EXPECT_EQ(fitted("a\033[2Jb\xff", 8), "a?[2Jb? ");
  EXPECT_EQ(text_columns("µs"), 2);
  EXPECT_EQ(fitted("µs\xc2\x9b", 4), "µs? ");
}

TEST(TuneLayout, EveryLineHasTheWindowsWidthAtEverySize) {
  Desk desk;
  for (int k = 0; k < 50; ++k)
    take_telemetry(desk.model, told_telemetry(0.02 * k, 0.9F + 0.001F * static_cast<float>(k)));
  for (const TuneMode mode :
       {TuneMode::list, TuneMode::choice, TuneMode::page, TuneMode::confirm, TuneMode::prompt}) {
    desk.view.mode = mode;
    desk.view.page = help_lines();
    for (int width = 1; width <= 200; width += 7) {
      for (int height = 1; height <= 60; height += 3) {
        const Picture picture = draw(desk.model, desk.view, desk.outbox, {}, width, height);
        ASSERT_EQ(static_cast<int>(picture.lines.size()), height) << width << " x " << height;
        for (const StyledLine& line : picture.lines) {
          ASSERT_EQ(text_columns(plain_text(line)), width) << height << ": " << plain_text(line);
        }
      }
    }
  }
}

TEST(TuneLayout, ShowsHowTheRobotDoesAndTheSelectedValue) {
  Desk desk;
  take_telemetry(desk.model, told_telemetry(12.5, 0.9F));
  desk.view.signal = "com.pos.z";
  desk.hit(TuneKey::down);
  desk.hit(TuneKey::down);
  const std::string text = desk.picture(80, 24);
  for (const char* part :
       {"balance on hume", "12.5 s  running", "step.right_foot.lift", "step 14", "262 N",
        "height 2.1 mm (43 % left)", "torque.limit 3", "> lift_time", "145 ms",
        "80 to 400 ms, step 5 ms: doc of lift_time", "com.pos.z  0.9 m", "? help", "q quit"}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
  EXPECT_THAT(desk.picture(140, 40), HasSubstr("> lift_time"));
}

TEST(TuneLayout, WithoutUnicodeEverySignIsAscii) {
  Desk desk;
  for (int k = 0; k < 50; ++k)
    take_telemetry(desk.model, told_telemetry(0.02 * k, static_cast<float>(k)));
  desk.view.signal = "com.pos.z";
  for (const char c : desk.picture(140, 40, false)) {
    ASSERT_TRUE(c == '\n' || (c >= ' ' && c < 127));
  }
}

TEST(TuneLayout, NamesThatAreTooLongKeepTheirEnds) {
  const std::string pitch = fitted_name("gains.dual.attitude.kd.pitch", 24);
  EXPECT_THAT(pitch, testing::EndsWith(".kd.pitch"));
  EXPECT_EQ(text_columns(pitch), 24);
  EXPECT_NE(pitch, fitted_name("gains.dual.attitude.kd.roll", 24));
  EXPECT_NE(pitch, fitted_name("gains.single.attitude.kd.pitch", 24));
  EXPECT_EQ(fitted_name("lift_time", 12), "lift_time   ");
}

TEST(TuneLayout, ASmallWindowSaysSo) {
  Desk desk;
  EXPECT_THAT(desk.picture(59, 24), HasSubstr("60 x 16 is needed"));
}

TEST(TuneLayout, TheSelectedRowIsAlwaysInSight) {
  Desk desk;
  for (int k = 0; k < 6; ++k) {
    EXPECT_THAT(desk.picture(60, 16),
                HasSubstr("> " + desk.model.entries[static_cast<std::size_t>(k)].name))
        << k;
    desk.hit(TuneKey::down);
  }
}

}  // namespace
}  // namespace footfall::apps
