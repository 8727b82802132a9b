// Values into bases, and into files on top of a behavior.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/unit/behaviors/save/save_test_support.h"

namespace footfall::tests {
namespace {

class SaveOverlay : public SaveTest {
 protected:
  SaveOverlay() {
    put("base.yaml", kBase);
    put("top.yaml", "base: base.yaml\nparameters:\n  u: {value: 3 s}  # mine\n");
  }
  static constexpr const char* kBase =
      "behavior: 1\nparameters:\n  t: {value: 145 ms, range: [80 ms, 400 ms], live: true}\n"
      "  u: {value: 2 s, range: [1 s, 9 s], live: true}\n  v: {value: [1, 2]}\n"
      "machine: {states: {a: {after: $t, to: a}}}\n";
};

std::string replaced(std::string text, const std::string& old, const std::string& now) {
  return text.replace(text.find(old), old.size(), now);
}

TEST_F(SaveOverlay, AValueGoesIntoTheFileThatRunsAndNotIntoItsBase) {
  const auto made = plan("top.yaml", {{"t", {0.15}}, {"u", {4.0}}, {"v", {1.0, 5.0}}});
  ASSERT_TRUE(behaviors::write_saved(made).empty());
  EXPECT_EQ(get("base.yaml"), kBase);
  EXPECT_EQ(get("top.yaml"),
            "base: base.yaml\nparameters:\n  u: {value: 4 s}  # mine\n  t: {value: 150 ms}\n"
            "  v: {value: [1, 5]}\n");
  EXPECT_TRUE(made.notes.empty());
}

TEST_F(SaveOverlay, AValueThatGoesBackToTheBasesIsWrittenTooWhereItHadAnother) {
  put("over.yaml", "base: top.yaml\nparameters:\n  t: {value: 0.2 s}\n");
  ASSERT_TRUE(behaviors::write_saved(plan("top.yaml", {{"t", {0.145}}, {"u", {3.0}}}, "over.yaml"))
                  .empty());
  EXPECT_EQ(get("over.yaml"), "base: top.yaml\nparameters:\n  t: {value: 0.145 s}\n");
}

TEST_F(SaveOverlay, AFileOfALibraryIsWrittenOnlyIfItIsTheOneThatIsNamed) {
  put("project/behaviors/library/shared.yaml", kBase);
  put("project/gait.yaml", "base: shared\n");
  EXPECT_THAT(refusal("project/gait.yaml", {{"t", {0.15}}}, "", true),
              testing::HasSubstr("t: project/behaviors/library/shared.yaml belongs to a library"));
  ASSERT_TRUE(behaviors::write_saved(plan("project/gait.yaml", {{"t", {0.15}}})).empty());
  EXPECT_EQ(get("project/gait.yaml"), "base: shared\nparameters:\n  t: {value: 150 ms}\n");
  EXPECT_EQ(get("project/behaviors/library/shared.yaml"), kBase);
  ASSERT_TRUE(behaviors::write_saved(plan("project/behaviors/library/shared.yaml", {{"t", {0.15}}}))
                  .empty());
  EXPECT_EQ(get("project/behaviors/library/shared.yaml"), replaced(kBase, "145 ms", "150 ms"));
}

TEST_F(SaveOverlay, AnInstalledFileIsNeverWritten) {
  put("share/behaviors/library/shared.yaml", kBase);
  const std::string name = "share/behaviors/library/shared.yaml";
  const std::string reason = name + " is an installed file, which is never written: --to FILE\n";
  for (const bool into_bases : {false, true}) {
    EXPECT_THAT(refusal(name, {{"t", {0.15}}}, "", into_bases), testing::EndsWith(reason));
  }
  EXPECT_THAT(refusal(name, {{"t", {0.15}}}, "share/new.yaml"),
              testing::HasSubstr("share/new.yaml is an installed file"));
  ASSERT_TRUE(behaviors::write_saved(plan(name, {{"t", {0.15}}}, "mine.yaml")).empty());
}

TEST_F(SaveOverlay, IntoItsBaseAValueGoesWhereItCameFrom) {
  const auto made = plan("top.yaml", {{"t", {0.15}}, {"u", {4.0}}}, "", true);
  ASSERT_TRUE(behaviors::write_saved(made).empty());
  EXPECT_EQ(get("base.yaml"), replaced(kBase, "145 ms", "150 ms"));
  EXPECT_EQ(get("top.yaml"), "base: base.yaml\nparameters:\n  u: {value: 4 s}  # mine\n");
  ASSERT_EQ(made.notes.size(), 1u);
  EXPECT_EQ(made.notes[0], file("base.yaml") + " is a base of " + file("top.yaml") +
                               ": what is written there holds for every behavior on it");
  ASSERT_EQ(made.places.size(), 2u);
  EXPECT_EQ(made.places[0].name, "t");
  EXPECT_EQ(made.places[0].file, file("base.yaml"));
  EXPECT_EQ(made.places[0].line, 3);
  EXPECT_EQ(made.places[0].column, 14);
  EXPECT_EQ(made.places[0].old_text, "145 ms");
  EXPECT_EQ(made.places[0].new_text, "150 ms");
}

TEST_F(SaveOverlay, ANewFileHoldsOnlyWhatDiffers) {
  const auto made =
      plan("top.yaml", {{"t", {0.15}}, {"u", {3.0}}, {"v", {1.0, 2.5}}}, "sub/new.yaml");
  EXPECT_FALSE(behaviors::write_saved(made).empty());  // no such folder
  put("sub/other", "");
  ASSERT_TRUE(behaviors::write_saved(made).empty());
  EXPECT_EQ(get("sub/new.yaml"),
            "behavior: 1\nbase: ../top.yaml\nparameters:\n  t: {value: 150 ms}\n"
            "  v: {value: [1, 2.5]}\n");
  EXPECT_EQ(get("base.yaml"), kBase);
  EXPECT_FALSE(behaviors::write_saved(made).empty());  // it is no new file any more
}

TEST_F(SaveOverlay, AFileThatIsThereIsEditedInPlace) {
  put("over.yaml", "# mine\nbase: top.yaml\nparameters:\n  t: {value: 0.2 s}  # slow\n\n# end\n");
  ASSERT_TRUE(
      behaviors::write_saved(plan("top.yaml", {{"t", {0.25}}, {"u", {5.0}}}, "over.yaml")).empty());
  EXPECT_EQ(get("over.yaml"),
            "# mine\nbase: top.yaml\nparameters:\n  t: {value: 0.25 s}  # slow\n"
            "  u: {value: 5 s}\n\n# end\n");
  EXPECT_EQ(get("base.yaml"), kBase);
}

TEST_F(SaveOverlay, TheBehaviorItselfTakesWhatItsBaseHas) {
  ASSERT_TRUE(behaviors::write_saved(plan("top.yaml", {{"t", {0.25}}}, "top.yaml")).empty());
  EXPECT_EQ(get("top.yaml"),
            "base: base.yaml\nparameters:\n  u: {value: 3 s}  # mine\n  t: {value: 250 ms}\n");
}

TEST_F(SaveOverlay, AFileOnSomethingElseIsLeftAlone) {
  put("other.yaml", "behavior: 1\nmachine: {states: {a: {after: 1 s, to: a}}}\n");
  EXPECT_EQ(refusal("top.yaml", {{"t", {0.25}}}, "other.yaml"),
            "other.yaml: it is there already and top.yaml is not among its bases\n");
}

TEST_F(SaveOverlay, AnAnchorsUserMayDifferThere) {
  put("b.yaml",
      "behavior: 1\nparameters: {a: {value: &x 20 ms}, b: {value: *x}}\n"
      "machine: {states: {a: {after: *x, to: a}}}\n");
  ASSERT_TRUE(behaviors::write_saved(plan("b.yaml", {{"b", {0.03}}}, "over.yaml")).empty());
  EXPECT_EQ(get("over.yaml"), "behavior: 1\nbase: b.yaml\nparameters:\n  b: {value: 30 ms}\n");
}

TEST_F(SaveOverlay, GainsGoUnderTheirKeys) {
  put("r.yaml", R"(behavior: 1
robot: hume
gains: {g: {height: {kp: 100, kd: 20}, attitude: {kp: [1, 2], kd: [3, 4]}}}
stacks:
  s:
    contacts: [right_foot, left_foot]
    gains: g
    tasks:
      height: {type: com_position, axes: [z], priority: 1, reference: entry}
      attitude: {type: body_orientation, axes: [pitch, roll], priority: 1, reference: 0}
      rest: {type: joint_damping, priority: 2, gains: {kd: {"*": 2, left_knee: 3}}}
machine: {stack: s, states: {a: {after: 1 s, to: a}}}
)");
  ASSERT_TRUE(behaviors::write_saved(plan("r.yaml",
                                          {{"gains.g.height.kd", {21.0}},
                                           {"gains.g.attitude.kp", {1.0, 2.5}},
                                           {"gains.s.rest.kd", {2.0, 2.0, 4.0, 2.0, 2.0, 5.0}}},
                                          "over.yaml"))
                  .empty());
  EXPECT_EQ(get("over.yaml"), R"(behavior: 1
base: r.yaml
gains:
  g:
    height: {kd: 21}
    attitude: {kp: [1, 2.5]}
stacks:
  s:
    tasks:
      rest:
        gains:
          kd: {right_knee: 4, left_knee: 5}
)");
}

}  // namespace
}  // namespace footfall::tests
