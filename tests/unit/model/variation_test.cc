// What a seed draws: the same for the same seed, cut at three standard deviations, each quantity
// for itself.
#include "model/variation/variation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/yaml/layers.h"

namespace footfall::tests {
namespace {

using model::draw;
using model::Draw;
using model::Spread;
using model::Variation;

Variation read(const std::string& text, const Variation& base = {}) {
  core::Diagnostics diagnostics;
  const Variation variation =
      model::read_variation(core::load_yaml_text(text, "w.yaml", diagnostics), base, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return variation;
}

std::string problems(const std::string& text) {
  core::Diagnostics diagnostics;
  model::read_variation(core::load_yaml_text(text, "w.yaml", diagnostics), {}, diagnostics);
  return diagnostics.to_string();
}

constexpr const char* kAll = R"(
start: {joints: {sd: 0.5 deg}, velocity: {sd: 3 cm/s}, rates: {sd: 0.05 rad/s}}
friction: {range: [0.6, 1]}
control_model: {mass: {sd: 3 %}, com: {torso: {sd: 5 mm}}}
command_delay: {range: [0 s, 667 us]}
push: {impulse: 1 N s, between: [3 s, 10 s]}
)";
const std::vector<std::string> kLinks = {"torso", "thigh", "shank"};

TEST(Variation, ASeedDrawsTheSameAgainAndAnotherSomethingElse) {
  const Variation all = read(kAll);
  const Draw one = draw(all, 6, kLinks, 7), again = draw(all, 6, kLinks, 7);
  const Draw other = draw(all, 6, kLinks, 8);
  EXPECT_EQ(one.values, again.values);
  ASSERT_EQ(one.values.size(), other.values.size());
  for (std::size_t k = 0; k < one.values.size(); ++k) EXPECT_NE(one.values[k], other.values[k]);
}

// Moments of 20 000 numbers: a standard error is 1/sqrt(20 000) of the deviation, 0.5 % of it for
// the deviation itself; bounds of five of them. The cut takes 1.3 % off the deviation.
TEST(Variation, ANormalDrawIsCutAtThreeDeviations) {
  const Variation v = read("start: {velocity: {sd: 2 cm/s}}");
  double sum = 0.0, squares = 0.0, most = 0.0;
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    for (const double x : draw(v, 0, {}, seed).velocity) {
      sum += x;
      squares += x * x;
      most = std::max(most, std::abs(x));
    }
  }
  EXPECT_NEAR(sum / 20'000, 0.0, 5.0 * 0.02 / std::sqrt(20'000.0));
  EXPECT_NEAR(std::sqrt(squares / 20'000), 0.02 * 0.9866, 5.0 * 0.005 * 0.02);
  EXPECT_LE(most, 0.06);
  EXPECT_GT(most, 0.055);
}

// One factor for all links; a sign has the mean 0 and the deviation 1.
TEST(Variation, ASignOfTheMassIsOneForAllLinks) {
  const Variation v = read("control_model: {mass: {sign: 5 %}}");
  EXPECT_TRUE(v.depends_on_seed());
  int more = 0;
  constexpr int kSeeds = 2'000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Draw drawn = draw(v, 0, kLinks, seed);
    EXPECT_TRUE(drawn.masses.empty());
    ASSERT_NEAR(std::abs(drawn.mass.value() - 1.0), 0.05, 1e-15);
    more += *drawn.mass > 1.0 ? 1 : 0;
    ASSERT_EQ(drawn.values.front().first, "control_model.mass");
    EXPECT_EQ(drawn.values.front().second, std::vector<double>{*drawn.mass});
  }
  EXPECT_NEAR(more, kSeeds / 2, 5.0 * std::sqrt(0.25 * kSeeds));
}

// Uniform directions: cosine and sine have the mean 0, the variance 1/2, and do not correlate.
TEST(Variation, ARingIsAsFarInAnyDirection) {
  const Variation v = read("control_model: {com: {torso: {ring: 1 cm}}}");
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  constexpr double kSeeds = 2'000;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const auto shift = draw(v, 0, kLinks, seed).com.at("torso");
    ASSERT_NEAR(std::hypot(shift[0], shift[1]), 0.01, 1e-15);
    x += shift[0] / 0.01;
    y += shift[1] / 0.01;
    xx += shift[0] * shift[0] / 1e-4;
    xy += shift[0] * shift[1] / 1e-4;
  }
  const double bound = 5.0 * std::sqrt(0.5 * kSeeds);
  EXPECT_NEAR(x, 0.0, bound);
  EXPECT_NEAR(y, 0.0, bound);
  EXPECT_NEAR(xx, 0.5 * kSeeds, bound);  // deviations of sqrt(1/8)
  EXPECT_NEAR(xy, 0.0, bound);
}

TEST(Variation, OneDistributionReplacesTheOther) {
  const Variation v =
      read("control_model: {mass: {sd: 1 %}}", read("control_model: {mass: {sign: 5 %}}"));
  EXPECT_EQ(v.mass.kind, model::Spread::Kind::normal);
  EXPECT_FALSE(draw(v, 0, kLinks, 1).mass);
}

TEST(Variation, ASignOrRingBeyondWhatCanBeDrawnIsRefused) {
  EXPECT_NE(problems("control_model: {mass: {sign: 95 %}}").find("0.9"), std::string::npos);
  EXPECT_NE(problems("command_delay: {sign: 1 ms}").find("below zero"), std::string::npos);
  EXPECT_NE(problems("control_model: {com: {torso: {ring: -1 cm}}}").find("0"), std::string::npos);
}

TEST(Variation, AUniformDrawFillsItsRange) {
  const Variation v = read("friction: {range: [0.6, 1]}");
  double least = 2.0, most = 0.0;
  for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
    const double friction = draw(v, 0, {}, seed).friction.value();
    least = std::min(least, friction);
    most = std::max(most, friction);
  }
  EXPECT_GE(least, 0.6);
  EXPECT_LE(most, 1.0);
  EXPECT_LT(least, 0.605);
  EXPECT_GT(most, 0.995);
  EXPECT_EQ(v.least_friction(), 0.6);
}

TEST(Variation, WhatIsPinnedLeavesTheOthersAsTheyAre) {
  const Variation all = read(kAll);
  const Variation pinned = read("{friction: 0.8, push: off, start: {rates: off}}", all);
  const Draw a = draw(all, 6, kLinks, 3), b = draw(pinned, 6, kLinks, 3);
  EXPECT_EQ(b.friction, 0.8);
  EXPECT_FALSE(b.push.has_value());
  EXPECT_EQ(b.rates, (std::array<double, 3>{}));
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.velocity, b.velocity);
  EXPECT_EQ(a.masses, b.masses);
  EXPECT_EQ(a.com, b.com);
  EXPECT_EQ(a.command_delay, b.command_delay);
  EXPECT_TRUE(draw(read("off", all), 6, kLinks, 3).values.empty());
}

TEST(Variation, APushHasItsImpulseAndComesInItsTime) {
  const Variation v = read("push: {impulse: 1 N s, between: [3 s, 10 s], for: 50 ms}");
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const model::DrawnPush push = draw(v, 0, {}, seed).push.value();
    EXPECT_DOUBLE_EQ(push.force * push.duration, 1.0);
    EXPECT_GE(push.time, 3.0);
    EXPECT_LE(push.time, 10.0);
  }
}

// Seed 4 of `sd: 60 %` had a mass of -0.68 times the true one.
TEST(Variation, ThreeDeviationsLieWithinWhatCanBeDrawn) {
  EXPECT_NE(problems("control_model: {mass: {sd: 60 %}}").find("1:28: error: three standard devia"),
            std::string::npos);
  EXPECT_NE(problems("control_model: {mass: {sd: 31 %}}").find("an sd of at most 0.3"),
            std::string::npos);
  EXPECT_EQ(problems("control_model: {mass: {sd: 30 %}}"), "");
  EXPECT_NE(problems("start: {velocity: {sd: 4 m/s}}").find("beyond -10 and 10"),
            std::string::npos);
  const Variation most = read("control_model: {mass: {sd: 30 %}}");
  for (std::uint64_t seed = 0; seed < 2'000; ++seed) {
    for (const auto& [link, factor] : draw(most, 6, kLinks, seed).masses) EXPECT_GE(factor, 0.1);
  }
}

// Where the posture itself is beyond, the draw does not lead further away.
TEST(Variation, NoJointIsDrawnBeyondItsLimits) {
  model::RobotDescription robot;
  robot.joints = {{.name = "hip", .position_min = -1.0, .position_max = 1.0, .posture = 0.1},
                  {.name = "knee", .position_min = 0.1, .position_max = 2.0, .posture = 0.4},
                  {.name = "ankle", .position_min = 0.0, .position_max = 0.2, .posture = 0.3}};
  for (const auto& [text, kept] : {std::pair("0.05", std::vector{0.05, 0.05, 0.0}),
                                   std::pair("-0.5", std::vector{-0.5, -0.3, -0.3})}) {
    Draw drawn = draw(read(std::string("start: {joints: ") + text + "}"), 3, kLinks, 1);
    model::keep_start_within_limits(drawn, robot);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(drawn.joints[j], kept[j], 1e-12) << text << j;
    EXPECT_EQ(drawn.values.at(0).second, drawn.joints);  // what is told
  }
}

TEST(Variation, TheMostDelayIsWhatChecksCountOn) {
  EXPECT_EQ(Variation{}.most_command_delay(), 0.0);
  EXPECT_EQ(read("command_delay: 2 ms").most_command_delay(), 2e-3);
  EXPECT_EQ(read("command_delay: {range: [0 s, 667 us]}").most_command_delay(), 667e-6);
  EXPECT_EQ((Spread{Spread::Kind::normal, 0.1, 0.0}.most()), 3.0 * 0.1);
}

TEST(Variation, TheDelayThatIsToldIsTheOneThatActs) {
  const double step = 1.0 / 3000.0;
  const Variation v = read("command_delay: {range: [0 s, 667 us]}");
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    for (const double own : {0.0, 2e-3}) {
      Draw drawn = draw(v, 0, {}, seed);
      const auto acts = std::llround((own + *drawn.command_delay) / step);  // as the simulator does
      model::round_command_delay(drawn, own, step);
      EXPECT_NEAR(own + *drawn.command_delay, static_cast<double>(acts) * step, 1e-15);
      EXPECT_EQ(std::llround((own + *drawn.command_delay) / step), acts);
      EXPECT_EQ(drawn.values,
                (decltype(drawn.values){{"command_delay_s", {*drawn.command_delay}}}));
    }
  }
  Draw none;
  model::round_command_delay(none, 0.0, step);
  EXPECT_FALSE(none.command_delay.has_value());
}

TEST(Variation, MistakesAreTold) {
  EXPECT_NE(problems("frition: 0.8").find("did you mean 'friction'?"), std::string::npos);
  EXPECT_NE(problems("friction: {sd: 0.1}").find("1:11: error: a friction is no difference"),
            std::string::npos);
  EXPECT_NE(problems("friction: {range: [1, 0.5]}").find("error"), std::string::npos);
  EXPECT_NE(problems("start: {velocity: {sd: 3 cm}}").find("3 cm"), std::string::npos);
  EXPECT_NE(problems("start: {velocity: {}}").find("expected 'sd', 'range', 'sign' or 'ring'"),
            std::string::npos);
  EXPECT_NE(problems("command_delay: {sd: 1 ms}").find("cannot be negative"), std::string::npos);
  EXPECT_NE(problems("push: {impulse: 1 N s}").find("between"), std::string::npos);
  EXPECT_NE(problems("push: {impulse: 1 N s, between: [-5 s, -3 s]}").find("times from 0 s on"),
            std::string::npos);
}

// `own` merged over `base`, both whole files.
core::YamlNode merged(const std::string& base, const std::string& own) {
  core::Diagnostics diagnostics;
  core::YamlNode tree = core::load_yaml_text(base, "base.yaml", diagnostics);
  core::YamlNode top = core::load_yaml_text(own, "own.yaml", diagnostics);
  model::prepare_variation(tree, top);
  core::merge_over(tree, std::move(top), nullptr, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return tree;
}

Variation read_merged(const std::string& base, const std::string& own, const Variation& world) {
  core::Diagnostics diagnostics;
  const core::YamlNode tree = merged(base, own);
  const Variation out = model::read_variation(*tree.find("variation"), world, diagnostics);
  EXPECT_EQ(diagnostics.to_string(), "");
  return out;
}

TEST(Variation, OffOverABaseTakesAwayWhatTheWorldDrawsToo) {
  const Variation world = read(kAll);
  const std::string base = "variation: {friction: 0.5, start: {joints: 0.01}}";
  EXPECT_TRUE(draw(read_merged(base, "variation: off", world), 6, kLinks, 3).values.empty());
  const Variation off =
      read_merged(base, "variation: {friction: off, start: {joints: off}}", world);
  EXPECT_FALSE(draw(off, 6, kLinks, 3).friction.has_value());
  EXPECT_TRUE(draw(off, 6, kLinks, 3).joints.empty());
  EXPECT_EQ(draw(off, 6, kLinks, 3).rates, draw(world, 6, kLinks, 3).rates);
}

TEST(Variation, OneDrawMayBeSetAgainOverOff) {
  const Variation v =
      read_merged("variation: off", "variation: {start: {joints: 0.01}}", read(kAll));
  const Draw drawn = draw(v, 2, kLinks, 3);
  EXPECT_EQ(drawn.joints, (std::vector<double>{0.01, 0.01}));
  EXPECT_EQ(drawn.values.size(), 1u);
}

TEST(Variation, ALinkSetAgainOverOffLeavesTheOthersOff) {
  const Variation world = read("control_model: {com: {torso: {sd: 5 mm}, shank: {sd: 2 mm}}}");
  for (const std::string base : {"variation: off", "variation: {control_model: off}",
                                 "variation: {control_model: {com: off}}"}) {
    const Variation v =
        read_merged(base, "variation: {control_model: {com: {torso: 1 mm}}}", world);
    EXPECT_EQ(v.com.size(), 1u) << base;
    EXPECT_EQ(v.com.at("torso").a, 1e-3);
    EXPECT_EQ(v.links.size(), 1u);
  }
}

TEST(Variation, OneKindOfDistributionReplacesTheOther) {
  const std::string base =
      "variation: {start: {joints: {sd: 0.3 deg}}, friction: {range: [0.6, 1]}}";
  const Variation v =
      read_merged(base, "variation: {start: {joints: {range: [-1 deg, 1 deg]}}}", {});
  EXPECT_EQ(v.joints.kind, Spread::Kind::uniform);
  EXPECT_DOUBLE_EQ(v.joints.b, std::numbers::pi / 180.0);
  EXPECT_EQ(v.friction.kind, Spread::Kind::uniform);
}

TEST(Variation, AFrictionOfTheGroundReplacesTheDrawOfTheBase) {
  const std::string base = "variation: {start: {joints: 0.01}, friction: {range: [0.6, 1]}}";
  const Variation v = read_merged(base, "ground: {friction: 0.2}", {});
  EXPECT_EQ(v.friction.kind, Spread::Kind::none);
  EXPECT_EQ(v.joints.kind, Spread::Kind::fixed);
}

TEST(Variation, LinksThatTheRobotLacksAreToldAtTheirPlace) {
  core::Diagnostics reading, found;
  const Variation v = model::read_variation(
      core::load_yaml_text("control_model: {com: {torsoo: {sd: 5 mm}, thigh: 1 mm, world: 1 mm}}",
                           "w.yaml", reading),
      {}, reading);
  model::check_links(v.links, kLinks, found);
  EXPECT_EQ(found.to_string(),
            "w.yaml:1:23: error: the robot has no body 'torsoo' (did you mean 'torso'?)\n"
            "w.yaml:1:56: error: the robot has no body 'world' (there are torso, thigh, shank)\n");
}

}  // namespace
}  // namespace footfall::tests
