// Times, contacts, sides and parallel control that do not fit together, on Hume (1500 Hz).
#include <gtest/gtest.h>

#include "tests/unit/behaviors/behavior_test_support.h"

namespace footfall::tests {
namespace {

// Hume with a stack on both feet and one on the right foot; `states` from line 17 on.
std::string hume(const std::string& states, const std::string& more = "") {
  return "behavior: 1\nrobot: hume\ngains:\n  g: {height: {kp: 1, kd: 1}, swing: {kp: 1, kd: "
         "1}}\nstacks:\n"
         "  dual:\n    contacts: [right_foot, left_foot]\n    gains: g\n"
         "    tasks: {height: {type: com_position, axes: [z], reference: entry}}\n"
         "  right:\n    contacts: [right_foot]\n    gains: g\n    tasks:\n"
         "      swing: {type: point_position, point: left_foot, reference: {trajectory: hold}}\n" +
         more + "machine:\n  states:\n" + states;
}

TEST(CheckTiming, APhaseShorterThanTwoTicksIsSaidAtItsTime) {
  EXPECT_EQ(problems(hume("    a: {stack: dual, after: 0.6 ms, to: b}\n"
                          "    b: {stack: right, after: 1 s, to: a}\n")),
            "b.yaml:17:29: warning: this phase lasts 1 tick at 1500 Hz: at least 2 are needed\n");
  EXPECT_EQ(problems(hume("    a: {stack: dual, after: 0.7 ms, to: b}\n"  // 1.05 periods: 2 ticks
                          "    b: {stack: right, after: 1 s, to: a}\n")),
            "");
}
TEST(CheckTiming, NoTimeIsTooShortForAStateThatControlsOnly) {
  EXPECT_EQ(
      problems(hume("    a: {stack: dual, after: 0 s, to: b}\n"
                    "    b: {stack: right, after: 1 s, to: c}\n    c: {after: 0 s, to: a}\n")),
      "b.yaml:17:29: warning: this phase lasts 0 ticks at 1500 Hz: at least 2 are needed\n");
}
TEST(CheckTiming, AnOverrideMayMakeAPhaseTooShort) {
  auto options = options_for_tests();
  options.set = {{"dual_time", "0.1 ms"}};
  core::Diagnostics diagnostics;
  EXPECT_TRUE(behaviors::load_behavior(balance_path(), options, diagnostics));
  EXPECT_NE(diagnostics.to_string().find("this phase lasts 1 tick at 1500 Hz"), std::string::npos)
      << diagnostics.to_string();
}
TEST(CheckTiming, ATrajectoryThatTheStateCutsOffIsSaidAtItsOver) {
  const auto lift = [](const std::string& over, const std::string& more) {
    return hume(
        "    a: {stack: dual, after: 1 s, to: b}\n    b:\n      stack: right\n      tasks: "
        "{swing: {reference: {trajectory: cosine, to: entry, over: " +
        over + "}}}\n      " + more + "\n");
  };
  EXPECT_EQ(problems(lift("1.1 s", "after: 1 s\n      to: a")),
            "b.yaml:20:72: warning: this trajectory takes 1650 ticks, but 'b' ends after 1500\n");
  EXPECT_EQ(problems(lift("1 s", "after: 1 s\n      to: a")), "");
  EXPECT_EQ(problems(lift("1.1 s", "transitions: [{when: contact.left_foot, after: 1 s, to: a}]")),
            "");
}
TEST(CheckTiming, ARampThatTheStateCutsOffIsSaidAtItsOver) {
  EXPECT_EQ(problems(hume("    a: {stack: dual, after: 1 s, to: b}\n    b:\n      stack: right\n"
                          "      contact_transition: {releases: left_foot, over: 50 ms}\n"
                          "      after: 40 ms\n      to: a\n")),
            "b.yaml:20:55: warning: this contact transition takes 75 ticks, but 'b' ends after "
            "60\n");
}
TEST(CheckTiming, APlannerThatIsAskedTooLateIsNeverAsked) {
  const auto invoke = [](const std::string& at) {
    return hume(
        "    a: {stack: dual, after: 1 s, to: b}\n    b:\n      stack: right\n"
        "      invoke: [{planner: foot, at: " +
            at +
            ", with: {stance: right_foot, swing: left_foot, switch_in: 1 s}}]\n"
            "      after: 1 s\n      to: a\n",
        "planners: {foot: {type: velocity_reversal}}\n");
  };
  EXPECT_EQ(problems(invoke("1 s")),
            "b.yaml:21:36: warning: the planner is never asked: that is after 1500 ticks, and 'b' "
            "ends after 1500\n");
  EXPECT_EQ(problems(invoke("100 %")).substr(0, 34), "b.yaml:21:36: warning: the planner");
  EXPECT_EQ(problems(invoke("99 %")), "");
  EXPECT_EQ(problems(invoke("999 ms")), "");
}

TEST(CheckContacts, AReleasedFootMustHaveBeenInContactSomewhereBefore) {
  const std::string release =
      "    b: {stack: right, contact_transition: {releases: left_foot, over: 9 ms}, after: 1 s, "
      "to: "
      "c}\n";
  EXPECT_EQ(problems(hume("    a: {stack: right, after: 1 s, to: b}\n" + release +
                          "    c: {stack: dual, after: 1 s, to: a}\n")),
            "b.yaml:18:54: warning: 'left_foot' is released here, but no state before has it in "
            "contact\n");
  EXPECT_EQ(problems(hume("    a: {stack: right, after: 1 s, to: b}\n" + release +
                          "    c: {stack: dual, after: 1 s, to: b}\n")),
            "");
}
TEST(CheckContacts, ALoadedFootMustNotHaveBeenInContactEverywhereBefore) {
  const std::string load =
      "    b: {stack: right, contact_transition: {loads: left_foot, toward: dual, over: 9 ms}, "
      "after: 1 s, to: c}\n";
  EXPECT_EQ(problems(hume("    a: {stack: dual, after: 1 s, to: b}\n" + load +
                          "    c: {stack: right, after: 1 s, to: a}\n")),
            "b.yaml:18:51: warning: 'left_foot' is loaded here, but every state before has it in "
            "contact\n");
  EXPECT_EQ(problems(hume("    a: {stack: right, after: 1 s, to: b}\n" + load +
                          "    c: {stack: dual, after: 1 s, to: a}\n")),
            "");
}

// Two regions on both feet; `l` and `r` are keys of the regions' states.
std::string regions(const std::string& l, const std::string& r, const std::string& more = "") {
  return hume("    p:\n      stack: dual\n      type: parallel\n      states:\n        l: {" + l +
                  "}\n        r: {" + r + "}\n",
              "torque_loop: {soft: {p: 1}, hard: {p: 2}}\n" + more);
}
std::string errors_of(const std::string& text) {
  std::string out;
  std::istringstream in(problems(text));
  for (std::string line; std::getline(in, line);) {
    if (line.find(": error: ") != std::string::npos) out += line + "\n";
  }
  return out;
}
TEST(CheckParallel, TwoContactTransitionsAtOnceAreAnError) {
  EXPECT_EQ(errors_of(regions("contacts: [right_foot], contact_transition: {releases: left_foot, "
                              "over: 9 ms}",
                              "contact_transition: {releases: left_foot, over: 9 ms}")),
            "b.yaml:23:33: error: `contact_transition` is given by 'p.l' and by 'p.r' at once\n");
}
TEST(CheckParallel, TwoTorqueLoopsOfOneLegAtOnceAreAnError) {
  EXPECT_EQ(
      errors_of(regions("torque_loop: {left_foot: soft}", "torque_loop: {left_foot: hard}")),
      "b.yaml:23:27: error: torque_loop 'left_foot' is given by 'p.l' and by 'p.r' at once\n");
  EXPECT_EQ(errors_of(regions("torque_loop: {left_foot: soft}", "torque_loop: {left_leg: hard}")),
            "b.yaml:23:27: error: 'left_foot' and 'left_leg' both give joint 'left_abduction' a "
            "torque_loop\n");
  EXPECT_EQ(errors_of(regions("torque_loop: {left_foot: soft}", "torque_loop: {right_leg: hard}")),
            "");
}
TEST(CheckParallel, AStatesTorqueLoopGoesOverItsStacks) {
  EXPECT_EQ(
      problems("behavior: 1\nrobot: hume\ntorque_loop: {soft: {p: 1}, hard: {p: 2}}\nstacks:\n"
               "  s: {contacts: [right_foot], torque_loop: {left_foot: soft, right_foot: "
               "soft}}\nmachine: {stack: s, torque_loop: {left_leg: hard}}\n"),
      "");
}
TEST(CheckParallel, TheSamePlannerTwiceAtOnceIsAnError) {
  const std::string invoke =
      "invoke: [{planner: foot, with: {stance: right_foot, swing: left_foot, switch_in: 1 s}}]";
  EXPECT_EQ(errors_of(regions(invoke, invoke, "planners: {foot: {type: velocity_reversal}}\n")),
            "b.yaml:24:32: error: planner 'foot' is invoked by 'p.l' and by 'p.r' at once\n");
}
TEST(CheckParallel, RegionsMaySayTheSameContacts) {
  EXPECT_EQ(
      errors_of(regions("contacts: [right_foot, left_foot]", "contacts: [left_foot, right_foot]")),
      "");
  EXPECT_EQ(errors_of(regions("contacts: [right_foot]", "contacts: [left_foot]")),
            "b.yaml:23:23: error: `contacts` is given by 'p.l' and by 'p.r' at once\n");
}

// A mirrored template with one state; `keys` in line 6.
std::string mirrored(const std::string& keys, const std::string& more = "") {
  return "behavior: 1\nrobot: hume\ntemplates:\n  s:\n    args: [stance, swing]\n    states: {a: "
         "{" +
         keys +
         ", transitions: [{when: contact.$swing and not contact.$stance, to: b}]}, b: {type: "
         "final}}\n" +
         more +
         "machine: {states: {step: {mirror: s, with: {stance: right_foot, swing: "
         "left_foot}}}}\n";
}
TEST(CheckMirror, ASideWrittenOutInAMirroredTemplateIsNotExchanged) {
  EXPECT_EQ(
      problems(mirrored("contacts: [right_foot]")),
      "b.yaml:6:29: warning: 'right_foot' is the same foot or side in the mirror image: write "
      "$stance\n");
  EXPECT_EQ(
      problems(mirrored("on_exit: [{log: 'left_foot'}, {log: '{contact.$swing}'}], contacts: "
                        "[], after: \"= contact.left_foot*1 s\", to: b")),
      "b.yaml:6:108: warning: 'left_foot' is the same foot or side in the mirror image: write "
      "$swing\n");
}
TEST(CheckMirror, AStackThatTheTemplateNamesBelongsToIt) {
  EXPECT_EQ(problems(mirrored("stack: one", "stacks: {one: {contacts: [left_foot]}}\n")),
            "b.yaml:7:27: warning: 'left_foot' is the same foot or side in the mirror image: write "
            "$swing\n");
}
TEST(CheckMirror, BothSidesTogetherAreTheSameInTheImage) {
  EXPECT_EQ(problems(mirrored("contacts: [right_foot, left_foot]")), "");
  EXPECT_EQ(problems(mirrored("contacts: [$stance]")), "");
}
TEST(CheckMirror, AStateNamedAfterTheSideIsNoSide) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\ntemplates:\n  s: {args: [f], states: {left_foot: "
                     "{after: 1 s, to: b}, b: {type: final}}}\n"
                     "machine: {states: {step: {mirror: s, with: {f: right_foot}}}}\n"),
            "");
}
TEST(CheckMirror, ATemplateThatNeverEndsHasNoOtherSide) {
  EXPECT_EQ(problems("behavior: 1\nrobot: hume\ntemplates:\n  s: {args: [f], states: {a: {after: 1 "
                     "s, to: b}, b: {after: 1 s, to: a}}}\n"
                     "machine: {states: {step: {mirror: s, with: {f: right_foot}}}}\n"),
            "b.yaml:5:35: warning: 'step.right_foot' is never done: it has no `type: final` state "
            "that would end it\n");
}

}  // namespace
}  // namespace footfall::tests
