// Names by pattern: per-joint maps and lists of names.
#include "core/yaml/glob.h"

#include <gtest/gtest.h>

namespace footfall::core {
namespace {

const std::vector<std::string> kJoints = {"right_hip", "right_knee", "left_hip", "left_knee"};

TEST(GlobTest, StarsAndQuestionMarks) {
  EXPECT_TRUE(glob_matches("*", ""));
  EXPECT_TRUE(glob_matches("*knee", "left_knee"));
  EXPECT_TRUE(glob_matches("l*_k*e", "left_knee"));
  EXPECT_TRUE(glob_matches("led_?", "led_4"));
  EXPECT_FALSE(glob_matches("led_?", "led_"));
  EXPECT_FALSE(glob_matches("knee", "left_knee"));
  EXPECT_FALSE(glob_matches("", "x"));
  // Quadratic at most: no pattern can hang the loader.
  const std::string pattern = "*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*a*b";
  EXPECT_FALSE(glob_matches(pattern, std::string(10'000, 'a')));
}

TEST(GlobTest, ExactNamesGoBeforeGlobs) {
  Diagnostics diagnostics;
  const YamlNode map =
      load_yaml_text("\"*knee\": 22\nleft_knee: 26\n\"r*hip\": 1\n", "f.yaml", diagnostics);
  const auto entries = match_names(map, kJoints, "joint", diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  EXPECT_EQ(entries[0]->value.scalar, "1");
  EXPECT_EQ(entries[1]->value.scalar, "22");
  EXPECT_EQ(entries[2], nullptr);
  EXPECT_EQ(entries[3]->value.scalar, "26");
}

TEST(GlobTest, TwoGlobsOnOneNameAndGlobsOnNoneAreErrors) {
  Diagnostics diagnostics;
  const YamlNode map = load_yaml_text("\"*knee\": 1\n\"left_*\": 2\n\"*ankle\": 3\nleft_kne: 4\n",
                                      "f.yaml", diagnostics);
  match_names(map, kJoints, "joint", diagnostics);
  EXPECT_EQ(
      diagnostics.to_string(),
      "f.yaml:2:1: error: 'left_*' and '*knee' (line 1) both match joint 'left_knee'\n"
      "f.yaml:3:1: error: '*ankle' matches no joint: there are right_hip, right_knee, left_hip, "
      "left_knee\n"
      "f.yaml:4:1: error: no joint 'left_kne' (did you mean 'left_knee'?)\n");
}

TEST(GlobTest, AListOfNamesKeepsItsOrder) {
  Diagnostics diagnostics;
  const YamlNode list = load_yaml_text("[left_knee, \"*hip\"]", "f.yaml", diagnostics);
  EXPECT_EQ(expand_names(list, kJoints, "joint", diagnostics), (std::vector<int>{3, 0, 2}));
  EXPECT_EQ(diagnostics.to_string(), "");
  const YamlNode twice = load_yaml_text("[left_hip, left_hip]", "g.yaml", diagnostics);
  expand_names(twice, kJoints, "joint", diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "g.yaml:1:12: error: joint 'left_hip' twice\n");
}

}  // namespace
}  // namespace footfall::core
