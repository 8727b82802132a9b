// Behavior files: what loads, and what is said about what does not, with the place.
#include "behaviors/loader.h"

#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

TEST(Loader, TheBalanceBehaviorLoadsWithoutAWarning) {
  core::Diagnostics diagnostics;
  const auto behavior = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  ASSERT_TRUE(behavior);
  EXPECT_EQ(behavior->name, "kim2016_printed");
  EXPECT_EQ(behavior->robot.name, "hume");
  EXPECT_EQ(behavior->marks, std::vector<std::string>{"step"});
  EXPECT_EQ(behavior->step, 0);
  EXPECT_GE(behavior->find_event("start"), 0);
  EXPECT_GE(behavior->find_event("planner.foot.late"), 0);
  EXPECT_GE(behavior->find_event("contact.left_foot.touchdown"), 0);
}
TEST(Loader, AMirrorMakesTwoStatesNamedAfterTheFirstArgument) {
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_TRUE(b);
  for (const char* side : {"right_foot", "left_foot"}) {
    for (const char* phase : {"dual", "unload", "lift", "land", "load", "down"}) {
      EXPECT_GE(b->find_state(std::string("step.") + side + "." + phase), 0) << side << phase;
    }
  }
  EXPECT_LT(b->find_state("step.right_foot"), b->find_state("step.left_foot"));
}
TEST(Loader, ArgumentsReachNamesInsideExpressionsAndStacks) {
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_TRUE(b);
  int left = 0, right = 0;  // points: contacts first
  for (const auto& task : b->task_instances) {
    if (task.name != "swing") continue;
    left += task.point == b->robot.find_contact("left_foot");
    right += task.point == b->robot.find_contact("right_foot");
  }
  EXPECT_EQ(left, 1);
  EXPECT_EQ(right, 1);
}
TEST(Loader, GainsAreParametersWithTheirOwnNamesAndRanges) {
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_TRUE(b);
  const int index = b->find_parameter("gains.single.swing.kp");
  ASSERT_GE(index, 0);
  const auto& info = b->parameters[static_cast<std::size_t>(index)];
  EXPECT_EQ(info.size, 3);
  EXPECT_TRUE(info.live);
  EXPECT_EQ(info.max, 800.0);
  EXPECT_EQ(b->values[static_cast<std::size_t>(info.slot + 2)], 400.0);
  EXPECT_GE(b->find_parameter("gains.limp.rest.kd"), 0);
}
TEST(Loader, GainsFollowTheOrderOfTheAxesInTheFile) {
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options_for_tests(), diagnostics);
  ASSERT_TRUE(b);
  for (const auto& task : b->tasks) {
    const auto& instance = b->task_instances[static_cast<std::size_t>(task.instance)];
    if (instance.name != "attitude" || task.axes.count != 3) continue;
    const auto* axis = &b->axes[static_cast<std::size_t>(task.axes.first)];
    EXPECT_EQ(axis[0].axis, 2);  // yaw
    EXPECT_EQ(axis[1].axis, 1);  // pitch
    EXPECT_EQ(axis[2].axis, 0);  // roll
    EXPECT_EQ(b->values[static_cast<std::size_t>(axis[0].kp)], 100.0);
    EXPECT_EQ(b->values[static_cast<std::size_t>(axis[2].kp)], 210.0);
  }
}
TEST(Loader, AnotherKindOrANewerVersionIsRefusedInOneLine) {
  EXPECT_EQ(problems("robot: 1\n"),
            "b.yaml:1:1: error: not a behavior file: expected 'behavior: 1' as the first key, got "
            "'robot'\n");
  EXPECT_EQ(problems("behavior: 2\nmachine: {}\n"),
            "b.yaml:1:11: error: this program reads 'behavior: 1', not version '2'\n");
}
TEST(Loader, AnUnknownRobotIsOneError) {
  EXPECT_NE(problems("behavior: 1\nrobot: hune\nmachine: {}\n")
                .find("b.yaml:2:8: error: unknown robot 'hune': no such file, and no "
                      "robots/hune/robot.yaml beside this file, above it, or in "),
            std::string::npos);
}
TEST(Loader, UnknownKeysComeWithASuggestion) {
  EXPECT_EQ(
      problems("behavior: 1\nmachin: {}\nmachine:\n  states: {a: {afer: 1 s, to: b}, b: {}}\n"),
      "b.yaml:2:1: error: unknown key 'machin' (did you mean 'machine'?)\n"
      "b.yaml:4:16: error: unknown key 'afer' (did you mean 'after'?)\n");
}
TEST(Loader, AMachineIsRequired) {
  EXPECT_EQ(problems("behavior: 1\n"), "b.yaml:1:1: error: the key 'machine' is missing\n");
}
TEST(Loader, ATransitionToAnUnknownStateComesWithASuggestion) {
  EXPECT_EQ(problems(chart("  states: {lift: {after: 1 s, to: lnad}, land: {}}")),
            "b.yaml:3:35: error: unknown state 'lnad' (did you mean 'land'?)\n");
}
TEST(Loader, AnAmbiguousStateNamesBoth) {
  EXPECT_EQ(problems(chart("  states:\n    o: {after: 1 s, to: x}\n"
                           "    p: {states: {x: {}}}\n    q: {states: {x: {}}}\n")),
            "b.yaml:4:25: error: state 'x' is ambiguous, write more of the path: 'p.x' or 'q.x'\n");
}
TEST(Loader, ExpressionsReportTheExactColumn) {
  EXPECT_EQ(problems("behavior: 1\nparameters: {d: {value: 1 s}}\nmachine:\n"
                     "  states: {a: {after: \"= 2*$d + 3 m\", to: b}, b: {}}\n"),
            "b.yaml:4:33: error: cannot add a time and a length\n");
  EXPECT_EQ(problems(chart("  states: {a: {transitions: [{when: t > 5 N, to: b}]}, b: {}}")),
            "b.yaml:3:41: error: cannot compare a time and a force\n");
}
TEST(Loader, TheColumnIsExactBehindATemplateArgument) {
  EXPECT_EQ(problems(R"(behavior: 1
templates:
  s: {args: [n], states: {a: {transitions: [{when: $n > 0 and oops > 1, to: a}]}}}
machine: {states: {x: {use: s, with: {n: 12345678}}}}
)"),
            "b.yaml:3:63: error: unknown signal 'oops'\n");
}
TEST(Loader, NegativeArgumentsKeepTheirSignInExpressions) {
  const auto b = load(R"(
behavior: 1
parameters: {x: {value: 0}}
templates:
  s: {args: [n], states: {a: {on_entry: [{set: {x: "= 10 - $n^2"}}]}}}
machine: {states: {x: {use: s, with: {n: -3}}}}
)");
  std::vector<double> values = b->values;
  behaviors::Statechart chart(*b, nullptr, values);
  chart.start(0);
  EXPECT_EQ(values[0], 1.0);  // 10 - (-3)²
}
TEST(Loader, TheWrongDimensionIsNamed) {
  EXPECT_EQ(problems(chart("  states: {a: {after: 100 N, to: b}, b: {}}")),
            "b.yaml:3:23: error: expected a time, got '100 N'\n");
}
TEST(Loader, ANegativeTimeIsAnError) {
  EXPECT_EQ(problems(chart("  states: {a: {after: -1 s, to: b}, b: {}}")),
            "b.yaml:3:23: error: expected a time from 0 s to 10^6 s, got '-1 s'\n");
}
TEST(Loader, AfterNeedsToAndToNeedsAfter) {
  EXPECT_EQ(problems(chart("  states: {a: {after: 1 s}, b: {}}")),
            "b.yaml:3:23: error: `after` needs `to` beside it\n");
  EXPECT_EQ(problems(chart("  states: {a: {to: b}, b: {}}")),
            "b.yaml:3:20: error: `to` needs `after` beside it\n");
}
TEST(Loader, ATransitionNeedsACauseAndAnEffect) {
  EXPECT_EQ(problems(chart("  states: {a: {transitions: [{to: b}, {after: 1 s}]}, b: {}}")),
            "b.yaml:3:30: error: a transition needs at least one of on, when, after\n"
            "b.yaml:3:39: error: a transition without `on` needs `to` or `do`; only one with `on` "
            "may absorb an event and do nothing\n");
}
TEST(Loader, ATransitionWithAnEventAloneAbsorbsIt) {
  const std::string text =
      "behavior: 1\nevents: {x: ask, y: go}\nmachine:\n  transitions: [{on: x, to: c}]\n"
      "  states: {a: {transitions: [{on: x}, {on: y, to: b}]}, b: {}, c: {}}\n";
  EXPECT_EQ(trace_of(*load(text), behaviors::trace_events("x,y,x")),
            (std::vector<std::string>{"a", "a", "b", "c"}));
}
TEST(Loader, AnInstanceAppendsToAListOfItsTemplate) {
  const std::string text = R"(behavior: 1
parameters: {n: 0}
templates: {wait: {on_entry: [{set: {n: "= $n + 1"}}]}}
events: {x: ask}
machine:
  states:
    a: {use: wait, on_entry+: [{set: {n: "= $n + 1"}}], transitions: [{on: x, when: $n == 2, to: b}]}
    b: {}
)";
  EXPECT_EQ(trace_of(*load(text), behaviors::trace_events("x")),
            (std::vector<std::string>{"a", "b"}));
}
TEST(Loader, AnEventNobodyRaisesIsAWarning) {
  EXPECT_EQ(problems("behavior: 1\nevents: {start: go}\nmachine:\n"
                     "  states: {a: {transitions: [{on: strat, to: b}]}, b: {type: final}}\n"),
            "b.yaml:4:35: warning: nothing raises 'strat', and `events` does not list it (did you "
            "mean 'start'?)\n");
}
TEST(Loader, ParametersAreCheckedAgainstTheirRange) {
  EXPECT_EQ(
      problems("behavior: 1\nparameters:\n  a: {value: 500 ms, range: [80 ms, 400 ms]}\n"
               "  b: {value: 1, live: true}\n  c: {value: [1 m, 1 s]}\n  on: {value: 1}\n"
               "machine: {}\n"),
      "b.yaml:3:14: error: '500 ms' is outside the range of 'a', 0.08 s to 0.4 s\n"
      "b.yaml:4:23: error: parameter 'b' is live and needs a range\n"
      "b.yaml:5:20: error: expected a length, got '1 s'\n"
      "b.yaml:6:3: error: expected the name of a parameter ('on' cannot be a name), got 'on'\n");
}
// What an expression reads by name, an action sets by the same name.
TEST(Loader, AnActionSetsOneValueOfAVector) {
  const auto behavior = load(R"(
behavior: 1
parameters: {goal: {value: [1 m, 2 m]}}
machine: {states: {a: {on_entry: [{set: {goal.y: "= $goal.y + 3 m"}}]}}}
)");
  core::SignalTable signals = behavior->signals;
  behaviors::Machine machine(*behavior, signals);
  machine.start();
  machine.tick(0);
  EXPECT_EQ(machine.parameters()[0], 1.0);
  EXPECT_EQ(machine.parameters()[1], 5.0);
  EXPECT_NE(problems("behavior: 1\nparameters: {goal: {value: [1 m, 2 m]}}\n"
                     "machine: {states: {a: {on_entry: [{set: {goal.w: 3 m}}]}}}\n")
                .find("unknown parameter 'goal.w'"),
            std::string::npos);
}

TEST(Loader, AnActionMaySetVariablesOnly) {
  EXPECT_EQ(problems("behavior: 1\nparameters: {a: {value: 1, range: [0, 2], live: true}, b: 1}\n"
                     "machine: {on_entry: [{set: {a: 1}}, {set: {c: 1}}]}\n"),
            "b.yaml:3:29: error: 'a' is live: an action may not set it; write `live: false`, or "
            "leave `live` out\n"
            "b.yaml:3:44: error: unknown parameter 'c'\n");
}
TEST(Loader, OverridesReplaceParametersAndAreCheckedLikeThem) {
  auto options = options_for_tests();
  options.set = {{"a", "2 s"}};
  const std::string text =
      "behavior: 1\nparameters: {a: {value: 1 s, range: [0 s, 5 s]}}\nmachine: {}\n";
  EXPECT_EQ(load(text, options)->values[0], 2.0);
  options.set = {{"a", "9 s"}};
  EXPECT_EQ(problems(text, options),
            "--set a:1:1: error: '9 s' is outside the range of 'a', 0 s to 5 s\n");
  options.set = {{"b", "9 s"}, {"gains.single.x.kp", "3"}};
  EXPECT_EQ(problems(text, options),
            "--set b:1:1: error: --set b: unknown parameter 'b'\n"
            "--set gains.single.x.kp:1:1: error: --set gains.single.x.kp: there is no 'gains'\n");
}
TEST(Loader, OverridesReachGainsAndPlanners) {
  auto options = options_for_tests();
  options.set = {{"gains.single.swing.kp", "[100, 200, 300]"},
                 {"planners.foot.kappa", "0.3"},
                 {"planners.foot.goal", "[1 m, 2 m]"}};
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options, diagnostics);
  ASSERT_TRUE(b) << diagnostics.to_string();
  EXPECT_EQ(b->planners[0].spec.kappa[1], 0.3);
  EXPECT_EQ(b->planners[0].goal, (std::vector<double>{1.0, 2.0}));
  const auto& info =
      b->parameters[static_cast<std::size_t>(b->find_parameter("gains.single.swing.kp"))];
  EXPECT_EQ(b->values[static_cast<std::size_t>(info.slot + 1)], 200.0);
}
TEST(Loader, AnOverrideReachesOneAxisOfAGainByNameOrNumber) {
  auto options = options_for_tests();
  options.set = {{"gains.single.swing.kp.y", "111"},
                 {"gains.dual.attitude.kp[1]", "222"},
                 {"gains.single.height.kp.z", "333"},
                 {"goal[1]", "0.4 m"}};
  core::Diagnostics diagnostics;
  const auto b = behaviors::load_behavior(balance_path(), options, diagnostics);
  ASSERT_TRUE(b) << diagnostics.to_string();
  const auto value = [&](const char* name) {
    const auto part = b->find_parameter_part(name);
    const auto& info = b->parameters[static_cast<std::size_t>(part.parameter)];
    return b->values[static_cast<std::size_t>(info.slot + std::max(part.component, 0))];
  };
  EXPECT_EQ(value("gains.single.swing.kp.x"), 220.0);  // as in the file
  EXPECT_EQ(value("gains.single.swing.kp.y"), 111.0);
  EXPECT_EQ(value("gains.dual.attitude.kp.pitch"), 222.0);
  EXPECT_EQ(value("gains.single.height.kp"), 333.0);
  EXPECT_EQ(value("goal.y"), 0.4);
  options.set = {{"gains.dual.attitude.kp.pich", "9"}, {"gains.dual.attitude.kp.roll", "9000"}};
  core::Diagnostics problems;
  EXPECT_FALSE(behaviors::load_behavior(balance_path(), options, problems));
  const std::string text = problems.to_string();
  EXPECT_NE(text.find("--set gains.dual.attitude.kp.pich: gains.dual.attitude.kp has no axis "
                      "'pich' (did you mean 'pitch'?)\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("error: '9000' is outside gains.ranges, 5 to 800\n"), std::string::npos)
      << text;
}
TEST(Loader, AnOverriddenGainMustStayInsideItsRange) {
  auto options = options_for_tests();
  options.set = {{"gains.single.swing.kp", "[100, 200, 3000]"}, {"gains.singel.swing.kp", "1"}};
  core::Diagnostics diagnostics;
  EXPECT_FALSE(behaviors::load_behavior(balance_path(), options, diagnostics));
  const std::string text = diagnostics.to_string();
  EXPECT_NE(
      text.find("--set gains.single.swing.kp:1:12: error: '3000' is outside gains.ranges, 5 to "
                "800\n"),
      std::string::npos)
      << text;
  EXPECT_NE(
      text.find("--set gains.singel.swing.kp: there is no 'singel' (did you mean 'single'?)\n"),
      std::string::npos)
      << text;
}
TEST(Loader, TemplatesSayWhatTheyNeed) {
  EXPECT_EQ(problems("behavior: 1\ntemplates: {s: {args: [a, b]}}\n"
                     "machine: {states: {x: {use: s, with: {a: 1, c: 2}}, y: {use: r}}}\n"),
            "b.yaml:3:29: error: template 's' needs the argument 'b'\n"
            "b.yaml:3:45: error: template 's' has no argument 'c' (there are a, b)\n"
            "b.yaml:3:62: error: unknown template 'r' (there is s)\n");
}
TEST(Loader, OtherKeysOverrideTheTemplates) {
  EXPECT_EQ(
      trace_of("behavior: 1\ntemplates:\n  s: {states: {a: {after: 1 s, to: b}, b: {}, c: {}}}\n"
               "machine: {states: {x: {use: s, initial: c}}}\n",
               ""),
      Lines{"c"});
}
TEST(Loader, ATemplateThatUsesItselfIsRefused) {
  EXPECT_NE(problems("behavior: 1\ntemplates: {s: {states: {a: {use: s}, b: {use: s}}}}\n"
                     "machine: {states: {x: {use: s}}}\n")
                .find("error: "),
            std::string::npos);
}
TEST(Loader, AnArgumentMayNotHaveAParametersName) {
  EXPECT_EQ(problems("behavior: 1\nparameters: {a: 1}\ntemplates: {s: {args: [a]}}\n"
                     "machine: {states: {x: {use: s, with: {a: 1}}}}\n"),
            "b.yaml:3:24: error: argument 'a' has the name of a parameter\n");
}
TEST(Loader, AnUnresolvedNameIsAnErrorAtItsPlace) {
  EXPECT_EQ(
      problems("behavior: 1\ntemplates: {s: {args: [foot], states: {a: {after: 1 s, to: $fot}}}}\n"
               "machine: {states: {x: {use: s, with: {foot: a}}}}\n"),
      "b.yaml:2:60: error: '$fot' is neither a parameter nor an argument here\n");
}
TEST(Loader, AMirrorNeedsTheRobotsSymmetry) {
  EXPECT_EQ(
      problems("behavior: 1\ntemplates: {s: {args: [foot]}}\n"
               "machine: {states: {x: {mirror: s, with: {foot: right_foot}}}}\n"),
      "b.yaml:3:48: error: 'right_foot' has no mirror image: name it in the robot's symmetry\n");
}
TEST(Loader, StatesHaveTheKeysOfTheirKindOnly) {
  EXPECT_EQ(
      problems(chart("  states:\n    a: {initial: b}\n    b: {type: final, after: 1 s, to: a}\n"
                     "    c: {type: parallel}\n    h: {type: histry}\n")),
      "b.yaml:4:18: error: only a compound state has `initial`\n"
      "b.yaml:5:29: error: a final or history state has no transitions\n"
      "b.yaml:6:15: error: a parallel state needs `states`\n"
      "b.yaml:7:15: error: expected a type of state: parallel, final or history, got 'histry' "
      "(did you mean 'history'?)\n");
}
TEST(Loader, TargetsThatCannotBeActiveTogetherAreRefused) {
  EXPECT_EQ(problems(chart("  states:\n    a: {after: 1 s, to: [b, c]}\n    b: {}\n    c: {}\n")),
            "b.yaml:4:29: error: 'b' and 'c' cannot be active together as targets\n");
}
TEST(Loader, WithoutARobotThereIsNoControl) {
  EXPECT_EQ(problems(chart("  states: {a: {contacts: []}}")),
            "b.yaml:3:26: error: `contacts` needs a robot: this behavior names none\n");
}
TEST(Loader, ACalledFunctionMustExist) {
  EXPECT_EQ(problems(chart("  on_entry: [{call: f}]")),
            "b.yaml:3:21: error: unknown function 'f': no file of `scripts` defines it, and the "
            "program registers none of this name\n");
}
TEST(Loader, AStateNamedLikeABooleanIsRefused) {
  EXPECT_NE(problems(chart("  states: {off: {}, no: {}}")).find("b.yaml:3:12: error: "),
            std::string::npos);
}

TEST(Loader, AParameterWithoutAUnitIsSetToAValueWithOne) {
  Runner run(load(chart(R"(
  on_entry: [{set: {goal: [30 cm, 0 m]}}]
  states: {a: {transitions: [{when: $goal.x == 0.3 m, to: there}]}, there: {type: final}}
parameters: {goal: [0, 0]}
)")));
  run.start();
  run.tick();
  EXPECT_EQ(run.active(), "there");
}

}  // namespace
}  // namespace footfall::tests
