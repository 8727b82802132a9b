// Planners as the physics checks judge them. Oracles: the pendulum's step-to-step map as a matrix,
// and the law itself, step after step. Equations: [Kim16] eqs. (19), (21) with E1.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "behaviors/machine/planner_calls.h"
#include "behaviors/planners/foot_planner.h"
#include "tests/unit/behaviors/check/physics_test_support.h"

namespace footfall::tests {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string walking(const std::string& kappa, const std::string& parameters = "") {
  return "behavior: 1\nrobot: hume\n" + parameters +
         "planners: {foot: {type: velocity_reversal, kappa: " + kappa +
         ", reversal: 185 ms}}\n"
         "stacks:\n  single:\n    contacts: [right_foot]\n    tasks:\n"
         "      height: {type: com_position, axes: [z], reference: 0.935 m, gains: {kp: 1}}\n" +
         attitude("[pitch, roll]") + swing() + R"(machine:
  stack: single
  states:
    ready: {after: 40 ms, to: lift}
    lift:
      invoke: [{planner: foot, with: {stance: right_foot, swing: left_foot, switch_in: "= 295 ms - t"}}]
      after: 295 ms
      to: ready
)";
}

double printed_eigenvalue(const std::string& text) {
  const std::string before = " is ";
  const std::size_t found = text.find(before, text.find("an eigenvalue"));
  return found == std::string::npos ? 0.0 : std::stod(text.substr(found + before.size()));
}

// About the goal, from switch to switch: the foot goes to x_p = (1 + k) x + coth(w t')/w v, then
// the pendulum moves for T about it.
double largest_eigenvalue(double kappa, double reversal, double height, double T) {
  const double w = std::sqrt(9.81 / height);
  const double C = std::cosh(w * T), S = std::sinh(w * T);
  // M = [C, S/w; wS, C] + B K, column by row.
  const double B[2] = {1.0 - C, -w * S};
  const double K[2] = {1.0 + kappa, 1.0 / (w * std::tanh(w * reversal))};
  const double trace = 2.0 * C + B[0] * K[0] + B[1] * K[1];
  const double determinant =
      (C + B[0] * K[0]) * (C + B[1] * K[1]) - (S / w + B[0] * K[1]) * (w * S + B[1] * K[0]);
  const std::complex<double> root =
      std::sqrt(std::complex<double>(trace * trace - 4.0 * determinant));
  return std::max(std::abs(trace + root), std::abs(trace - root)) / 2.0;
}

TEST(PhysicsPlanner, ThePrintedSignOfKappaIsRejectedWithItsEigenvalue) {
  const std::string text = walking("{value: -0.4, range: [-1, 1]}");
  const std::string said = physics(text);
  EXPECT_THAT(said,
              StartsWith(place_of(text, "{value: -0.4") + "error: planner 'foot' diverges: "));
  EXPECT_THAT(said, HasSubstr("height h 0.935 m, step time T 0.335 s"));
  EXPECT_NEAR(printed_eigenvalue(said), 1.28, 0.01);  // the bar
  EXPECT_NEAR(printed_eigenvalue(said), largest_eigenvalue(-0.4, 0.185, 0.935, 0.335), 5e-4);
}

TEST(PhysicsPlanner, TheCorrectedSignIsClean) {
  EXPECT_LT(largest_eigenvalue(0.4, 0.185, 0.935, 0.335), 1.0);
  EXPECT_EQ(physics(walking("0.4")), "");
  EXPECT_EQ(physics(walking("0")), "");  // steps drift, they do not grow
}

// kappa 0.9, reversal 500 ms, 540 ms a step: a conjugate pair, which the real parts hide.
TEST(PhysicsPlanner, AComplexPairIsJudgedByItsModulus) {
  std::string text = walking("0.9");
  const auto replace = [&text](const std::string& from, const std::string& to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + 1)) {
      text.replace(at, from.size(), to);
    }
  };
  replace("185 ms", "500 ms");
  replace("295 ms", "500 ms");
  const std::string said = physics(text);
  EXPECT_THAT(said, HasSubstr("error: planner 'foot' diverges: an eigenvalue of its step-to-step "
                              "map in x is "));
  EXPECT_THAT(said, HasSubstr(fmt::format("i, of modulus {:.3f} (kappa 0.9, reversal 500 ms",
                                          largest_eigenvalue(0.9, 0.5, 0.935, 0.54))));
  EXPECT_THAT(said, HasSubstr("its modulus must not exceed 1; here kappa must be below 0."));
}

// The longer of two strides, each at a height of its own, is not always the less stable one.
TEST(PhysicsPlanner, EveryStrideIsJudgedAtItsOwnHeight) {
  const std::string low =
      R"(    low:
      tasks: {height: {type: com_position, axes: [z], reference: 0.5 m, gains: {kp: 1}}}
      invoke: [{planner: foot, with: {stance: right_foot, swing: left_foot, switch_in: "= 320 ms - t"}}]
      after: 320 ms
      to: ready
)";
  std::string text = walking("0.9");
  text.replace(text.find("185 ms"), 6, "350 ms");
  EXPECT_LT(largest_eigenvalue(0.9, 0.35, 0.935, 0.335), 1.0);
  EXPECT_GT(largest_eigenvalue(0.9, 0.35, 0.5, 0.32), 1.0);
  EXPECT_EQ(physics(text), "");
  EXPECT_THAT(physics(text + low), HasSubstr("error: planner 'foot' diverges"));
}

TEST(PhysicsPlanner, ANegativeKappaNeedsARangeThatAllowsIt) {
  EXPECT_THAT(problems(walking("-0.4")), HasSubstr("error: kappa -0.4 is outside 0 .. 1"));
  EXPECT_THAT(problems(walking("$k", "parameters: {k: -0.4}\n")), HasSubstr("is outside 0 .. 1"));
  const std::string wide = "parameters: {k: {value: [-0.4, -0.4], range: [-1, 1]}}\n";
  EXPECT_EQ(problems(walking("$k", wide)).find(": error: "), std::string::npos);
  EXPECT_THAT(physics(walking("$k", wide)), HasSubstr("error: planner 'foot' diverges"));
}

TEST(PhysicsPlanner, ALiveKappaIsReadWhenThePlannerIsAskedAndWarnedAboutAtItsEnds) {
  const std::string live = "parameters: {k: {value: 0.4, range: [-1, 1], live: true}}\n";
  const std::string text = walking("$k", live);
  EXPECT_THAT(physics(text), HasSubstr("warning: planner 'foot' diverges at the end of the range "
                                       "of 'k'"));
  const auto b = load(text);
  std::vector<double> values = b->values;
  EXPECT_EQ(behaviors::spec_in_force(b->planners[0], values).kappa[1], 0.4);
  values[static_cast<std::size_t>(b->parameters[0].slot)] = 0.2;
  EXPECT_EQ(behaviors::spec_in_force(b->planners[0], values).kappa[1], 0.2);
}

// The law itself, stepping on the spot, mirrored after each switch: the CoM coasts with both feet
// down, then follows the pendulum about the foot that is new. Nothing is assumed to be steady.
double steady_width(const behaviors::FootPlannerSpec& spec, double height, double coast,
                    double single) {
  const double w = std::sqrt(spec.gravity / height);
  const double C = std::cosh(w * single), S = std::sinh(w * single);
  double y = 0.1, v = 0.0, goal = 0.0;  // from the stance foot; the other is on the left
  double width = 0.0;
  for (int k = 0; k < 300; ++k) {
    y += v * coast;
    behaviors::FootPlannerInput in;
    in.com = {0.0, y};
    in.com_vel = {0.0, v};
    in.com_height = height;
    in.goal = {0.0, goal};
    in.switch_in = single;
    const double next_y = C * y + S / w * v;
    const double next_v = w * S * y + C * v;
    width = behaviors::plan_foot(spec, in).target[1];
    y = width - next_y;  // from the new foot, mirrored
    v = -next_v;
    goal = width - goal;
  }
  return width;
}

TEST(PhysicsPlanner, SteadyStepsWiderThanTheReachAreWarnedAbout) {
  const auto text = [](double kappa, double offset, bool both) {
    std::string file = walking(fmt::format("{}", kappa));
    const std::string old = "reversal: 185 ms", ready = "ready: {after";
    file.replace(file.find(old), old.size(),
                 fmt::format("{}, width_offset: {:.17g} m, reach: {{x: 0.4 m, y: [0.1 m, 0.6 m]}}",
                             old, offset));
    return both ? file.replace(file.find(ready), ready.size(),
                               "ready: {contacts: [right_foot, left_foot], after")
                : file;
  };
  for (const double kappa : {0.0, 0.25, 0.4}) {
    for (const bool both : {false, true}) {
      behaviors::FootPlannerSpec spec;
      spec.kappa = {kappa, kappa};
      spec.reversal = {0.185, 0.185};
      spec.width_offset = 0.01;
      // Widths are proportional to the offset.
      const double coast = both ? 0.04 : 0.0;
      const double limit = 0.01 * 0.6 / steady_width(spec, 0.935, coast, 0.335 - coast);
      EXPECT_EQ(physics(text(kappa, 0.999 * limit, both)).find("every step is cut"),
                std::string::npos)
          << kappa << both;
      const std::string said = physics(text(kappa, 1.001 * limit, both));
      EXPECT_THAT(said, HasSubstr("beyond its reach.y of 0.6 m: every step is cut")) << both;
      const std::string before = "width_offset must be below ";
      const std::size_t found = said.find(before);
      ASSERT_NE(found, std::string::npos);
      // Three digits are printed: half of the last one, 5e-5 m.
      EXPECT_NEAR(std::stod(said.substr(found + before.size())), limit, 5e-5);
    }
  }
}

}  // namespace
}  // namespace footfall::tests
