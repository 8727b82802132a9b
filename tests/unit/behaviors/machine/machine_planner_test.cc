// invoke: when planners are asked, what their answers do, and what happens when they are late.
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

std::string asking(const std::string& invoke) {
  return "behavior: 1\nrobot: hume\nevents: {leave: x}\n"
         "planners: {foot: {type: velocity_reversal, kappa: 0.4, reversal: 185 ms, goal: [0.5 m, "
         "-0.2 "
         "m]}}\n"
         "machine:\n  states:\n    a:\n      after: 100 ms\n      to: b\n"
         "      transitions: [{on: leave, to: b}, {on: planner.foot.done, do: [{mark: done}]},"
         " {on: planner.foot.late, do: [{mark: late}]}, {on: planner.foot.failed, do: [{mark: "
         "failed}]}]\n"
         "      invoke: [{planner: foot, " +
         invoke +
         ", with: {stance: right_foot, swing: left_foot, switch_in: \"= 200 ms - t\"}}]\n    b: "
         "{}\n";
}

// A robot that stands with its left foot 0.2 m to the left, its centre of mass at 0.91 m.
class Planner : public testing::Test {
 protected:
  void begin(const std::string& invoke) {
    run = std::make_unique<Runner>(load(asking(invoke)));
    run->signal("com.pos.z") = 0.91;
    run->signal("com.pos.y") = 0.1;
    run->signal("point.left_foot.y") = 0.2;
    run->start();
  }
  std::string marks() const {
    std::string names;
    for (const int m : run->machine.marks())
      names += run->behavior->marks[static_cast<std::size_t>(m)];
    return names;
  }
  // The law itself on the robot above, `ticks` after the state began.
  behaviors::FootPlan closed_form(int ticks) const {
    behaviors::FootPlannerInput input;
    input.com = {0.0, 0.1};
    input.com_height = 0.91;
    input.switch_in = 0.2 - ticks / 1500.0;
    input.swing_side = 1.0;
    input.goal = {0.5, -0.2};
    return behaviors::plan_foot(run->behavior->planners[0].spec, input);
  }
  static behaviors::PlanAnswer answer(const behaviors::PlanRequest& request, double x = 0.3) {
    return {request.planner, request.sequence, true, {x, 0.2, 0.01}, {0.1, 0.2}, {0.3, 0.4}, 0.0};
  }
  std::unique_ptr<Runner> run;
};

TEST_F(Planner, IsAskedOnceAtItsPartOfTheState) {
  begin("at: 70 %");
  run->run_to(104);  // 70 ms are 105 periods
  EXPECT_TRUE(run->machine.plan_requests().empty());
  run->tick();
  ASSERT_EQ(run->machine.plan_requests().size(), 1u);
  const auto request = run->machine.plan_requests()[0];
  EXPECT_EQ(request.stance, run->behavior->robot.find_contact("right_foot"));
  EXPECT_EQ(request.swing, run->behavior->robot.find_contact("left_foot"));
  EXPECT_NEAR(request.switch_in, 0.13, 1e-12);
  for (int k = 0; k < 40; ++k) {
    run->tick();
    EXPECT_TRUE(run->machine.plan_requests().empty());
  }
}
TEST_F(Planner, AnAnswerFindsItsRequestHoweverManyWereMadeAfterIt) {
  begin("at: 0 s, every: 0.1 ms");  // in every tick
  run->tick();
  ASSERT_EQ(run->machine.plan_requests().size(), 1u);
  const auto first = run->machine.plan_requests()[0];
  for (int k = 0; k < 100; ++k) run->tick();  // of 150 in the state
  const auto later = run->machine.plan_requests()[0];
  run->machine.deliver(answer(first, 0.25));
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.25);
  run->machine.deliver(answer(later, 0.5));
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.5);
  run->machine.deliver(answer(first, 0.1));  // answered already
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.5);
}
TEST_F(Planner, IsAskedAgainAndAgainWithEvery) {
  begin("at: 10 ms, every: 20 ms");
  std::vector<std::int64_t> asked;
  for (int k = 0; k < 100; ++k) {
    run->tick();
    if (!run->machine.plan_requests().empty()) asked.push_back(run->now - 1);
  }
  EXPECT_EQ(asked, (std::vector<std::int64_t>{15, 45, 75}));
}
TEST_F(Planner, AnAnswerIsWrittenAndIsAnEvent) {
  begin("at: 10 ms");
  run->run_to(15);
  const auto request = run->machine.plan_requests()[0];
  run->machine.deliver(answer(request));
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.3);
  EXPECT_EQ(run->signal("planner.foot.target.z"), 0.01);
  EXPECT_EQ(run->signal("planner.foot.predicted_vel.y"), 0.4);
  EXPECT_NEAR(run->signal("planner.foot.switch_time"), 0.2, 1e-12);
  run->tick();
  EXPECT_EQ(marks(), "done");
}
TEST_F(Planner, AnExitCancelsWhatIsUnderWay) {
  begin("at: 10 ms");
  run->run_to(15);
  const auto request = run->machine.plan_requests()[0];
  run->machine.raise(run->behavior->find_event("leave"));
  run->tick();
  run->machine.deliver(answer(request));
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.0);
}
TEST_F(Planner, AnswersToOlderRequestsCountUntilANewerOneCame) {
  begin("at: 0 ms, every: 10 ms");
  run->run_to(0);
  const auto first = run->machine.plan_requests()[0];
  run->run_to(15);
  const auto second = run->machine.plan_requests()[0];
  run->machine.deliver(answer(first, 0.1));
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.1);
  run->machine.deliver(answer(second, 0.2));
  run->machine.deliver(answer(first, 0.7));
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.2);
}
TEST_F(Planner, ALateAnswerIsReplacedByTheClosedForm) {
  begin("at: 10 ms, deadline: 20 ms, on_late: closed_form");
  run->run_to(15);
  const auto request = run->machine.plan_requests()[0];
  run->run_to(44);
  EXPECT_EQ(run->signal("planner.foot.late"), 0.0);
  run->tick();  // 30 periods after the request
  EXPECT_EQ(run->signal("planner.foot.late"), 1.0);
  const behaviors::FootPlan plan = closed_form(45);
  EXPECT_NEAR(run->signal("planner.foot.target.x"), plan.target[0], 1e-12);
  EXPECT_NEAR(run->signal("planner.foot.target.y"), plan.target[1], 1e-12);
  EXPECT_EQ(run->machine.faults().of(core::Fault::planner_late), 1);
  run->machine.deliver(answer(request));  // too late
  EXPECT_NEAR(run->signal("planner.foot.target.x"), plan.target[0], 1e-12);
  run->tick();
  EXPECT_EQ(marks(), "late");
}
TEST_F(Planner, ALateAnswerMayLeaveTheLastPlan) {
  begin("at: 10 ms, deadline: 20 ms, on_late: keep_last");
  run->run_to(45);
  EXPECT_EQ(run->signal("planner.foot.late"), 1.0);
  EXPECT_EQ(run->signal("planner.foot.target.y"), 0.0);
}
TEST_F(Planner, AnExitWithoutAnAnswerTakesTheClosedForm) {
  begin("at: 10 ms, deadline: 90 ms, on_late: closed_form");
  run->run_to(15);
  run->machine.raise(run->behavior->find_event("leave"));
  run->tick();
  const behaviors::FootPlan plan = closed_form(16);
  EXPECT_NEAR(run->signal("planner.foot.target.x"), plan.target[0], 1e-12);
  EXPECT_NEAR(run->signal("planner.foot.target.y"), plan.target[1], 1e-12);
}
TEST_F(Planner, AFailedAnswerChangesNothingAndIsAnEvent) {
  begin("at: 10 ms");
  run->run_to(15);
  auto failed = answer(run->machine.plan_requests()[0]);
  failed.ok = false;
  run->machine.deliver(failed);
  EXPECT_EQ(run->signal("planner.foot.target.x"), 0.0);
  run->tick();
  EXPECT_EQ(marks(), "failed");
}

}  // namespace
}  // namespace footfall::tests
