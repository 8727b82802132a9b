// `constraints:` of world files: what is read, and each refusal at its place.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "sim/springs_check.h"
#include "sim/world/description.h"
#include "tests/support/hume.h"

namespace footfall::sim {
namespace {

class Constraints : public testing::Test {
 protected:
  Constraints()
      : folder_(std::filesystem::path(testing::TempDir()) /
                testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
  }
  ~Constraints() override { std::filesystem::remove_all(folder_); }

  WorldDescription load(const std::string& text, const std::string& file = "aided.yaml") {
    std::ofstream(folder_ / file) << "world: 1\n" << text;
    diagnostics_ = {};
    return load_world((folder_ / file).string(), diagnostics_);
  }
  std::string problems() const {
    const std::string path = (folder_ / "aided.yaml").string() + ":";
    std::string out = diagnostics_.to_string();
    for (std::size_t i = out.find(path); i != std::string::npos; i = out.find(path)) {
      out.erase(i, path.size());
    }
    return out;
  }
  std::string problems_of(const std::string& aid) {
    load("constraints: {aid: " + aid + "}\n");
    return problems();
  }

  std::filesystem::path folder_;
  core::Diagnostics diagnostics_;
};

constexpr const char* kAids = R"(constraints:
  planarizer:
    body: torso
    y: {stiffness: 20000 N/m, damping: 500 N s/m, at: 1 cm}
    yaw: {stiffness: 500 Nm/rad, damping: 20 Nm s/rad, at: 90 deg}
  harness: {body: torso, z: {stiffness: 3000 N/m, travel: [-5 cm, 1 m]}}
)";

TEST_F(Constraints, AreReadByAxis) {
  const WorldDescription world = load(kAids);
  ASSERT_EQ(problems(), "");
  ASSERT_EQ(world.constraints.size(), 2u);
  const model::BodySprings& planarizer = world.constraints[0];
  EXPECT_EQ(planarizer.name, "planarizer");
  EXPECT_EQ(planarizer.body.name, "torso");
  for (const std::size_t free : {0u, 2u, 3u, 4u}) EXPECT_FALSE(planarizer.axes[free]) << free;
  EXPECT_EQ(planarizer.axes[1]->stiffness, 20000);
  EXPECT_EQ(planarizer.axes[1]->damping, 500);
  EXPECT_DOUBLE_EQ(planarizer.axes[1]->at.value(), 0.01);
  EXPECT_EQ(planarizer.axes[5]->stiffness, 500);
  EXPECT_DOUBLE_EQ(planarizer.axes[5]->at.value(), 0.5 * std::numbers::pi);
  const model::AxisSpring& rope = world.constraints[1].axes[2].value();
  EXPECT_EQ(rope.damping, std::nullopt);
  EXPECT_EQ(rope.at, std::nullopt);
  EXPECT_EQ(rope.travel, (std::array<double, 2>{-0.05, 1.0}));
  check_supported(world, diagnostics_);
  check_springs(world, {}, tests::load_hume(), diagnostics_);
  EXPECT_EQ(problems(), "");
}

TEST_F(Constraints, OneOfTheBaseIsRemovedByOffAndChangedByItsKeys) {
  load(kAids, "base.yaml");
  const WorldDescription world =
      load("base: base.yaml\nconstraints: {harness: off, planarizer: {y: {stiffness: 1 N/m}}}\n");
  ASSERT_EQ(problems(), "");
  ASSERT_EQ(world.constraints.size(), 1u);
  EXPECT_EQ(world.constraints[0].axes[1]->stiffness, 1);
  EXPECT_EQ(world.constraints[0].axes[1]->damping, 500);
  EXPECT_TRUE(load("base: base.yaml\nconstraints: off\n").constraints.empty());
  EXPECT_EQ(problems(), "");
  EXPECT_TRUE(
      load("base: base.yaml\nconstraints: {harness: off, planarizer: off}\n").constraints.empty());
  EXPECT_EQ(problems(), "");
}

TEST_F(Constraints, MistakesAreErrorsAtTheirPlace) {
  load("constraints: [planarizer]\n");
  EXPECT_EQ(problems(),
            "2:14: error: expected external aids by name: {NAME: {body: BODY, z: {stiffness: "
            "...}}}, got a list\n");
  EXPECT_EQ(problems_of("{body: torso}"),
            "2:20: error: expected at least one of x, y, z, roll, pitch, yaw, rope or slides: an "
            "axis that is "
            "not named is free\n");
  EXPECT_EQ(problems_of("{body: torso, rope: {to: [0 m, 0 m, 4 m], stiffness: 1 N/m}}"),
            "2:40: error: the key 'length' is missing\n");
  EXPECT_EQ(problems_of("{body: torso, rope: {to: [0 m, 4 m], length: 1 m, stiffness: 1 N/m}}"),
            "2:45: error: expected three lengths [x, y, z], got a list\n");
  EXPECT_EQ(problems_of("{z: {stiffness: 1 N/m}}"), "2:20: error: the key 'body' is missing\n");
  EXPECT_EQ(problems_of("{body: torso, ptch: {stiffness: 1 Nm}}"),
            "2:34: error: unknown key 'ptch' (did you mean 'pitch'?)\n");
  EXPECT_EQ(problems_of("{body: torso, z: {damping: 1 N s/m}}"),
            "2:37: error: the key 'stiffness' is missing\n");
  EXPECT_EQ(problems_of("{body: torso, z: {stiffness: 0 N/m}}"),
            "2:49: error: expected a stiffness in N/m above zero, got '0 N/m'; an axis that is not "
            "named is free\n");
  EXPECT_EQ(problems_of("{body: torso, z: {stiffness: 1 Nm/rad}}"),
            "2:49: error: expected a stiffness in N/m, got '1 Nm/rad'\n");
  EXPECT_EQ(problems_of("{body: torso, yaw: {stiffness: 1 N/m}}"),
            "2:51: error: expected a stiffness in Nm/rad, got '1 N/m'\n");
  EXPECT_NE(problems_of("{body: torso, z: {stiffness: 1 N/m, damping: -1 N s/m}}"), "");
  EXPECT_EQ(problems_of("{body: torso, z: {stiffness: 1 N/m, travel: [1 cm, 1 cm]}}"),
            "2:64: error: expected a travel [MIN, MAX] with MIN below MAX; without `travel` the "
            "spring acts both ways\n");
  EXPECT_NE(problems_of("{body: torso, z: {stiffness: 1 N/m, travel: [1 cm, -1 cm]}}"), "");
  EXPECT_EQ(problems_of("{body: torso, yaw: {stiffness: 1 Nm, travel: [-200 deg, 0 deg]}}"),
            "2:65: error: expected angles from -180 deg to 180 deg\n");
}

TEST_F(Constraints, ABodyThatTheRobotLacksIsReportedWithTheNearest) {
  const WorldDescription world =
      load("constraints: {aid: {body: torsoo, z: {stiffness: 1 N/m}}}\n");
  check_links(world, {"torso", "pelvis"}, diagnostics_);
  EXPECT_EQ(problems(), "2:27: error: the robot has no body 'torsoo' (did you mean 'torso'?)\n");
}

TEST_F(Constraints, ASpringThatPhysicsCannotIntegrateIsReportedWithTheBound) {
  const WorldDescription world =
      load("constraints: {aid: {body: torso, z: {stiffness: 1e9 N/m, damping: 0}}}\n");
  if (problems().empty()) check_springs(world, {}, tests::load_hume(), diagnostics_);
  EXPECT_EQ(problems(),
            "2:49: error: the physics step of 1/3000 s integrates the spring 'z' of 'torso' stably "
            "only with stiffness below 3.89e+08 N/m\n");
}

// The body stands in the base, the values that physics refuses in the file over it.
TEST_F(Constraints, AValueOverABaseIsReportedInTheFileThatHasIt) {
  const std::string base = (folder_ / "base.yaml").string();
  std::ofstream(base) << "world: 1\n"
                         "constraints:\n"
                         "  aid:\n"
                         "    body: torso\n"
                         "    z: {stiffness: 1 N/m, damping: 0}\n"
                         "  harness:\n"
                         "    body: torso\n"
                         "    rope: {to: [0 m, 0 m, 4 m], length: 2 m, stiffness: 1 N/m}\n";
  const WorldDescription world = load(
      "base: base.yaml\n# A comment.\nconstraints:\n"
      "  aid: {z: {stiffness: 1e9 N/m}}\n  harness: {rope: {stiffness: 1e10 N/m}}\n");
  ASSERT_EQ(diagnostics_.error_count(), 0) << diagnostics_.to_string();
  check_springs(world, {}, tests::load_hume(), diagnostics_);
  ASSERT_EQ(diagnostics_.all().size(), 2U) << diagnostics_.to_string();
  for (const core::Diagnostic& item : diagnostics_.all()) {
    EXPECT_EQ(diagnostics_.file(item.mark.file), (folder_ / "aided.yaml").string());
    const bool rope = item.text.find("the rope") != std::string::npos;
    EXPECT_EQ(item.mark.line, rope ? 6 : 5) << item.text;
    EXPECT_EQ(item.mark.column, rope ? 31 : 24) << item.text;
  }
}

}  // namespace
}  // namespace footfall::sim
