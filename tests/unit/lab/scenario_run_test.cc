// Scenarios that run: scripts act when they say, expectations are judged as they say, on a robot of
// double integrators whose states only time moves.
#include "lab/judge/scenario_run.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "hal/backends/stub.h"
#include "hal/sensors/faults.h"
#include "lab/scenario/loader.h"

namespace footfall::lab {
namespace {

// 1500 Hz: a is active from tick 0, b from 150 (100 ms), c from 300, then a again.
constexpr const char* kLaps = R"(behavior: 1
robot: hume
parameters:
  lap: {value: 100 ms, range: [50 ms, 400 ms], live: true}
  stiff: {value: 2}
events: {go: "from outside", tapped: "from outside"}
machine:
  safe: limp
  contacts: [right_foot, left_foot]
  tasks: {rest: {type: joint_damping, gains: {kd: 20}}}
  transitions: [{on: go, to: gone}]
  states:
    a: {after: $lap, to: b}
    b: {after: $lap, to: c, on_exit: [{raise: lapped}]}
    c:
      transitions: [{when: "$stiff > 5", to: gone}]
      after: $lap
      to: a
    gone: {transitions: [{on: tapped, to: a}]}
    limp: {contacts: [], tasks: {rest: {type: joint_damping, gains: {kd: 5}}}}
)";

class ScenarioRunTest : public testing::Test {
 protected:
  ScenarioRunTest()
      : folder_(std::filesystem::path(testing::TempDir()) /
                ("footfall_scenario_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    std::ofstream(folder_ / "laps.yaml") << kLaps;
    std::ofstream(folder_ / "short.yaml")
        << "base: laps.yaml\nmachine:\n  transitions+: [{after: 200 ms, to: over}]\n"
           "  states: {over: {type: final}}\n";
    std::ofstream(folder_ / "lean.yaml")
        << "base: laps.yaml\nmachine:\n  states:\n    gone:\n      tasks: {lean: {type: "
           "body_orientation, axes: [pitch], reference: 0, gains: {kp: 100, kd: 20}}}\n";
  }
  ~ScenarioRunTest() override { std::filesystem::remove_all(folder_); }

  // Runs a scenario of these lines for 0.6 s: 900 ticks.
  ScenarioRun run(const std::string& lines, std::uint64_t seed = 1) {
    std::ofstream(folder_ / "s.yaml") << "scenario: 1\nbehavior: " << file_ << "\nfor: 600 ms\n"
                                      << lines;
    core::Diagnostics diagnostics;
    scenario_ = load_scenario((folder_ / "s.yaml").string(), {{FOOTFALL_SOURCE_DIR}}, diagnostics);
    EXPECT_EQ(diagnostics.to_string(), "");
    if (diagnostics.has_errors()) throw std::runtime_error("the scenario is wrong");
    const behaviors::Behavior& behavior = *scenario_.behavior;
    hal::StubSettings settings;
    settings.joints = behavior.robot.joint_count();
    settings.contacts = static_cast<int>(behavior.robot.contacts.size());
    settings.period = behavior.robot.period_s();
    settings.base = {0.0, 0.0, behavior.robot.standing_height};
    for (const auto& joint : behavior.robot.joints) {
      settings.start.push_back(joint.posture + (joint.name.ends_with("knee") ? bent_ : 0.0));
    }
    hal::StubBackend stub(settings);
    hal::SensorFaults sensors(stub);
    engine::ControlLoop loop(behavior, sensors, {});
    ScenarioHooks hooks;
    hooks.push = [&](const std::string& body, const lab::ScriptedPush& push) {
      acts_.push_back({loop.ticks(), body + " " + std::to_string(static_cast<int>(push.force))});
      return true;
    };
    const auto note = [&](const std::string& act) { acts_.push_back({loop.ticks(), act}); };
    hooks.hold = [&](const auto& hold) { return note(hold.body.name + " held"), 3; };
    hooks.release = [&](int hold) { note(std::to_string(hold) + " free"); };
    hooks.fault = [&](InjectedFault fault, bool on) {
      acts_.push_back({loop.ticks(), on ? "fails" : "works"});
      sensors.fail(
          fault == InjectedFault::imu_dropout ? hal::SensorGroup::imu : hal::SensorGroup::mocap,
          on);
    };
    return run_scenario(scenario_, seed, loop, hooks, {});
  }
  // The outcome of one expectation.
  ExpectationOutcome judge(const std::string& expectation, const std::string& lines = "") {
    return run(lines + "expect:\n  - " + expectation + "\n").outcome.expectations.at(0);
  }

  // `KIND FILE:LINE:COLUMN: TEXT`, a line each.
  std::string failures(const ScenarioRun& done) {
    std::string text;
    for (const ScenarioFailure& failure : done.outcome.failures) {
      text += std::string(failure_kind_name(failure.kind)) + " " +
              std::filesystem::path(failure.place).filename().string() + ": " + failure.text + "\n";
    }
    return text;
  }

  using Act = std::pair<std::int64_t, std::string>;
  std::string file_ = "laps.yaml";
  double bent_ = 0.0;  // rad, knees beyond their posture at the start
  std::filesystem::path folder_;
  ScenarioDescription scenario_;
  std::vector<Act> acts_;
};

TEST_F(ScenarioRunTest, EntriesActAtTheirTimes) {
  run("script:\n"
      "  - {at: 200 ms, push: {body: torso, force: 5 N, for: 1 ms}}\n"
      "  - {at: 300 ms, hold: torso, for: 20 ms}\n");
  EXPECT_EQ(acts_, (std::vector<Act>{{300, "torso 5"}, {450, "torso held"}, {480, "3 free"}}));
}
// b is entered in tick 150 and lasts 150 ticks: half of it has passed before tick 225.
TEST_F(ScenarioRunTest, APhaseIsAPartOfTheStatesDuration) {
  run("script:\n"
      "  - {at: {state: b, phase: 50 %}, push: {force: 1 N, for: 1 ms}}\n"
      "  - {at: {state: c}, push: {force: 2 N, for: 1 ms}}\n");
  EXPECT_EQ(acts_, (std::vector<Act>{{225, "torso 1"}, {301, "torso 2"}}));
}
// What an event of a tick brings about comes before the next one, each time.
TEST_F(ScenarioRunTest, AnEntryOnAnEventActsEachTimeThatItIsRaised) {
  run("script: [{on: lapped, push: {force: 1 N, for: 1 ms}}]\n");
  EXPECT_EQ(acts_, (std::vector<Act>{{301, "torso 1"}, {751, "torso 1"}}));
}
TEST_F(ScenarioRunTest, EditsAndEventsGoThroughTheDoor) {
  const ScenarioRun done =
      run("script:\n"
          "  - {at: 50 ms, edit: {lap: 200 ms}}\n"  // of b and what follows
          "  - {at: 400 ms, raise: go}\n"
          "  - {at: 500 ms, edit: {lap: 300 ms}, raise: tapped}\n"
          "expect:\n"
          "  - {that: in(b), between: [100 ms, 299 ms]}\n"
          "  - {that: in(c), between: [300 ms, 399 ms]}\n"
          "  - {that: in(gone), between: [400 ms, 499 ms]}\n"
          "  - in(a)\n"
          "  - $lap == 300 ms\n");
  for (const ExpectationOutcome& e : done.outcome.expectations) EXPECT_TRUE(e.passed) << e.text;
  EXPECT_TRUE(done.outcome.passed);
}
TEST_F(ScenarioRunTest, SetWritesWhatIsNotLive) {
  EXPECT_TRUE(judge("in(gone)", "script: [{at: 100 ms, set: {stiff: 6}}]\n").passed);
  EXPECT_FALSE(judge("in(gone)").passed);
}
// What a function sees is the last tick's; what it wants is there in the next one, set first.
TEST_F(ScenarioRunTest, AFunctionOfLuaSeesTheRobotAndActsThroughTheDoor) {
  std::ofstream(folder_ / "s.lua") << R"(
    function leave()
      footfall.log(string.format("%.1f %s", footfall.time(), tostring(footfall.active("c"))))
      if footfall.active("c") then footfall.set("stiff", 6) end
    end
    function back() footfall.set("stiff", 2) footfall.set("lap", 0.3) footfall.raise("tapped") end
  )";
  const ScenarioRun done =
      run("scripts: s.lua\n"
          "script:\n"
          "  - {at: 100 ms, call: leave}\n"  // not in c yet
          "  - {at: 250 ms, call: leave}\n"
          "  - {at: 400 ms, call: back}\n"
          "expect:\n"
          "  - {that: in(b) or in(c), between: [101 ms, 249 ms]}\n"
          "  - {that: in(gone), between: [250 ms, 399 ms]}\n"
          "  - in(a)\n"
          "  - $lap == 300 ms\n");
  for (const ExpectationOutcome& e : done.outcome.expectations) EXPECT_TRUE(e.passed) << e.text;
  EXPECT_EQ(failures(done), "");
}
TEST_F(ScenarioRunTest, AFunctionOfLuaThatFailsFailsTheRun) {
  std::ofstream(folder_ / "s.lua") << "function bad()\n  footfall.set('lap', 100)\nend\n";
  const ScenarioRun done = run("scripts: [s.lua]\nscript: [{at: 100 ms, call: bad}]\n");
  EXPECT_FALSE(done.outcome.passed);
  EXPECT_NE(failures(done).find("script s.yaml:5:10: "), std::string::npos) << failures(done);
  EXPECT_NE(failures(done).find("100 is outside the range of 'lap'"), std::string::npos)
      << failures(done);
}
TEST_F(ScenarioRunTest, AFaultOfASensorIsReportedAndEnds) {
  const ScenarioRun done =
      run("script: [{at: 100 ms, fault: imu.dropout, for: 30 ms}]\n"
          "expect: [{that: in(limp), after: 120 ms, within: 1 ms}]\n");  // limits.imu_age: 20 ms
  EXPECT_EQ(failures(done), "");
  EXPECT_EQ(acts_, (std::vector<Act>{{150, "fails"}, {195, "works"}}));
  EXPECT_EQ(done.run.faults.of(core::Fault::imu_stale), 1);
}

// A push that never came says nothing of the robot: such a run has not passed.
TEST_F(ScenarioRunTest, AnEntryThatNeverCameFailsTheRunUnlessItIsOptional) {
  file_ = "short.yaml";  // over after 0.2 s
  for (const char* entry :
       {"{at: 300 ms, push: {force: 40 N, for: 100 ms}}",
        "{at: {step: 8}, push: {force: 40 N, for: 100 ms}}", "{at: {state: gone}, raise: tapped}",
        "{on: tapped, set: {stiff: 3}}", "{at: 400 ms, edit: {lap: 90 ms}}",
        "{at: 400 ms, fault: imu.dropout}", "{at: 400 ms, hold: torso}"}) {
    const ScenarioRun missed = run(std::string("script:\n  - ") + entry + "\n");
    EXPECT_FALSE(missed.outcome.passed) << entry;
    EXPECT_TRUE(failures(missed).starts_with("script s.yaml:5:5: the ")) << failures(missed);
    EXPECT_NE(failures(missed).find(" never came: the run ended at 0.201 s"), std::string::npos)
        << failures(missed);
    const std::string optional = std::string(entry).insert(1, "optional: true, ");
    EXPECT_TRUE(run("script:\n  - " + optional + "\n").outcome.passed) << optional;
  }
}

TEST_F(ScenarioRunTest, EachEntryThatNeverCameAndTheGoldenTraceAreFailuresOfTheirOwn) {
  file_ = "short.yaml";  // over after 0.2 s
  const ScenarioRun done =
      run("script:\n"
          "  - {at: 300 ms, raise: tapped}\n"
          "  - {at: 100 ms, edit: {lap: 90 ms}}\n"
          "  - {at: 400 ms, hold: torso}\n"
          "golden: {tolerance: {joint.left_knee.position: 0.001 rad}}\n"
          "expect: [time > 5 s]\n");
  ASSERT_EQ(done.outcome.failures.size(), 3U) << failures(done);
  const auto json = outcome_json(scenario_, done.outcome, nullptr)["failures"];
  const std::string file = (folder_ / "s.yaml").string();
  EXPECT_EQ(json[0]["kind"], "script");
  EXPECT_EQ(json[0]["place"], file + ":5:5");
  EXPECT_EQ(json[1]["place"], file + ":7:5");
  EXPECT_EQ(json[2]["kind"], "golden");
  EXPECT_EQ(json[2]["place"], file + ":8:9");
}

// The state that a fall leads to says nothing of the fall.
TEST_F(ScenarioRunTest, AFallTellsItsCriterionAndStateAndWhatItBroughtAbout) {
  bent_ = 1.0;  // the feet come too near to the torso
  const ScenarioRun done = run("expect:\n  - {never: in(limp)}\n  - {that: in(b), within: 1 s}\n");
  ASSERT_EQ(done.outcome.failures.size(), 1U) << failures(done);
  EXPECT_EQ(done.outcome.failures[0].kind, ScenarioFailure::Kind::end);
  EXPECT_TRUE(failures(done).starts_with("end s.yaml:1:1: the robot fell: torso "))
      << failures(done);
  EXPECT_NE(failures(done).find(" m above the lowest foot, below the limit "), std::string::npos)
      << failures(done);
  EXPECT_TRUE(failures(done).ends_with(" in a\n")) << failures(done);
  const ExpectationOutcome& never = done.outcome.expectations[0];
  EXPECT_FALSE(never.passed);
  EXPECT_TRUE(never.why.starts_with("it became so when the robot fell: torso ")) << never.why;
}

TEST_F(ScenarioRunTest, AWindowThatTheRunDoesNotReachToItsEndIsNotJudgedAsPassed) {
  file_ = "short.yaml";
  const std::string ended = "the run ended at 0.201 s, before ";
  for (const auto& [condition, why] : {
           std::pair("never: \"base.pos.z > 0 m\", between: [300 ms, 400 ms]",
                     "it could be judged"),
           std::pair("that: \"base.pos.z > 0 m\", between: [300 ms, 400 ms]", "it could be judged"),
           std::pair("never: in(gone), after: 300 ms", "it could be judged"),
           std::pair("never: \"base.pos.z < 0 m\", between: [0.1 s, 0.4 s]", "this time was over"),
           std::pair("that: \"base.pos.z > 0 m\", between: [0.1 s, 0.4 s]", "this time was over"),
           std::pair("that: max(base.pos.z) > 0 m, between: [0.1 s, 0.4 s]", "this time was over"),
       }) {
    const ExpectationOutcome e = judge(std::string("{") + condition + "}");
    EXPECT_FALSE(e.passed) << condition;
    EXPECT_EQ(e.why, ended + why) << condition;
  }
  EXPECT_EQ(judge("{that: \"base.pos.z > 0 m\", between: [100.1 ms, 100.2 ms]}").why,
            "no tick is in this time");
}

TEST_F(ScenarioRunTest, NeverOverWhatHasNoValueIsNotJudgedAsPassed) {
  file_ = "lean.yaml";  // `lean` is in force in `gone` only, which is not entered
  const ScenarioRun done = run("expect:\n  - {never: task.lean.error > 1 mrad}\n");
  EXPECT_FALSE(done.outcome.passed);
  EXPECT_EQ(done.outcome.expectations[0].why,
            "'task.lean.error' never had a value in this time: it was not judged");
}

TEST_F(ScenarioRunTest, ALoneConditionIsJudgedAtTheEnd) {
  const ExpectationOutcome e = judge("time > 1 s");
  EXPECT_FALSE(e.passed);
  EXPECT_EQ(e.text, "time > 1 s");
  EXPECT_EQ(e.place, (folder_ / "s.yaml").string() + ":5:5");
  EXPECT_EQ(e.tick, 899);
  EXPECT_EQ(e.state, "c");
  EXPECT_EQ(e.why, "not so at the end of the run");
  EXPECT_TRUE(judge("time > 599 ms").passed);
}
TEST_F(ScenarioRunTest, NeverNamesTheFirstTickInWhichItHeld) {
  const ExpectationOutcome e = judge("{never: in(b)}");
  EXPECT_FALSE(e.passed);
  EXPECT_EQ(e.tick, 150);
  EXPECT_DOUBLE_EQ(e.at.value(), 0.1);
  EXPECT_EQ(e.state, "b");
  EXPECT_EQ(judge("{never: in(b), after: 200 ms}").tick, 600);
  EXPECT_TRUE(judge("{never: in(b), between: [200 ms, 399 ms]}").passed);
}
TEST_F(ScenarioRunTest, AConditionOverATimeMustHoldInEveryTickOfIt) {
  EXPECT_TRUE(judge("{that: in(b), between: [100 ms, 199 ms]}").passed);
  const ExpectationOutcome e = judge("{that: in(b), between: [100 ms, 250 ms]}");
  EXPECT_FALSE(e.passed);
  EXPECT_EQ(e.tick, 300);
  EXPECT_EQ(e.state, "c");
}
TEST_F(ScenarioRunTest, WithinAsksForOneTick) {
  EXPECT_TRUE(judge("{that: in(b), within: 100 ms}").passed);
  const ExpectationOutcome e = judge("{that: in(b), within: 99 ms}");
  EXPECT_FALSE(e.passed);
  EXPECT_EQ(e.why, "it never became so");
  EXPECT_TRUE(judge("{that: in(b), after: 200 ms, within: 200 ms}").passed);
}
// The clock's signal over ticks 150..300: 0.1 s to 0.2 s.
TEST_F(ScenarioRunTest, StatisticsAreOfTheirTimeAlone) {
  const std::string window = ", between: [100 ms, 200 ms]}";
  const ExpectationOutcome max = judge("{that: max(steps) < 0" + window);
  EXPECT_FALSE(max.passed);
  EXPECT_EQ(max.value, "max steps = 0");
  const ScenarioRun done =
      run("script: [{at: 150 ms, raise: go}]\nexpect:\n"
          "  - {that: max(contact.left_foot) == 1" +
          window +
          "\n"
          "  - {that: mean(contact.left_foot) == 1" +
          window +
          "\n"
          "  - {that: rms(contact.left_foot) == 1" +
          window +
          "\n"
          "  - {that: min(contact.left_foot) == 1" +
          window +
          "\n"
          "  - {that: p95(contact.left_foot) == 1" +
          window +
          "\n"
          "  - {that: count(contact.left_foot) == 1" +
          window + "\n");
  for (const ExpectationOutcome& e : done.outcome.expectations) EXPECT_TRUE(e.passed) << e.value;
}
TEST_F(ScenarioRunTest, ASequenceIsOfEntriesInOrderAndMayBeTimed) {
  EXPECT_TRUE(judge("{sequence: [a, b, c]}").passed);
  EXPECT_TRUE(judge("{sequence: [a, c, a], within: 300 ms}").passed);
  const ExpectationOutcome slow = judge("{sequence: [a, c], within: 100 ms}");
  EXPECT_FALSE(slow.passed);
  EXPECT_EQ(slow.why, "the fastest took 0.2 s");
  const ExpectationOutcome none = judge("{sequence: [b, gone]}");
  EXPECT_EQ(none.why, "'gone' was not entered after 'b'");
  EXPECT_EQ(none.tick, 600);                        // b, for the second time
  EXPECT_TRUE(judge("{sequence: [c, c]}").passed);  // in ticks 300 and 750
  EXPECT_FALSE(judge("{sequence: [c, c, c]}").passed);
}
TEST_F(ScenarioRunTest, ARunThatEndsEarlyFailsUnlessThatIsExpected) {
  const std::string stop = "script: [{at: 100 ms, fault: mocap.dropout}]\n";
  EXPECT_TRUE(run(stop).outcome.passed);  // it goes on without
  EXPECT_TRUE(judge("{end: time}").passed);
  const ExpectationOutcome e = judge("{end: [fall, fault]}");
  EXPECT_FALSE(e.passed);
  EXPECT_EQ(e.why, "the run ended by time at 0.600 s");
}

TEST_F(ScenarioRunTest, CoverageSaysWhatWasReached) {
  const ScenarioRun done = run("script: [{at: 50 ms, raise: tapped}]\n");
  const auto json = outcome_json(scenario_, done.outcome, nullptr);
  const auto& states = json["coverage"]["states"];
  const auto entered = [&](const char* path) {
    return std::find(states.begin(), states.end(), path) != states.end();
  };
  EXPECT_TRUE(entered("a") && entered("b") && entered("c"));
  EXPECT_FALSE(entered("gone") || entered("limp"));
  int taken = 0;
  for (const auto& t : json["coverage"]["transitions"]) taken += t["taken"].get<bool>() ? 1 : 0;
  EXPECT_EQ(taken, 3);
  ASSERT_EQ(json["coverage"]["guards"].size(), 1U);
  EXPECT_FALSE(json["coverage"]["guards"][0]["true"].get<bool>());
  EXPECT_TRUE(json["coverage"]["guards"][0]["false"].get<bool>());
  EXPECT_EQ(json["coverage"]["guards"][0]["line"], 16);
  EXPECT_EQ(json["seed"], 1);
  EXPECT_EQ(json["passed"], true);
}

TEST_F(ScenarioRunTest, AGoldenTraceIsWrittenReadAndFollowed) {
  const std::string golden =
      "golden: {tolerance: {joint.left_knee.position: 0.001 rad}, rate: 10 Hz}\n";
  const ScenarioRun first = run(golden);
  EXPECT_FALSE(first.outcome.passed);
  EXPECT_NE(failures(first).find("no golden trace yet"), std::string::npos);
  const std::string path = (folder_ / "s.golden.csv").string();
  EXPECT_EQ(scenario_.golden->path, path);
  GoldenTrace trace = first.trace;
  ASSERT_EQ(trace.rows.size(), 6U);  // 0, 0.1, ... 0.5 s
  EXPECT_EQ(trace.rows[1].state, "b");
  write_golden(path, *scenario_.golden, trace);
  EXPECT_TRUE(run(golden).outcome.passed);
  trace.rows[3].values[0] += 0.002;
  write_golden(path, *scenario_.golden, trace);
  const std::string why = failures(run(golden));
  EXPECT_NE(why.find("joint.left_knee.position at 0.3000 s in a: got "), std::string::npos) << why;
  EXPECT_TRUE(run(golden, 2).outcome.passed);  // another seed is not compared
  std::ofstream(path) << "time,state\n";
  EXPECT_NE(failures(run(golden)).find(":1: error: expected the head"), std::string::npos);
}

}  // namespace
}  // namespace footfall::lab
