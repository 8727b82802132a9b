// Scenario files: a whole one becomes what it says, and each mistake is found at its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/index.h"
#include "lab/scenario/loader.h"

namespace footfall::lab {
namespace {

// Balancing that hears two events from outside.
const std::string kBehavior = "base: " + std::filesystem::absolute(FOOTFALL_SOURCE_DIR).string() +
                              "/behaviors/library/balance.yaml\n"
                              "events: {go_to: \"a new goal\", tapped: \"a foot came down\"}\n";

constexpr std::string_view kScenario = R"(scenario: 1
behavior: walk.yaml
robot: hume
world: lab
seeds: 100..119
for: 120 s
script:
  - {at: 3 s, push: {body: torso, force: 40 N, for: 100 ms, direction: 90 deg}}
  - {at: {step: 8, state: lift, phase: 50 %}, push: {body: torso, force: 30 N, for: 80 ms, direction: 0 deg}}
  - {at: 5 s, edit: {lift_time: 160 ms, gains.single.swing.kp: [230, 240, 410]}, over: 500 ms}
  - {at: 18 s, edit: {goal: [1 m, 0 m]}, raise: go_to}
  - {at: 22 s, fault: mocap.dropout, for: 2 s}
  - {on: contact.left_foot.touchdown, raise: tapped}
expect:
  - steps >= 300
  - {that: "max(abs(base.rpy.pitch)) < 0.05 rad", after: 2 s, in: 95 % of seeds}
  - {that: "rms(task.swing.error) < 2 cm", between: [15 s, 18 s]}
  - {never: in(limp)}
  - {sequence: [step.right_foot.lift, step.right_foot.land, step.left_foot.dual], within: 1 s}
)";

class ScenarioLoader : public testing::Test {
 protected:
  ScenarioLoader()
      : folder_(std::filesystem::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "walk.yaml") << kBehavior;
  }
  ~ScenarioLoader() override { std::filesystem::remove_all(folder_); }

  std::string path(const char* name = "push.yaml") const { return (folder_ / name).string(); }

  ScenarioDescription load(std::string_view text) {
    std::ofstream(path()) << text;
    diagnostics_ = {};
    return load_scenario(path(), {{FOOTFALL_SOURCE_DIR}}, diagnostics_);
  }
  // What is wrong with a scenario that has this line, which is its fourth; without the file's name.
  std::string problems_of(const std::string& line) {
    load("scenario: 1\nbehavior: walk.yaml\nfor: 20 s\n" + line + "\n");
    std::string out = diagnostics_.to_string();
    for (std::size_t i = out.find(path()); i != std::string::npos; i = out.find(path())) {
      out.erase(i, path().size() + 1);
    }
    return out;
  }

  std::filesystem::path folder_;
  core::Diagnostics diagnostics_;
};

std::vector<std::string> paths_of(const ScenarioDescription& scenario,
                                  const std::vector<int>& states) {
  std::vector<std::string> paths;
  for (const int s : states) {
    paths.push_back(scenario.behavior->states[static_cast<std::size_t>(s)].path);
  }
  return paths;
}

TEST_F(ScenarioLoader, AWholeScenarioLoadsClean) {
  const ScenarioDescription scenario = load(kScenario);
  EXPECT_EQ(diagnostics_.to_string(), "");
  ASSERT_NE(scenario.behavior, nullptr);
  EXPECT_EQ(scenario.name, "push");
  EXPECT_EQ(scenario.world, "lab");
  EXPECT_EQ(scenario.world_mark.line, 4);
  EXPECT_EQ(scenario.duration, 120.0);
  ASSERT_EQ(scenario.seeds.size(), 20U);
  EXPECT_EQ(scenario.seeds.front(), 100U);
  EXPECT_EQ(scenario.seeds.back(), 119U);
}
TEST_F(ScenarioLoader, TheScriptSaysWhenAndWhat) {
  const ScenarioDescription scenario = load(kScenario);
  const auto& script = scenario.script;
  ASSERT_EQ(script.size(), 6U);
  EXPECT_EQ(script[0].moment.time, 3.0);
  EXPECT_EQ(script[0].push->body, "torso");
  EXPECT_EQ(script[0].push->force, 40.0);
  EXPECT_EQ(script[0].push->duration, 0.1);
  EXPECT_DOUBLE_EQ(script[0].push->direction, std::numbers::pi / 2.0);
  EXPECT_EQ(script[1].moment.kind, Moment::Kind::place);
  EXPECT_EQ(script[1].moment.step, 8);
  EXPECT_EQ(script[1].moment.phase, 0.5);
  EXPECT_EQ(paths_of(scenario, script[1].moment.states),
            (std::vector<std::string>{"step.right_foot.lift", "step.left_foot.lift"}));
  const auto values_of = [](const std::vector<behaviors::SlotValue>& changes) {
    std::vector<double> values;
    for (const auto& change : changes) values.push_back(change.value);
    return values;
  };
  EXPECT_EQ(values_of(script[2].edit), (std::vector<double>{0.16, 230.0, 240.0, 410.0}));
  EXPECT_EQ(script[2].over, 0.5);
  EXPECT_EQ(values_of(script[3].edit), (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(script[3].raise, scenario.behavior->find_event("go_to"));
  EXPECT_EQ(script[4].fault, InjectedFault::mocap_dropout);
  EXPECT_EQ(script[4].duration, 2.0);
  EXPECT_EQ(script[5].moment.event, "contact.left_foot.touchdown");
}
TEST_F(ScenarioLoader, AnEditMayChangeOneValueOfAParameter) {
  const ScenarioDescription scenario = load(
      "scenario: 1\nbehavior: walk.yaml\nfor: 20 s\n"
      "script: [{at: 1 s, edit: {goal.y: 30 cm, goal: [1 m, 2 m]}}]\n");
  EXPECT_EQ(diagnostics_.to_string(), "");
  const auto& behavior = *scenario.behavior;
  const int goal = behavior.parameters[at(behavior.find_parameter("goal"))].slot;
  EXPECT_EQ(scenario.script.at(0).edit,
            (std::vector<behaviors::SlotValue>{{goal + 1, 0.3}, {goal, 1.0}, {goal + 1, 2.0}}));
}
TEST_F(ScenarioLoader, ExpectationsAreCompiledAgainstTheSignalsOfTheRun) {
  ScenarioDescription scenario = load(kScenario);
  const auto& expectations = scenario.expectations;
  ASSERT_EQ(expectations.size(), 5U);
  EXPECT_EQ(expectations[1].from, 2.0);
  EXPECT_EQ(expectations[1].part, 0.95);
  EXPECT_EQ(expectations[2].to, 18.0);
  EXPECT_EQ(expectations[3].kind, Expectation::Kind::never);
  EXPECT_EQ(paths_of(scenario, expectations[4].states),
            (std::vector<std::string>{"step.right_foot.lift", "step.right_foot.land",
                                      "step.left_foot.dual"}));
  EXPECT_EQ(expectations[4].within, 1.0);
  ASSERT_EQ(scenario.statistics.size(), 2U);
  EXPECT_EQ(scenario.statistics[0].statistic->name, "max");
  EXPECT_TRUE(scenario.statistics[0].magnitude);
  EXPECT_EQ(scenario.signals.info(scenario.statistics[0].signal).name, "base.rpy.pitch");
  behaviors::EvaluationContext context;
  const auto judge = [&](int expectation, int signal, double value) {
    scenario.signals[signal] = value;
    context.signals = scenario.signals.values();
    return behaviors::evaluate(scenario.expressions,
                               expectations[static_cast<std::size_t>(expectation)].expression,
                               context);
  };
  EXPECT_EQ(judge(0, scenario.signals.find("steps"), 299.0), 0.0);
  EXPECT_EQ(judge(0, scenario.signals.find("steps"), 300.0), 1.0);
  EXPECT_EQ(judge(1, scenario.statistics[0].value, 0.04), 1.0);
  EXPECT_EQ(judge(1, scenario.statistics[0].value, 0.06), 0.0);
}
TEST_F(ScenarioLoader, AScenarioInheritsFromItsBase) {
  std::ofstream(folder_ / "base.yaml") << kScenario;
  const ScenarioDescription scenario =
      load("base: base.yaml\nseeds: 7\nscript+: [{at: 30 s, hold: torso, for: 1 s}]\n");
  EXPECT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(scenario.seeds, std::vector<std::uint64_t>{7});
  EXPECT_EQ(scenario.script.size(), 7U);
  EXPECT_EQ(scenario.script.back().hold.value().body.name, "torso");
  EXPECT_EQ(scenario.expectations.size(), 5U);
}
TEST_F(ScenarioLoader, ANameThatFitsNothingIsReportedWithTheNearest) {
  EXPECT_EQ(problems_of("robot: humme").substr(0, 38), "4:8: error: unknown robot 'humme': no ");
  EXPECT_EQ(problems_of("script: [{at: {state: lift, step: 2}, push: {body: torsa, force: 1 N, "
                        "for: 1 s}}]"),
            "4:52: error: the robot has no body 'torsa' (did you mean 'torso'?)\n");
  EXPECT_EQ(problems_of("script: [{at: {state: lifft}, raise: tapped}]"),
            "4:23: error: unknown state 'lifft' (did you mean 'lift'?)\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, raise: taped}]"),
            "4:27: error: the behavior has no event 'taped' (did you mean 'tapped'?)\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {lift_tim: 160 ms}}]"),
            "4:27: error: unknown parameter 'lift_tim' (did you mean 'lift_time'?)\n");
  EXPECT_EQ(problems_of("expect: [base.rpy.pich < 0.1]"),
            "4:10: error: unknown signal 'base.rpy.pich' (did you mean 'base.rpy.pitch'?)\n");
  EXPECT_EQ(problems_of("expect: [{sequence: [sway, limb]}]"),
            "4:28: error: unknown state 'limb' (did you mean 'limp'?)\n");
  EXPECT_EQ(problems_of("expekt: [steps > 1]"),
            "4:1: error: unknown key 'expekt' (did you mean 'expect'?)\n");
}
TEST_F(ScenarioLoader, AValueOfTheWrongKindSizeOrRangeIsRefused) {
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {lift_time: 2 N}}]"),
            "4:38: error: expected a time, got '2 N'\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {lift_time: 1 s}}]"),
            "4:38: error: expected 'lift_time' from 0.11 to 0.16 s, got '1 s'\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {goal: [1 m]}}]"),
            "4:33: error: expected 2 values for 'goal', got 1\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {goal.x: 1001 m}}]"),
            "4:35: error: expected 'goal.x' from -1000 to 1000 m, got '1001 m'\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {goal.x: [1 m, 2 m]}}]"),
            "4:35: error: expected 1 value for 'goal.x', got 2\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, edit: {goal.z: 1 m}}]"),
            "4:27: error: unknown parameter 'goal.z' (did you mean 'goal'?)\n");
  EXPECT_EQ(problems_of("script: [{at: 21 s, raise: tapped}]"),
            "4:15: error: '21 s' is behind the end of the run, which lasts 20 s\n");
  EXPECT_EQ(problems_of("expect: [{that: steps > 1, in: 120 % of seeds}]"),
            "4:32: error: expected more than 0 % and at most 100 % of seeds, got '120 % of "
            "seeds'\n");
  EXPECT_EQ(problems_of("seeds: 10..x"),
            "4:8: error: expected a range of seeds such as 100..119, got '10..x'\n");
}
TEST_F(ScenarioLoader, KeysThatDoNotFitTogetherAreRefused) {
  EXPECT_EQ(problems_of("script: [{raise: tapped}]"),
            "4:10: error: one of the keys 'at', 'on' is missing\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, on: tapped, raise: go_to}]"),
            "4:20: error: 'on' beside 'at': only one is allowed\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, raise: tapped, over: 1 s}]"),
            "4:35: error: 'over' has a meaning only beside 'edit'\n");
  EXPECT_EQ(problems_of("script: [{at: 1 s, raise: contact.left_foot.touchdown}]"),
            "4:27: error: 'contact.left_foot.touchdown' is raised by the engine only\n");
  EXPECT_EQ(problems_of("expect: [{never: rms(com.pos.z) < 1 m}]"),
            "4:18: error: unknown function 'rms'\n");
}
// 1500 ticks a second.
TEST_F(ScenarioLoader, AStatisticThatKeepsItsSamplesIsOfAMillionTicksAtMost) {
  const std::string head = "scenario: 1\nbehavior: walk.yaml\nfor: 700 s\n";
  load(head + "expect: [p95(com.pos.z) < 2 m]\n");
  EXPECT_EQ(diagnostics_.to_string(),
            path() +
                ":4:10: error: p95() is of at most 1000000 ticks, these are 1050000: give it a "
                "shorter time with 'between'\n");
  load(head +
       "expect: [{that: p95(com.pos.z) < 2 m, between: [40 s, 700 s]}, rms(com.pos.z) < 2 m]\n");
  EXPECT_EQ(diagnostics_.to_string(), "");
}
TEST_F(ScenarioLoader, AGoldenTraceAndAnEndAreChecked) {
  EXPECT_EQ(problems_of("golden: {tolerance: {com.pos.zz: 2 mm}}"),
            "4:22: error: unknown signal 'com.pos.zz' (did you mean 'com.pos.z'?)\n");
  EXPECT_EQ(problems_of("golden: {tolerance: {com.pos.z: 2 N}}"),
            "4:33: error: expected a length, got '2 N'\n");
  EXPECT_EQ(problems_of("golden: {tolerance: {com.pos.z: 0 m}}"),
            "4:33: error: expected a tolerance above zero, got '0 m'\n");
  EXPECT_EQ(problems_of("golden: {rate: 50 Hz}"), "4:9: error: the key 'tolerance' is missing\n");
  EXPECT_NE(problems_of("expect: [{end: fell}]").find("(did you mean 'fall'?)"), std::string::npos);
  EXPECT_EQ(problems_of("expect: [{end: fall, after: 1 s}]"),
            "4:29: error: 'after' has no meaning beside 'end'\n");
  const ScenarioDescription scenario = load(
      "scenario: 1\nbehavior: walk.yaml\nfor: 20 s\nexpect: [{end: [fall, fault]}]\n"
      "golden: {file: old.csv, tolerance: {com.pos.z: 2 mm}, rate: 20 Hz}\n");
  EXPECT_EQ(diagnostics_.to_string(), "");
  EXPECT_EQ(scenario.expectations.at(0).ends, (std::vector<int>{2, 3}));
  EXPECT_EQ(scenario.golden->path, path("old.csv"));
  EXPECT_EQ(scenario.golden->rate, 20.0);
  EXPECT_EQ(scenario.golden->signals.at(0).tolerance, 0.002);
}
TEST_F(ScenarioLoader, TheErrorsOfItsBehaviorAreShownAtTheirPlaces) {
  std::ofstream(folder_ / "walk.yaml") << kBehavior << "parameters: {lift_time: {value: 3 s}}\n";
  EXPECT_NE(problems_of("expect: [stepz > 1]").find("walk.yaml:3:"), std::string::npos);
}

}  // namespace
}  // namespace footfall::lab
